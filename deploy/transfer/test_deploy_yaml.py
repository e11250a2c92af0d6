"""`deploy.yaml` beside an export is YAML, and says what the ONNX file and policy.json say, in the layout's orders."""

import json
import os
import unittest
from pathlib import Path

import onnxruntime
import yaml

EXPORT = Path(os.environ.get("AMPCO_EXPORT", "policy"))


class DeployYaml(unittest.TestCase):
    def setUp(self):
        self.told = yaml.safe_load((EXPORT / "deploy.yaml").read_text())
        self.description = json.loads((EXPORT / "policy.json").read_text())
        session = onnxruntime.InferenceSession(str(EXPORT / "policy.onnx"), providers=["CPUExecutionProvider"])
        self.metadata = session.get_modelmeta().custom_metadata_map
        self.inputs = session.get_inputs()[0].shape[1]

    def of_onnx(self, key):
        return [float(part) for part in self.metadata[key].split(",")]

    def test_joints_are_those_of_the_onnx(self):
        told, action = self.told, self.told["actions"]["JointPositionAction"]
        self.assertEqual(told["joint_ids_map"], [*range(13), *range(15, 20), *range(22, 27)])
        self.assertEqual(told["default_joint_pos"], self.of_onnx("default_joint_pos"))
        self.assertEqual(action["offset"], self.of_onnx("default_joint_pos"))
        self.assertEqual(action["scale"], self.of_onnx("action_scale"))
        self.assertEqual(action["joint_names"], self.metadata["joint_names"].split(","))
        self.assertIsNone(action["clip"])
        self.assertEqual(told["step_dt"], 1 / float(self.metadata["policy_hz"]))
        # By motor, through the map.
        for key, name in (("stiffness", "joint_stiffness"), ("damping", "joint_damping")):
            self.assertEqual(len(told[key]), 29)
            self.assertEqual([told[key][motor] for motor in told["joint_ids_map"]], self.of_onnx(name))
        # A wrist that the policy does not know is held as Unitree's configuration holds it.
        self.assertEqual((told["stiffness"][20], told["damping"][20]), (40.0, 1.0))

    def test_every_number_is_a_number(self):
        def leaves(value):
            if isinstance(value, (dict, list)):
                for part in value.values() if isinstance(value, dict) else value:
                    yield from leaves(part)
            else:
                yield value

        strings = {leaf for leaf in leaves(self.told) if isinstance(leaf, str)}
        self.assertEqual(strings - set(self.metadata["joint_names"].split(",")), {"newest_first", "base_velocity"})

    def test_commands_and_observations_are_those_of_the_onnx(self):
        ranges = self.told["commands"]["base_velocity"]["ranges"]
        told = [*ranges["lin_vel_x"], *ranges["lin_vel_y"], *ranges["ang_vel_z"]]
        self.assertEqual(told, self.of_onnx("command_ranges"))
        terms = self.told["observations"]
        self.assertEqual(list(terms), self.metadata["observation_names"].split(","))
        self.assertEqual([term["history_length"] for term in terms.values()], self.of_onnx("observation_history_lengths"))
        self.assertEqual(sum(len(term["scale"]) * term["history_length"] for term in terms.values()), self.inputs)
        self.assertEqual(terms["velocity_commands"]["params"], {"command_name": "base_velocity"})

    def test_its_hash_is_in_the_description(self):
        self.assertIn("deploy.yaml", self.description["origin"]["files_sha256"])
