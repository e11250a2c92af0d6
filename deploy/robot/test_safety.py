"""Tests of limits: `AMPCO_EXPORT=DIR python -m unittest robot.test_safety` in deploy/."""

import copy
import os
import unittest
from pathlib import Path

import numpy as np

from transfer.policy import Policy

from .error import RobotError
from .faults import FAULTS
from .messages import low_state
from .motors import Motors
from .safety import Limits, fault, silence
from .state import MOTORS, State

EXPORT = Path(os.environ.get("AMPCO_EXPORT", "policy"))
KNEE, WAIST_ROLL, SHOULDER = 3, 13, 15


def motors():
    return Motors(Policy(EXPORT).description, "policy.json")


def state(change=lambda message: None):
    message = low_state(4)
    change(message)
    return State(message, 0.0)


class Faults(unittest.TestCase):
    def found(self, change, limits=None):
        return fault(state(change), motors(), limits or Limits())

    def test_a_robot_that_stands_has_none(self):
        self.assertIsNone(self.found(lambda message: None))

    def test_each_says_what_and_how_much(self):
        for name, words in {
            "tilt": "tilt: 70°, limit 57°",
            "heat": "temperature: left_knee at 120 °C, limit 90 °C",
            "speed": "speed: left_knee at 60.0 rad/s, limit 20 rad/s",
            "position": "position: left_knee at -1.00 rad, range -0.09 to 2.88 rad",
            "nan": "state: position is no number",
            "imu": "state: the IMU tells no orientation",
        }.items():
            self.assertEqual(self.found(lambda message, name=name: FAULTS[name](None, message)), words)

    def test_held_motors_count_too(self):
        def bent(message):
            message.motor_state[WAIST_ROLL].q = 0.8

        self.assertRegex(self.found(bent), "waist_roll at 0.80 rad, range -0.52")

    def test_limits_can_be_moved(self):
        self.assertIsNone(self.found(lambda message: FAULTS["tilt"](None, message), Limits(tilt=1.3)))
        self.assertRegex(self.found(lambda _: None, Limits(temperature=29)), "at 30 °C, limit 29 °C")

    def test_silence(self):
        self.assertIsNone(silence(10.1, 10.0, Limits(silence=0.11), "rt/lowstate"))
        self.assertEqual(
            silence(10.15, 10.0, Limits(), "rt/lowstate"),
            "stale state: no new and intact rt/lowstate for 150 ms, limit 100 ms",
        )


class Targets(unittest.TestCase):
    def setUp(self):
        self.motors = motors()
        self.kp, self.kd = self.motors.kp, self.motors.kd

    def limited(self, motor, target, position=0.0, velocity=0.0):
        def change(message):
            message.motor_state[motor].q, message.motor_state[motor].dq = position, velocity

        found = state(change)
        targets = np.zeros(MOTORS)
        targets[motor] = target
        targets = self.motors.limited(targets, self.kp, self.kd, found)
        return targets[motor], self.motors.torque(targets, self.kp, self.kd, found)[motor]

    def test_what_can_be_done_stays(self):
        self.assertEqual(self.limited(KNEE, 0.5)[0], 0.5)

    def test_a_motor_is_asked_for_twice_its_effort_at_most(self):
        # Knee: 150 N·m/rad, 4 N·m·s/rad, 139 N·m. From 0 a target of 2 rad would take 300 N·m: 278/150 = 1.8533 rad do.
        target, torque = self.limited(KNEE, 2.0)
        self.assertAlmostEqual(target, 278 / 150)
        self.assertAlmostEqual(torque, 278.0)
        # While it turns at 10 rad/s damping takes 40 of them back: (278 + 40)/150.
        target, torque = self.limited(KNEE, 2.5, velocity=10.0)
        self.assertAlmostEqual(target, 318 / 150)
        self.assertAlmostEqual(torque, 278.0)
        # And backwards from 2.5 rad: 2.5 − (278 + 40)/150 while it turns at −10 rad/s.
        target, torque = self.limited(KNEE, 0.0, position=2.5, velocity=-10.0)
        self.assertAlmostEqual(target, 2.5 - 318 / 150)
        self.assertAlmostEqual(torque, -278.0)

    def test_a_target_is_within_the_joints_range(self):
        self.assertAlmostEqual(self.limited(KNEE, -1.0)[0], -0.087267)
        self.assertAlmostEqual(self.limited(KNEE, 9.0, position=2.8)[0], 2.8798)

    def test_motors_are_told_in_unitrees_order(self):
        spread = self.motors.spread(np.arange(100, 123))
        # Waist yaw is the 13th joint and motor 12; the left shoulder's pitch the 14th and 15; the right wrist's roll 26.
        self.assertEqual((spread[12], spread[SHOULDER], spread[22], spread[26]), (112, 113, 118, 122))
        self.assertTrue((spread[[13, 14, 20, 21, 27, 28]] == 0).all())
        self.assertEqual((self.kp[WAIST_ROLL], self.kd[WAIST_ROLL], self.kp[20], self.kd[20]), (40, 5, 40, 1))
        command = self.motors.command(spread, self.kp, self.kd, 5)
        self.assertEqual((command.mode_machine, command.mode_pr), (5, 0))
        self.assertEqual(command.motor_cmd[SHOULDER].q, 113.0)
        self.assertEqual([motor.mode for motor in command.motor_cmd], [1] * 29 + [0] * 6)

    def test_damping_pulls_nowhere(self):
        command = self.motors.damping(4)
        told = [(motor.kp, motor.tau, motor.dq, motor.kd) for motor in command.motor_cmd[:MOTORS]]
        self.assertEqual(told, [(0.0, 0.0, 0.0, 3.0)] * MOTORS)

    def test_an_export_that_does_not_say_all_motors_is_refused(self):
        description = copy.deepcopy(Policy(EXPORT).description)
        del description["held_motors"]
        with self.assertRaisesRegex(RobotError, "policy.json.*export the run again"):
            Motors(description, "policy.json")


if __name__ == "__main__":
    unittest.main()
