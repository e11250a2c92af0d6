"""Tests of the transfer: `AMPCO_EXPORT=DIR AMPCO_RECORDING=FILE python -m unittest transfer.test_transfer` in deploy/.

DIR is what `ampco export RUN --out DIR` wrote, FILE what `ampco play RUN --json FILE` wrote of the same run.
"""

import json
import os
import shutil
import tempfile
import unittest
from pathlib import Path

import mujoco
import numpy as np

from . import reference
from .episodes import figures, walk
from .error import ExportError
from .policy import Policy
from .robot import FREE, Robot

EXPORT = Path(os.environ.get("AMPCO_EXPORT", "policy"))
RECORDING = os.environ.get("AMPCO_RECORDING")
REFERENCE = Path(__file__).parents[2] / "actor/sim/tests/mujoco.json"
# Gains with which the robot stands without a policy; with those of the policy no engine holds it up.
STIFF = {"hip": (400, 4), "knee": (600, 8), "ankle": (320, 6), "waist": (800, 10)}
STIFF_ARM = (160, 2)


def load():
    return mujoco.MjModel.from_xml_path(str(EXPORT / "g1.xml")), Policy(EXPORT)


class Model(unittest.TestCase):
    def setUp(self):
        self.model, self.policy = load()

    def test_weighs_and_bends_as_described(self):
        self.assertAlmostEqual(self.model.body_mass.sum(), 32.10685728, places=6)
        names = [self.model.joint(1 + i).name for i in range(self.model.nu)]
        self.assertEqual(names, [joint["name"] for joint in self.policy.description["joints"]])
        ranges = self.model.jnt_range[1:]
        np.testing.assert_array_equal(ranges[:, 0], self.policy.joint("lower"))
        np.testing.assert_array_equal(ranges[:, 1], self.policy.joint("upper"))
        np.testing.assert_array_equal(self.model.actuator_forcerange[:, 1], self.policy.joint("effort"))

    def test_stands_with_its_weight_on_its_soles(self):
        robot = Robot(self.model, self.policy)
        for i, joint in enumerate(self.policy.description["joints"]):
            part = next((part for part in STIFF if part in joint["name"]), None)
            kp, kd = STIFF.get(part, STIFF_ARM)
            self.model.actuator_gainprm[i, 0] = kp
            self.model.actuator_biasprm[i, 1:3] = [-kp, -kd]
        robot.data.ctrl[:] = robot.default
        mujoco.mj_step(self.model, robot.data, nstep=2000)
        self.assertAlmostEqual(robot.data.qpos[2], 0.783, delta=0.003)
        weight = 32.10685728 * 9.81  # 314.97 N
        self.assertAlmostEqual(robot.sole_force(), weight, delta=0.5)

    def test_reference_is_what_this_model_does(self):
        stored = json.loads(REFERENCE.read_text())
        # It was made in the air and without contact of the robot with itself.
        self.model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
        built = reference.build(self.model, self.policy)
        for old, new in zip(stored["flights"], built["flights"], strict=True):
            np.testing.assert_allclose(new["observation"], old["observation"], atol=1e-9)
            for a, b in zip(new["steps"], old["steps"], strict=True):
                np.testing.assert_allclose(a["joint_positions"], b["joint_positions"], atol=1e-6)


class Exported(unittest.TestCase):
    def test_a_changed_file_is_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            shutil.copytree(EXPORT, folder, dirs_exist_ok=True)
            path = Path(folder) / "policy.onnx"
            path.write_bytes(path.read_bytes()[:-1] + b"x")
            with self.assertRaisesRegex(ExportError, "export the run again"):
                Policy(folder)
        with self.assertRaisesRegex(ExportError, "ampco export"):
            Policy("/nonexistent")

    @unittest.skipUnless(RECORDING, "AMPCO_RECORDING names no file")
    def test_recorded_actions_come_back(self):
        frames = json.loads(Path(RECORDING).read_text())["frames"]
        seen = [frame["observation"] for frame in frames if frame["action"]]
        done = [frame["action"] for frame in frames if frame["action"]]
        self.assertGreater(len(seen), 0)
        error = np.abs(Policy(EXPORT).actions(seen) - np.float32(done)).max()
        print(f"\n{len(seen)} recorded observations: actions differ by at most {error:.2e}")
        self.assertLess(error, 1e-5)

    @unittest.skipUnless(RECORDING, "AMPCO_RECORDING names no file")
    def test_both_simulators_see_the_same_of_the_same_state(self):
        model, policy = load()
        robot = Robot(model, policy)
        frames = json.loads(Path(RECORDING).read_text())["frames"]
        before = np.zeros(robot.joints)
        for frame in frames[:50]:
            robot.set_state(frame)
            robot.command = np.array(frame["command"])
            robot.previous_action = before
            np.testing.assert_allclose(robot.observe(), frame["observation"], atol=1e-4)
            if frame["action"]:
                before = np.array(frame["action"])


class Figures(unittest.TestCase):
    def test_by_hand(self):
        # Asked for 1 m/s, 0.8 and 0.15 done: √(0.2² + 0.15²) = 0.25 of 1.
        row = figures([1.0, 0.0, 0.0], {"energy_j": 2000.0, "velocity": [0.8, 0.15]})
        self.assertAlmostEqual(row["normalized_error"], 0.25)
        self.assertEqual(row["energy_per_step_j"], 2.0)

    def test_same_seed_same_figures_and_table_one_changes_them(self):
        model, policy = load()
        once, again = (walk(model, policy, [0.5, 0, 0], 2, 0.4, False, 3) for _ in range(2))
        self.assertEqual(once, again)
        varied = walk(model, policy, [0.5, 0, 0], 2, 0.4, True, 3)
        self.assertNotEqual(once["energy_j"], varied["energy_j"])
        self.assertAlmostEqual(model.body_mass.sum(), 32.10685728, places=6)  # the nominal model stays

    def test_work_against_a_resting_motor_is_nothing(self):
        model, policy = load()
        robot = Robot(model, policy)
        state = reference.states(robot.default.tolist())[0]
        robot.set_state(state)
        model.opt.gravity[:] = 0
        self.assertLess(robot.track(robot.default), 1e-9)
        np.testing.assert_allclose(robot.data.qpos[FREE:], robot.default, atol=1e-12)


if __name__ == "__main__":
    unittest.main()
