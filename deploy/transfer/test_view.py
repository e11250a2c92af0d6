"""Tests of the keyboard: `AMPCO_EXPORT=DIR python -m unittest transfer.test_view` in deploy/. Opens no window."""

import os
import unittest
from pathlib import Path

import numpy as np

from .episodes import robot_of
from .model import load
from .policy import Policy
from .view import DOWN, LEFT, RIGHT, SPACE, UP, Commander, advance

EXPORT = Path(os.environ.get("AMPCO_EXPORT", "policy"))


class Taught:
    """A policy that walks forward up to 1 m/s, aside up to 0.2 m/s, and turns up to 0.5 rad/s."""

    def taught(self, part):
        return {"forward": (-0.3, 1.0), "lateral": (-0.2, 0.2), "yaw_rate": (-0.5, 0.5)}[part]


class Keys(unittest.TestCase):
    def pressed(self, *keys, begin=(0.5, 0.0, 0.0)):
        commander = Commander(begin, Taught())
        for key in keys:
            commander.press(key)
        return commander.command.tolist()

    def test_arrows_and_letters_change_the_command_and_space_stops(self):
        self.assertEqual(self.pressed(UP, UP), [0.7, 0.0, 0.0])
        self.assertEqual(self.pressed(DOWN), [0.4, 0.0, 0.0])
        self.assertEqual(self.pressed(LEFT, LEFT, RIGHT), [0.5, 0.0, 0.1])
        self.assertEqual(self.pressed(ord("Q")), [0.5, 0.1, 0.0])
        self.assertEqual(self.pressed(ord("E")), [0.5, -0.1, 0.0])
        self.assertEqual(self.pressed(UP, LEFT, SPACE), [0.0, 0.0, 0.0])

    def test_nothing_is_asked_that_was_never_taught_unless_it_was_asked_for(self):
        self.assertEqual(self.pressed(*[UP] * 9), [1.0, 0.0, 0.0])
        self.assertEqual(self.pressed(*[DOWN] * 20, *[ord("Q")] * 9, *[RIGHT] * 9), [-0.3, 0.2, -0.5])
        self.assertEqual(self.pressed(UP, begin=(2.0, 0.0, 0.0)), [2.0, 0.0, 0.0])

    def test_what_a_key_does_is_said_and_other_keys_say_nothing(self):
        commander = Commander((0.5, 0.0, 0.0), Taught())
        self.assertEqual(commander.press(RIGHT), "0.5 m/s forward, 0.0 m/s to the left, -0.1 rad/s")
        self.assertIsNone(commander.press(ord("X")))

    def test_the_robot_does_what_the_keys_say_and_gets_up_again(self):
        policy = Policy(EXPORT)
        model, _ = load(EXPORT / "g1.xml", policy)
        robot = robot_of(model, policy, [0.5, 0.0, 0.0])
        commander = Commander(robot.command, policy)
        commander.press(UP)
        advance(policy, robot, commander)
        np.testing.assert_allclose(robot.measured()["command"], [0.6, 0.0, 0.0])
        robot.position[2] = 0.2
        advance(policy, robot, commander)
        self.assertAlmostEqual(robot.height(), robot.standing_height)


if __name__ == "__main__":
    unittest.main()
