"""Tests of the phases, the operator and deadlines: `AMPCO_EXPORT=DIR python -m unittest robot.test_control` in deploy/."""

import os
import pty
import tempfile
import time
import unittest
from pathlib import Path
from unittest import mock

import numpy as np

from transfer.policy import Policy

from .control import Controller, Stop
from .messages import low_state
from .motors import DAMPING, Motors
from .observation import Observer
from .pace import Pace
from .state import State, remote_bytes
from .tell import Teller
from .wish import Keyboard, Remote, Wish, sticks

EXPORT = Path(os.environ.get("AMPCO_EXPORT", "policy"))
KNEE, WAIST_ROLL = 3, 13
RANGES = np.array([[-0.5, 2.0], [-0.25, 0.25], [-1.0, 1.0]])
STILL = np.zeros(3)


def state(keys=(), **pushed):
    """Knees at 0.7 rad, elbows as in the default pose."""
    message = low_state(4)
    message.motor_state[18].q = message.motor_state[25].q = 0.97
    message.motor_state[KNEE].q = message.motor_state[9].q = 0.7
    message.wireless_remote = remote_bytes(keys, **pushed)
    return State(message, 0.0, (np.array([0.0, 0.0, 0.78]), np.zeros(3)))


class Phases(unittest.TestCase):
    def setUp(self):
        policy = Policy(EXPORT)
        self.motors = Motors(policy.description, "policy.json")
        self.controller = Controller(policy, self.motors, Observer(policy, self.motors), RANGES, 0.08)  # four steps

    def act(self, held, go=False, command=STILL):
        return self.controller.act(state(), Wish(held, go, np.asarray(command)))

    def rise(self):
        self.act(False)
        return [self.act(True) for _ in range(4)]

    def test_nothing_moves_until_the_key_is_pressed_anew(self):
        for held in (True, True, False):
            _, kp, kd = self.act(held)
            self.assertEqual((kp.any(), set(kd)), (False, {DAMPING}))
        self.act(True)
        self.assertEqual(self.controller.phase, "standing up")

    def test_it_stands_up_from_where_it_is_with_gains_that_grow(self):
        steps = self.rise()
        # A quarter of the way from 0.7 to the default 0.3 in each of four steps; kp comes from 0 to 150, kd from 3 to 4.
        np.testing.assert_allclose([target[KNEE] for target, _, _ in steps], [0.6, 0.5, 0.4, 0.3])
        np.testing.assert_allclose([kp[KNEE] for _, kp, _ in steps], [37.5, 75, 112.5, 150])
        np.testing.assert_allclose([kd[KNEE] for _, _, kd in steps], [3.25, 3.5, 3.75, 4.0])
        np.testing.assert_allclose([kp[WAIST_ROLL] for _, kp, _ in steps], [10, 20, 30, 40])
        target, kp, kd = self.act(True)
        self.assertEqual(self.controller.phase, "ready")
        np.testing.assert_allclose(target, self.motors.default)
        np.testing.assert_allclose((kp, kd), (self.motors.kp, self.motors.kd))

    def test_it_walks_when_it_is_told_to_and_not_before(self):
        self.act(False)
        for _ in range(4):
            self.act(True, go=True)
        self.assertEqual(self.controller.phase, "standing up")
        self.act(True)
        self.act(True, go=True)
        self.assertEqual(self.controller.phase, "walking")

    def test_the_first_action_is_that_of_the_policy(self):
        self.rise()
        self.act(True)
        policy = Policy(EXPORT)
        seen = Observer(policy, self.motors).row(state(), STILL, np.zeros(23))
        expected = self.motors.spread(self.motors.default[self.motors.driven] + 0.25 * policy.actions([seen])[0])
        target, kp, kd = self.act(True, go=True)
        np.testing.assert_allclose(target, self.motors.limited(expected, kp, kd, state()), atol=1e-6)

    def test_commands_change_by_a_metre_per_second_in_a_second(self):
        self.rise()
        self.act(True)
        for _ in range(10):
            self.act(True, go=True, command=[2.0, 0.25, -0.1])
        # Ten steps of 20 ms.
        np.testing.assert_allclose(self.controller.command, [0.2, 0.2, -0.1])
        for _ in range(90):
            self.act(True, command=[9.0, 9.0, 0.0])
        np.testing.assert_allclose(self.controller.command, [2.0, 0.25, 0.0])

    def test_letting_go_ends_every_phase_and_is_no_fault(self):
        for steps in (0, 3, 6):
            self.setUp()
            self.act(False)
            for step in range(1 + steps):
                self.act(True, go=step == 5)
            with self.assertRaisesRegex(Stop, "let go") as stopped:
                self.act(False)
            self.assertEqual(stopped.exception.code, 0)
        self.assertEqual(self.controller.phase, "walking")

    def test_an_action_that_is_no_number_is_not_sent(self):
        class Broken:
            description = Policy(EXPORT).description

            def actions(self, rows):
                return [np.full(23, np.nan)]

        self.controller._policy = Broken()
        self.rise()
        self.act(True)
        with self.assertRaisesRegex(Stop, "no number") as stopped:
            self.act(True, go=True)
        self.assertEqual(stopped.exception.code, 1)


class OfTheRemote(unittest.TestCase):
    def test_sticks_are_shares_of_what_was_taught(self):
        remote = Remote(RANGES)
        wish = remote.wish(state(["L1"], left_y=0.5, left_x=1.0, right_x=-0.5), 0.0)
        # Half of 2 m/s; all the way to the right, which is −0.25; half to the left.
        self.assertEqual((wish.held, wish.go, wish.command.tolist()), (True, False, [1.0, -0.25, 0.5]))
        self.assertEqual(remote.wish(state(left_y=-1.0), 0.0)[0::2][1].tolist(), [-0.5, 0.0, 0.0])

    def test_a_policy_that_never_stood_is_not_told_to(self):
        remote = Remote(np.array([[0.4, 1.4], [0.0, 0.0], [0.0, 0.0]]))
        for stick, asked in ((0.0, 0.4), (0.5, 0.7), (-1.0, 0.4)):
            self.assertAlmostEqual(remote.wish(state(left_y=stick, left_x=1.0), 0.0).command[0], asked)

    def test_start_counts_when_it_is_pressed(self):
        remote = Remote(RANGES)
        keys = (["start"], [], ["start"], ["start"], [], ["start"])
        # Whoever has held it from the beginning has not pressed it.
        self.assertEqual([remote.wish(state(k), 0.0).go for k in keys], [False, False, True, False, False, True])

    def test_sticks_of_a_command_ask_for_it(self):
        for asked in ([1.0, 0.1, -0.5], [-0.4, -0.25, 1.0]):
            got = Remote(RANGES).wish(state(["L1"], **sticks(asked, RANGES)), 0.0).command
            np.testing.assert_allclose(got, asked, atol=1e-6)


class OfTheKeyboard(unittest.TestCase):
    def setUp(self):
        self.ours, theirs = pty.openpty()
        self.stream = os.fdopen(theirs)
        self.addCleanup(os.close, self.ours)
        self.addCleanup(self.stream.close)

    def test_any_key_that_repeats_is_held_and_others_do_what_they_say(self):
        with Keyboard(RANGES, self.stream) as keyboard:
            self.assertFalse(keyboard.wish(None, 10.0).held)
            os.write(self.ours, b" ")
            self.assertTrue(keyboard.wish(None, 10.0).held)
            self.assertTrue(keyboard.wish(None, 10.6).held)
            self.assertFalse(keyboard.wish(None, 10.8).held)
            os.write(self.ours, b"\x1b[A\x1b[A\x1b[DQe\x1b[B q")
            wish = keyboard.wish(None, 20.0)
            self.assertEqual((wish.held, wish.go, wish.command.tolist()), (True, False, [0.1, 0.1, 0.1]))
            os.write(self.ours, b"\n\x1b[B0")
            wish = keyboard.wish(None, 20.1)
            self.assertEqual((wish.go, wish.command.tolist()), (True, [0.0, 0.0, 0.0]))

    def test_commands_stay_within_what_was_taught(self):
        with Keyboard(RANGES, self.stream) as keyboard:
            os.write(self.ours, b"\x1b[A" * 30 + b"q" * 9)
            self.assertEqual(keyboard.wish(None, 0.0).command.tolist(), [2.0, 0.25, 0.0])

    def test_a_terminal_that_is_gone_holds_nothing(self):
        read, write = os.pipe()
        with os.fdopen(read) as stream, Keyboard(RANGES, stream) as keyboard:
            os.write(write, b" ")
            self.assertTrue(keyboard.wish(None, 0.0).held)
            os.close(write)
            self.assertFalse(keyboard.wish(None, 1.0).held)


class Lines(unittest.TestCase):
    def test_a_terminal_that_stalls_stalls_nothing_else(self):
        read, write = os.pipe()
        began = time.monotonic()
        with os.fdopen(write, "w") as stream, mock.patch.object(Teller, "PATIENCE", 0.1), Teller(stream) as tell:
            # More than a pipe holds, and nobody reads.
            for _ in range(3):
                tell("x" * 100_000)
            self.assertLess(time.monotonic() - began, 1.0)
            os.close(read)
        self.assertLess(time.monotonic() - began, 5.0)

    def test_lines_come_in_order(self):
        with tempfile.TemporaryFile("w+") as file:
            with Teller(file) as tell:
                for number in range(5):
                    tell(number)
            file.seek(0)
            self.assertEqual(file.read(), "0\n1\n2\n3\n4\n")


class Deadlines(unittest.TestCase):
    def test_what_comes_late_is_counted_and_not_made_up_for(self):
        now, slept = [0.0], []
        pace = Pace(0.02, clock=lambda: now[0], sleep=lambda s: (slept.append(round(s, 6)), now.__setitem__(0, now[0] + s)))
        pace.wait()
        late = []
        for work in (0.005, 0.050, 0.010):
            now[0] += work
            late.append(round(pace.wait(), 6))
        # 5 ms of work leave 15; 50 are 30 too many; the next has 10 of the 20 ms that begin there.
        self.assertEqual((late, slept), ([0.0, 0.03, 0.0], [0.015, 0.01]))
        self.assertEqual(pace.said(), "3 steps, 1 deadlines missed, the worst by 30.0 ms")


if __name__ == "__main__":
    unittest.main()
