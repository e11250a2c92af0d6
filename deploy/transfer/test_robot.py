"""Tests of what a robot does and tells: `AMPCO_EXPORT=DIR python -m unittest transfer.test_robot` in deploy/."""

import os
import tempfile
import unittest
from pathlib import Path

import mujoco
import numpy as np

from .episodes import measured_step, robot_of, walk
from .model import load
from .policy import Policy
from .robot import Robot

EXPORT = Path(os.environ.get("AMPCO_EXPORT", "policy"))
LEFT_KNEE = 3


class Robots(unittest.TestCase):
    def setUp(self):
        self.policy = Policy(EXPORT)
        self.model, _ = load(EXPORT / "g1.xml", self.policy)
        self.robot = Robot(self.model, self.policy)

    def test_a_motor_that_gives_all_it_has_is_told_by_its_joint(self):
        robot = self.robot
        robot.track(robot.default)
        self.assertFalse(robot.saturated.any())
        # 150 N·m/rad · 1 rad are more than the knee's 139 N·m; 0.9 rad less.
        for off, saturated in ((1.0, [LEFT_KNEE]), (0.9, [])):
            robot.stand()
            target = robot.default.copy()
            target[LEFT_KNEE] += off
            robot.track(target)
            self.assertEqual(np.flatnonzero(robot.saturated).tolist(), saturated)

    def test_work_is_torque_times_speed_where_that_is_positive(self):
        # By Euler's rule in a single step of 20 ms torques are those of its beginning.
        text = (EXPORT / "g1.xml").read_text().replace("implicitfast", "Euler")
        text = text.replace('timestep="0.005"', 'timestep="0.02"')
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "robot.xml"
            path.write_text(text)
            robot = Robot(load(path, self.policy)[0], self.policy)
        self.assertEqual(robot.substeps, 1)
        robot.position[2] += 1.0
        robot.data.qvel[robot.v] = np.linspace(-1, 1, robot.joints)
        work = robot.track(robot.default + 0.2)
        powers = robot.data.actuator_force * robot.data.qvel[robot.v]
        self.assertTrue((powers > 0).any() and (powers < 0).any())
        self.assertAlmostEqual(work, powers[powers > 0].sum() * 0.02)

    def test_the_greatest_force_on_a_foot_is_of_any_physics_step(self):
        robot, forces = self.robot, []
        robot.position[2] += 0.002
        for _ in range(5):
            robot.each_substep = [lambda: forces.append(robot.feet.forces(robot.data).max())]
            forces.clear()
            robot.step(np.zeros(robot.joints))
            # The first is of the step before.
            self.assertEqual(robot.sole_peak, max([*forces[1:], robot.feet.forces(robot.data).max()]))
        self.assertGreater(robot.sole_peak, 50.0)

    def test_forces_are_of_each_foot(self):
        robot = self.robot
        mujoco.mj_step(robot.model, robot.data, nstep=20)
        left, right = robot.feet.forces(robot.data)
        self.assertTrue(50 < left and 50 < right)
        # Its weight to the left: the right foot is lifted by bending that knee.
        robot.stand()
        robot.data.qpos[robot.q[9]] += 0.5
        mujoco.mj_forward(robot.model, robot.data)
        left, right = robot.feet.forces(robot.data)
        self.assertTrue(left > 0 and right == 0)
        heights, _ = robot.feet.lowest(robot.data)
        self.assertAlmostEqual(heights[0], 0.0, places=9)
        self.assertGreater(heights[1], 0.01)

    def test_a_sole_is_as_fast_as_its_lowest_point(self):
        robot = self.robot
        # About the pelvis' lateral axis: every point of a sole goes by height times angular velocity.
        robot.turning[:] = 0.0, 2.0, 0.0
        mujoco.mj_forward(robot.model, robot.data)
        np.testing.assert_allclose(robot.feet.lowest(robot.data)[1], 2.0 * robot.height(), rtol=1e-6)
        # And going besides: they cancel.
        robot.velocity[:] = 2.0 * robot.height(), 0.0, 0.0
        mujoco.mj_forward(robot.model, robot.data)
        np.testing.assert_allclose(robot.feet.lowest(robot.data)[1], 0.0, atol=1e-6)

    def test_the_change_of_an_action_is_its_mean_over_joints(self):
        changes = [measured_step(self.robot, np.full(23, action)).action_change for action in (0.5, 0.5, -0.25)]
        self.assertEqual(changes, [0.5, 0.0, 0.75])

    def test_changing_commands_have_no_mean_error(self):
        rows = [walk(self.model, self.policy, [0.5, 0, 0], 1, 0.1, False, 1, stresses)
                for stresses in ([], [("commands", 2.0)])]
        self.assertIsNotNone(rows[0]["normalized_error"])
        self.assertIsNone(rows[1]["normalized_error"])

    def test_nothing_is_remembered_by_a_robot_that_stands_up_again(self):
        stresses = [("delay", 20.0), ("push", 500.0)]
        robot = robot_of(self.model, self.policy, [0.5, 0, 0], stresses, seed=1)
        before = robot.observe()
        robot.step(np.ones(23))
        robot.stand()
        np.testing.assert_array_equal(robot.observe(), before)
        robot.track(robot.default + 0.1)
        np.testing.assert_array_equal(robot.data.ctrl, robot.default)


if __name__ == "__main__":
    unittest.main()
