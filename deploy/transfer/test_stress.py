"""Tests of stresses: `AMPCO_EXPORT=DIR python -m unittest transfer.test_stress` in deploy/."""

import math
import os
import tempfile
import unittest
from pathlib import Path

import mujoco
import numpy as np

from .episodes import robot_of, walk
from .model import load
from .policy import Policy
from .rows import StressError, explained, remarks, rows, text
from .stress import BUMPS, STRESSES

EXPORT = Path(os.environ.get("AMPCO_EXPORT", "policy"))
MASS = 32.10685728
PLAIN = [0.5, 0.0, 0.0]


class Rows(unittest.TestCase):
    def test_none_comes_first_and_a_name_alone_means_its_default(self):
        self.assertEqual(rows("delay"), [("none", []), ("delay=20", [("delay", 20.0)])])
        found = rows("none, gains=0.5+payload=1e+1,push=300,push=300")
        self.assertEqual([label for label, _ in found], ["none", "gains=0.5+payload=10", "push=300"])
        self.assertEqual(found[1][1], [("gains", 0.5), ("payload", 10.0)])

    def test_standard_is_each_alone_and_all_at_half_strength(self):
        found = rows("standard")
        self.assertEqual(len(found), 1 + len(STRESSES) + 1)
        self.assertEqual([stresses[0][0] for _, stresses in found[1:-1]], list(STRESSES))
        half = dict(found[-1][1])
        self.assertEqual(half.pop("gains"), 0.9)
        self.assertEqual(half.pop("strength"), 0.95)
        self.assertEqual(half.pop("friction"), 0.65)
        self.assertEqual(half.pop("velocity"), 0.5)
        self.assertEqual(half.pop("commands"), 4)  # seconds: half as often
        for name, value in half.items():
            self.assertEqual(value, STRESSES[name].default / 2)

    def test_rows_can_be_asked_of_another_program(self):
        asked = rows("delay,gains=0.8+payload=0.5,half")
        self.assertTrue(text(asked).startswith("delay=20.0,gains=0.8+payload=0.5,delay=10.0+"))
        self.assertEqual([row for _, row in rows(text(asked))], [row for _, row in asked])
        self.assertEqual(text(rows("none")), "")

    def test_what_is_no_stress_is_refused_with_what_there_is(self):
        for text, words in (
            ("delya=20", "delay, gains"), ("", "delay, gains"), ("delay,", "delay, gains"), ("none=1", "delay, gains"),
            ("delay=", "from 0 to 1000 ms"), ("delay=-1", "from 0 to 1000 ms"), ("delay=nan", "from 0 to 1000 ms"),
            ("gains=0", "from 0.01"), ("push=inf", "from 0 to"), ("friction=x", "number from 0 to 10"),
            ("push+push=3", "twice"), ("gains=0.5+standard", "no stress"),
        ):
            with self.assertRaisesRegex(StressError, words, msg=text):
                rows(text)

    def test_what_comes_to_something_else_than_it_says_is_said(self):
        def said(text, terms=("height",), seconds=20.0):
            return remarks(rows(text), terms, 0.005, seconds)

        self.assertEqual(said("delay=20,push,commands,velocity"), [])
        # 7.5 ms are one and a half steps of 5 ms.
        self.assertEqual(said("delay=7.5"), ["delay=7.5: 2 physics steps of 5 ms, 10 ms"])
        self.assertIn("after 3 to 5 s", said("push", seconds=4.0)[0])
        self.assertIn("over", said("commands=4", seconds=4.0)[0])
        self.assertIn("changes nothing", said("velocity", terms=["gravity"])[0])

    def test_help_names_every_stress_with_its_default(self):
        for name, stress in STRESSES.items():
            self.assertRegex(explained(), rf"(?m)^{name} +{stress.default:g} .*{stress.help[:10]}")


class Stresses(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.policy = Policy(EXPORT)
        cls.model, _ = load(EXPORT / "g1.xml", cls.policy)

    def robot(self, *stresses, model=None, index=0, seed=1):
        return robot_of(model or self.model, self.policy, PLAIN, list(stresses), seed, index)

    def at_2_ms(self, bumps=0.0):
        text = (EXPORT / "g1.xml").read_text().replace('timestep="0.005"', 'timestep="0.002"')
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "robot.xml"
            path.write_text(text)
            return load(path, self.policy, bumps)[0]

    def test_a_delay_of_20_ms_is_ten_steps_of_2_ms(self):
        robot = self.robot(("delay", 20), model=self.at_2_ms())
        self.assertEqual((robot.substeps, robot.delay), (10, 10))
        self.assertEqual(self.robot(("delay", 20)).delay, 4)  # of 5 ms
        # One control step is 20 ms: what is wanted in the first is done in the second.
        wanted = robot.default + 0.1
        robot.track(wanted)
        np.testing.assert_array_equal(robot.data.ctrl, robot.default)
        robot.track(wanted + 0.1)
        np.testing.assert_array_equal(robot.data.ctrl, wanted)
        # And 10 ms are half of it.
        robot = self.robot(("delay", 10), model=self.at_2_ms())
        seen = []
        robot.each_substep.append(lambda: seen.append(robot.data.ctrl[0]))
        robot.track(robot.default + 0.1)
        self.assertEqual([round(each - robot.default[0], 9) for each in seen[1:]], [0.0] * 5 + [0.1] * 4)

    def test_gains_and_strength_scale_the_motors(self):
        robot = self.robot(("gains", 0.8), ("strength", 0.5))
        # The left knee: kp 150, kd 4, 139 N·m.
        self.assertEqual((robot.kp[3], robot.kd[3], robot.effort[3]), (120, 3.2, 69.5))
        np.testing.assert_allclose(robot.model.actuator_gainprm[3, 0], 120)
        np.testing.assert_allclose(robot.model.actuator_biasprm[3, :3], [0, -120, -3.2])
        np.testing.assert_allclose(robot.model.actuator_forcerange[3], [-69.5, 69.5])
        # 120 · 0.1 N·m, and no more than 69.5.
        for off, force in ((0.1, 12.0), (1.0, 69.5)):
            robot.stand()
            robot.data.ctrl[:] = robot.default
            robot.data.ctrl[3] += off
            mujoco.mj_forward(robot.model, robot.data)
            self.assertAlmostEqual(robot.data.actuator_force[3], force)

    def test_a_payload_adds_its_weight(self):
        robot = self.robot(("payload", 4))
        self.assertAlmostEqual(robot.weight(), (MASS + 4) * 9.81, places=6)
        self.assertAlmostEqual(self.robot().weight(), MASS * 9.81, places=6)

    def test_friction_is_of_floor_and_soles(self):
        for value in (0.1, 0.8):
            robot = self.robot(("friction", value))
            for geom in ("floor", "left_ankle_roll_link_sole"):
                self.assertEqual(robot.model.geom(geom).friction[0], value)
            robot.stand()
            self.assertEqual(robot.data.contact[0].friction[0], value)
        # The model that robots without stress share stays.
        self.assertEqual(self.model.geom("floor").friction[0], 1.0)

    def test_a_slope_turns_gravity_by_its_angle_and_each_episode_another_way(self):
        for index, uphill in enumerate([(1, 0), (-1, 0), (0, 1), (0, -1), (1, 0)]):
            robot = self.robot(("slope", 30), index=index)
            # sin 30° = 1/2, cos 30° = √3/2: gravity pulls downhill.
            expected = [-0.5 * uphill[0], -0.5 * uphill[1], -math.sqrt(3) / 2]
            np.testing.assert_allclose(robot.model.opt.gravity, 9.81 * np.array(expected), atol=1e-9)
            np.testing.assert_allclose(robot.measured()["gravity"], expected, atol=1e-9)
            self.assertAlmostEqual(math.degrees(robot.lean()), 30.0)
        np.testing.assert_array_equal(self.model.opt.gravity, [0, 0, -9.81])

    def test_bumps_rise_from_the_floor_up_to_their_height_around_a_level_start(self):
        model = self.at_2_ms(0.02)
        robot, other, again = (self.robot(("bumps", 2), model=model, index=i) for i in (0, 1, 0))
        heights = robot.model.hfield(BUMPS).data * robot.model.hfield(BUMPS).size[2]
        self.assertEqual(heights.shape, (501, 501))  # 100 m at every 20 cm
        self.assertTrue(0.0199 < heights.max() <= 0.02 and heights.min() == 0.0)
        self.assertAlmostEqual(heights.mean(), 0.01, delta=1e-4)
        self.assertEqual(heights[248:253, 250].max(), 0.0)
        self.assertGreater(heights[247 - 5 : 247, 250].max(), 0.0)
        self.assertFalse(np.array_equal(robot.model.hfield_data, other.model.hfield_data))
        np.testing.assert_array_equal(robot.model.hfield_data, again.model.hfield_data)
        # Two metres ahead a foot meets what is there and not the plane under it.
        robot.position[:2] = 2.0, 0.0
        robot.step(np.zeros(23))
        met = {robot.model.geom(geom).name for geom in robot.data.contact.geom.flat}
        self.assertIn(BUMPS, met)

    def test_a_push_is_its_force_for_50_ms_every_three_to_five_seconds(self):
        robot = self.robot(("push", 250), model=self.at_2_ms())
        forces = []
        for _ in range(11 * 500):
            robot.each_substep[0]()
            forces.append(robot.data.xfrc_applied[robot.torso].copy())
        sizes = np.linalg.norm(forces, axis=1)
        np.testing.assert_allclose(sizes[sizes > 0], 250)
        self.assertEqual(np.abs(np.array(forces)[:, 2:]).max(), 0.0)
        begins = np.flatnonzero((sizes[1:] > 0) & (sizes[:-1] == 0)) + 1
        ends = np.flatnonzero((sizes[1:] == 0) & (sizes[:-1] > 0)) + 1
        self.assertEqual((ends - begins[: len(ends)]).tolist(), [25] * len(ends))  # 50 ms / 2 ms
        self.assertTrue(2 <= len(ends) <= 3)
        rests = np.diff([0, *begins]) - np.array([0, *[25] * (len(begins) - 1)])
        self.assertTrue(np.all((rests >= 1500) & (rests <= 2500)), rests)

    def test_an_encoder_misleads_the_policy_and_the_motor_alike(self):
        robot = self.robot(("encoder", 0.02))
        off = robot.encoder
        self.assertTrue(0.01 < np.abs(off).max() <= 0.02 and np.unique(off).size == 23)
        np.testing.assert_allclose(robot.measured()["joint_position"], off, atol=1e-12)
        robot.track(robot.default)
        np.testing.assert_allclose(robot.data.ctrl, robot.default - off)
        self.assertFalse(np.array_equal(off, self.robot(("encoder", 0.02), index=1).encoder))

    def test_an_aslant_imu_tells_gravity_and_turning_turned(self):
        robot = self.robot(("imu", 2))
        told = robot.measured()["gravity"]
        self.assertAlmostEqual(math.degrees(math.acos(-told[2])), 2.0, places=6)
        robot.turning[:] = -3 * robot.gravity()  # about the vertical
        np.testing.assert_allclose(robot.measured()["angular_velocity"], -3 * told, atol=1e-12)
        np.testing.assert_allclose(robot.imu @ robot.imu.T, np.eye(3), atol=1e-12)

    def test_dry_friction_is_added_to_joints_alone(self):
        robot = self.robot(("dry", 1.5))
        np.testing.assert_array_equal(robot.model.dof_frictionloss, [0.0] * 6 + [1.5] * 23)

    def test_velocity_and_height_are_withheld_by_their_share(self):
        for share in (0.0, 0.5, 1.0):
            robot = self.robot(("velocity", share))
            robot.velocity[:] = 2.0, 0.0, 0.0
            robot.position[2] += 0.1
            told = robot.measured()
            np.testing.assert_allclose(told["linear_velocity"], [2 * share, 0, 0], atol=1e-9)
            self.assertAlmostEqual(told["height"][0], 0.7842021819 + 0.1 * share, places=6)

    def test_commands_change_every_two_seconds_within_what_was_taught(self):
        robot = self.robot(("commands", 2))
        told = []
        for _ in range(301):
            robot.each_step[0]()
            told.append(robot.command.copy())
        changes = [i for i in range(1, len(told)) if not np.array_equal(told[i], told[i - 1])]
        self.assertEqual(changes, [100, 200, 300])  # 2 s at 50 Hz
        np.testing.assert_array_equal(told[0], PLAIN)
        least, most = self.policy.taught("yaw_rate")
        for forward, left, turn in told:
            self.assertTrue(0 <= forward <= 0.5 and left == 0 and max(-0.5, least) <= turn <= min(0.5, most))

    def test_the_same_seed_gives_the_same_figures_and_what_is_neutral_changes_none(self):
        def figures(stresses, seed=3):
            return walk(self.model, self.policy, PLAIN, 2, 0.4, False, seed, stresses)

        hard = [("push", 900.0), ("encoder", 0.05), ("imu", 3.0), ("delay", 10.0)]
        self.assertEqual(figures(hard), figures(hard))
        self.assertNotEqual(figures(hard), figures(hard, seed=4))
        neutral = [(name, stress.neutral) for name, stress in STRESSES.items() if name not in ("bumps", "commands")]
        self.assertEqual(figures(neutral), figures([]))
        # Another stress beside it draws nothing from the same generator.
        alone, beside = self.robot(("encoder", 0.05)), self.robot(("imu", 2), ("encoder", 0.05))
        np.testing.assert_array_equal(alone.encoder, beside.encoder)


if __name__ == "__main__":
    unittest.main()
