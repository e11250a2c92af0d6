"""Tests of what a policy sees: `AMPCO_EXPORT=DIR python -m unittest robot.test_observation` in deploy/."""

import os
import unittest
from pathlib import Path

import mujoco
import numpy as np

from transfer.policy import Policy
from transfer.robot import Robot

from .error import RobotError
from .messages import low_state
from .motors import Motors
from .observation import MEASURED, Observer, check
from .state import State

EXPORT = Path(os.environ.get("AMPCO_EXPORT", "policy"))


class Seeing:
    """A policy that sees `terms`."""

    folder = "some-policy"

    def __init__(self, *terms, **of_all):
        self._terms = [{"name": name, "clip": None, "scale": 1.0, "past": 0} | of_all for name in terms]

    def terms(self):
        return self._terms


class Check(unittest.TestCase):
    def test_what_no_robot_measures_is_refused_with_the_remedy(self):
        with self.assertRaisesRegex(RobotError, "height and linear_velocity, which no robot.*--state-from-simulator"):
            check(Policy(EXPORT), False)
        self.assertEqual(check(Policy(EXPORT), True), ["height", "linear_velocity"])

    def test_what_nobody_tells_is_refused_always(self):
        with self.assertRaisesRegex(RobotError, "some-policy/policy.json: the policy sees friction, which neither"):
            check(Seeing("gravity", "friction"), True)

    def test_what_a_robot_measures_needs_no_simulator(self):
        self.assertEqual(check(Seeing(*MEASURED), False), [])


class Rows(unittest.TestCase):
    def test_they_are_those_of_the_simulation_of_the_same_state(self):
        policy = Policy(EXPORT)
        motors = Motors(policy.description, "policy.json")
        robot = Robot(mujoco.MjModel.from_xml_path(str(EXPORT / "g1.xml")), policy)
        random = np.random.default_rng(1)
        robot.orientation[:] = [0.8, 0.36, -0.48, 0.0]
        robot.position[:], robot.velocity[:], robot.turning[:] = random.normal(size=(3, 3))
        robot.data.qpos[robot.q] += random.normal(size=23)
        robot.data.qvel[robot.v] = random.normal(size=23)
        robot.command, robot.previous_action = np.array([0.5, 0.1, -0.2]), random.normal(size=23)

        message = low_state(4)
        message.imu_state.quaternion, message.imu_state.gyroscope = robot.orientation, robot.turning
        for i, motor in enumerate(motors.driven):
            message.motor_state[motor].q = robot.data.qpos[robot.q[i]]
            message.motor_state[motor].dq = robot.data.qvel[robot.v[i]]
        state = State(message, 0.0, (robot.position, robot.velocity))
        row = Observer(policy, motors).row(state, robot.command, robot.previous_action)
        np.testing.assert_allclose(row, robot.observe(), atol=1e-12)

    def test_history_is_newest_first_by_term_and_begins_with_the_first(self):
        policy = Seeing("angular_velocity", "command", clip=4.0, scale=0.5, past=2)
        observer = Observer(policy, Motors(Policy(EXPORT).description, "policy.json"))
        rows = []
        for step in (1.0, 2.0, 9.0):
            message = low_state(4)
            message.imu_state.gyroscope = [step, 0.0, 0.0]
            rows.append(observer.row(State(message, 0.0), np.array([0.0, 0.0, step]), None).tolist())
        # 9 is cut to 4; all are halved.
        self.assertEqual(rows[0], [0.5, 0, 0] * 3 + [0, 0, 0.5] * 3)
        self.assertEqual(rows[2], [2.0, 0, 0, 1.0, 0, 0, 0.5, 0, 0] + [0, 0, 2.0, 0, 0, 1.0, 0, 0, 0.5])


if __name__ == "__main__":
    unittest.main()
