"""Tests of reading any MJCF: `AMPCO_EXPORT=DIR python -m unittest transfer.test_model` in deploy/."""

import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from xml.etree import ElementTree

import mujoco
import numpy as np

from .episodes import robot_of
from .error import ExportError
from .model import load
from .policy import Policy
from .robot import Robot
from .stress import BUMPS

EXPORT = Path(os.environ.get("AMPCO_EXPORT", "policy"))
OWN = (EXPORT / "g1.xml").read_text() if (EXPORT / "g1.xml").is_file() else ""
SCRIPT = Path(__file__).parents[1] / "sim2sim.py"
HEIGHT = 0.7842021819153314  # Of the pelvis over the soles in the default pose, from `g1`.


def without(text, *elements):
    for element in elements:
        text = re.sub(rf"<{element}>.*?</{element}>", "", text, flags=re.DOTALL)
    return text


def bare():
    """Neither floor, light, actuators nor keyframe, joints without `_joint`, 2 ms by Euler's rule."""
    text = re.sub(r"<light [^>]*/>|<geom name=\"floor\"[^>]*/>", "", without(OWN, "actuator", "keyframe"))
    text = text.replace("_joint\"", "\"").replace('timestep="0.005"', 'timestep="0.002"')
    return text.replace('integrator="implicitfast"', 'integrator="Euler"')


class Models(unittest.TestCase):
    def setUp(self):
        self.policy = Policy(EXPORT)
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name) / "robot.xml"

    def loaded(self, text, bumps=0.0):
        self.path.write_text(text)
        return load(self.path, self.policy, bumps)

    def refused(self, text, words, bumps=0.0):
        with self.assertRaises(ExportError) as caught:
            self.loaded(text, bumps)
        self.assertIn(str(self.path), str(caught.exception))
        self.assertRegex(str(caught.exception), words)

    def test_the_exports_own_model_stays_what_it_is(self):
        model, _ = load(EXPORT / "g1.xml", self.policy)
        plain = mujoco.MjModel.from_xml_path(str(EXPORT / "g1.xml"))
        for field in ("actuator_gainprm", "actuator_biasprm", "actuator_forcerange", "body_mass", "geom_friction"):
            np.testing.assert_array_equal(getattr(model, field), getattr(plain, field))
        robot = Robot(model, self.policy)
        self.assertEqual(robot.substeps, 4)  # 200 Hz / 50 Hz
        self.assertAlmostEqual(robot.height(), HEIGHT, places=9)

    def test_what_a_model_lacks_is_added_and_said(self):
        model, notes = self.loaded(bare())
        said = "\n".join(notes)
        for words in ("23 joints are named without `_joint`", "no floor", "no light"):
            self.assertIn(words, said)
        self.assertEqual((model.nu, model.nlight, model.opt.timestep), (23, 1, 0.002))
        robot = Robot(model, self.policy)
        self.assertEqual(robot.substeps, 10)  # 20 ms / 2 ms
        self.assertAlmostEqual(robot.height(), HEIGHT, places=9)
        action = np.zeros(robot.joints)
        for _ in range(10):
            robot.step(action)
        # A fifth of a second later it still stands on its soles.
        self.assertAlmostEqual(robot.height(), HEIGHT, delta=0.02)
        self.assertGreater(robot.sole_force(), 100)

    def test_both_ways_to_name_joints_walk_alike(self):
        action = np.linspace(-0.5, 0.5, 23)
        states = []
        for text in (OWN, OWN.replace("_joint\"", "\"")):
            robot = Robot(self.loaded(text)[0], self.policy)
            robot.step(action)
            states.append(robot.data.qpos.copy())
        np.testing.assert_array_equal(*states)

    def test_the_order_of_joints_and_what_stands_beside_the_robot_are_free(self):
        # Arms before legs and right before left, and a ball ahead of all.
        tree = ElementTree.fromstring(OWN)
        for body in list(tree.iter("body")):
            own = body.findall("body")
            for child in own:
                body.remove(child)
            body.extend(reversed(own))
        inertia = '<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>'
        ball = f'<body pos="3 0 1"><freejoint/>{inertia}<geom size="0.1"/></body>'
        tree.find("worldbody").insert(0, ElementTree.fromstring(ball))
        other = ElementTree.tostring(tree, "unicode")
        robot, plain = (Robot(self.loaded(text)[0], self.policy) for text in (other, OWN))
        # Behind the ball, the pelvis, the waist and ten joints of arms there is the right leg, and then the left one.
        self.assertEqual((robot.base, robot.q[0], robot.q[12]), (7, 14 + 17, 14))
        for each in (robot, plain):
            each.command = np.array([1.0, 0.0, 0.0])
            for _ in range(3):
                each.step(np.linspace(-0.5, 0.5, 23))
        np.testing.assert_allclose(robot.observe(), plain.observe(), atol=1e-6)
        self.assertAlmostEqual(robot.weight(), plain.weight())  # The ball is none of it.

    def test_a_floor_may_be_anywhere_and_of_anything(self):
        plane = r'<geom name="floor"[^>]*/>'
        low = re.sub(plane, '<geom type="plane" size="0 0 1" pos="0 0 -0.5"/>', OWN)
        box = re.sub(plane, '<body><geom type="box" size="9 9 0.25" pos="0 0 0.5"/></body>', OWN)
        for text, ground in ((low, -0.5), (box, 0.75)):
            robot = Robot(self.loaded(text)[0], self.policy)
            self.assertAlmostEqual(robot.feet.ground, ground)
            self.assertAlmostEqual(robot.position[2], ground + HEIGHT, places=9)
            robot.step(np.zeros(23))
            self.assertGreater(robot.sole_force(), 100)
            self.assertFalse(robot.has_fallen(self.policy.description["task"]))
        self.refused(box, "plane", bumps=0.02)

    def test_a_sole_may_be_of_any_shape(self):
        sizes = {"sphere": "0.03", "capsule": "0.03 0.04", "cylinder": "0.05 0.03", "ellipsoid": "0.08 0.03 0.03"}
        for shape, size in sizes.items():
            box = r'(_sole" type=")box(" pos=")[^"]*(" size=")[^"]*'
            text, count = re.subn(box, rf"\g<1>{shape}\g<2>0 0 0\g<3>{size}", OWN)
            self.assertEqual(count, 2)
            robot = Robot(self.loaded(text)[0], self.policy)
            heights, _ = robot.feet.lowest(robot.data)
            self.assertAlmostEqual(heights.min(), 0.0, places=9)
            # Nothing touches the floor a millimetre higher, all that stands does one lower.
            for lift, touches in ((0.002, False), (-0.002, True)):
                robot.position[2] += lift
                mujoco.mj_forward(robot.model, robot.data)
                self.assertEqual(robot.sole_force() > 0, touches, (shape, lift))
                robot.position[2] -= lift

    def test_joints_that_the_policy_does_not_drive_are_rigid(self):
        waist = '<joint name="waist_yaw_joint"'
        more = OWN.replace(waist, '<joint name="waist_roll_joint" axis="1 0 0"/>' + waist)
        model, notes = self.loaded(more)
        self.assertEqual(model.njnt, 24)
        self.assertTrue(any("rigid: waist_roll_joint" in note for note in notes))

    def test_the_torso_is_what_is_heaviest_above_the_waist(self):
        # As in models of 29 joints: a light link, and the torso on joints that the policy does not drive.
        tree = ElementTree.fromstring(OWN)
        pelvis = tree.find("worldbody/body")
        torso = next(body for body in pelvis.findall("body") if body.get("name") == "torso_link")
        link = ElementTree.SubElement(pelvis, "body", {"name": "waist_link", "pos": torso.get("pos")})
        link.append(torso.find("joint"))
        ElementTree.SubElement(link, "inertial", {"pos": "0 0 0", "mass": "0.2", "diaginertia": "0.1 0.1 0.1"})
        pelvis.remove(torso)
        link.append(torso)
        torso.remove(torso.find("joint"))
        torso.insert(0, ElementTree.fromstring('<joint name="waist_roll_joint" axis="1 0 0"/>'))
        torso.set("pos", "0 0 0")
        robot = Robot(self.loaded(ElementTree.tostring(tree, "unicode"))[0], self.policy)
        self.assertEqual(robot.model.body(robot.torso).name, "torso_link")

    def test_what_cannot_be_driven_is_refused_with_file_joint_and_remedy(self):
        self.refused(OWN.replace("left_knee_joint", "left_knie"), "no joint left_knee_joint .*name the joints")
        self.refused(OWN.replace("_joint\"", "_j\""), "left_hip_pitch_joint.* and 20 more")
        self.refused(OWN.replace('<freejoint name="floating_base"/>', ""), "pelvis is fixed.*freejoint")
        self.refused(OWN.replace('timestep="0.005"', 'timestep="0.003"'), "timestep of 0.003 s does not divide.*0.02 s")
        slide = OWN.replace('name="left_knee_joint"', 'name="left_knee_joint" type="slide"')
        self.refused(slide, "left_knee_joint is no hinge")
        self.refused("<mujoco><nothing/></mujoco>", "cannot be read as MJCF")
        self.refused("no XML", "cannot be read as MJCF")
        with self.assertRaisesRegex(ExportError, "nowhere.xml is not a file.*export --mjcf"):
            load("nowhere.xml", self.policy)
        barefoot = OWN.replace('contype="0" conaffinity="1"', 'contype="0" conaffinity="0"')
        self.refused(barefoot, "left_ankle_roll_link meets the floor: give it a geom")
        tilted = OWN.replace('geom name="floor"', 'geom name="floor" euler="0 0.0872665 0"')
        self.refused(tilted, r"tilted by 5.0°: level it, and ask for --stress slope=5.0")
        # 2.8798°
        degrees = OWN.replace('angle="radian"', 'angle="degree"')
        self.refused(degrees, "joint left_hip_pitch_joint goes from -0.04417 to 0.05026 rad .* stands at -0.1 rad")
        stump = '<equality><joint joint1="waist_roll_joint"/></equality><keyframe>'
        waist = '<joint name="waist_yaw_joint"'
        more = OWN.replace("<keyframe>", stump)
        more = more.replace(waist, '<joint name="waist_roll_joint" axis="1 0 0"/>' + waist)
        self.refused(more, "does not compile with .*waist_roll_joint.*take out")

    def test_a_floor_may_be_met_by_pairs_and_bumps_and_friction_with_it(self):
        text = re.sub(r'(<geom name="floor"[^>]*)contype="1"', r'\1contype="0"', OWN)
        text = text.replace('contype="0" conaffinity="1"', 'contype="0" conaffinity="0"')
        soles = ("left_ankle_roll_link_sole", "right_ankle_roll_link_sole")
        pairs = "".join(f'<pair geom1="{sole}" geom2="floor" condim="3"/>' for sole in soles)
        model, notes = self.loaded(text.replace("<contact>", "<contact>" + pairs), bumps=0.02)
        self.assertFalse(any("no floor" in note for note in notes))
        robot = robot_of(model, self.policy, [0, 0, 0], [("bumps", 2.0), ("friction", 0.25)])
        robot.position[0] = 2.0
        robot.step(np.zeros(23))
        met = {robot.model.geom(geom).name for geom in robot.data.contact.geom.flat}
        self.assertIn(BUMPS, met)
        self.assertEqual(robot.data.contact.friction[:, 0].tolist(), [0.25] * robot.data.ncon)

    def test_what_is_odd_is_said(self):
        _, notes = self.loaded(OWN.replace('<joint name="left_knee_joint"', '<joint name="left_knee_joint" ref="0.2"'))
        self.assertTrue(any("left_knee_joint has ref 0.2 rad" in note for note in notes))

    def test_a_state_that_is_no_number_has_fallen_and_does_not_begin_anew(self):
        robot = Robot(self.loaded(OWN)[0], self.policy)
        robot.velocity[0] = np.nan
        robot.step(np.zeros(23))
        self.assertTrue(robot.has_fallen(self.policy.description["task"]))

    def test_the_script_ends_with_the_same_words(self):
        self.path.write_text(OWN.replace("left_knee_joint", "left_knie"))
        call = [sys.executable, SCRIPT, EXPORT, "--model", self.path, "--json", self.path.with_suffix(".json")]
        done = subprocess.run(call, capture_output=True, text=True)
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, "^sim2sim: .*robot.xml has no joint left_knee_joint")
        self.assertFalse(self.path.with_suffix(".json").exists())


if __name__ == "__main__":
    unittest.main()
