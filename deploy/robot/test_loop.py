"""Tests of how a run ends: `AMPCO_EXPORT=DIR python -m unittest robot.test_loop` in deploy/. No network."""

import os
import signal
import time
import unittest
from pathlib import Path
from unittest import mock

import numpy as np

from transfer.policy import Policy

from . import loop
from .control import Controller
from .faults import FAULTS
from .messages import low_state
from .motors import Motors
from .observation import Observer
from .safety import Limits
from .state import State, remote_bytes
from .wish import Remote

EXPORT = Path(os.environ.get("AMPCO_EXPORT", "policy"))
RANGES = np.array([[0.4, 1.4], [0.0, 0.0], [0.0, 0.0]])
PERIOD = 0.002  # s; nothing here needs real time
BEGUN = 4  # steps after which it stands up


class Bus:
    """A robot of a list: `at(step, message)` may change a state, or say that there is none by `False`."""

    place, awaited, damaged, is_dry = "nowhere", "rt/lowstate", 0, False

    def __init__(self, at=lambda step, message: None, before=lambda step: None):
        self.at, self.before, self.step, self.asked, self.sent, self.rival = at, before, 0, 0, [], False

    def state(self):
        self.step += 1
        self.before(self.step)
        message = low_state(4)
        message.wireless_remote = remote_bytes(["L1"] if self.step >= BEGUN else [])
        if self.at(self.step, message) is False:
            return None
        return State(message, time.monotonic(), (np.array([0, 0, 0.78]), np.zeros(3)))

    def has_rival(self):
        self.asked += 1
        # Not of what was said before the beginning.
        return self.rival and self.asked > 1

    def send(self, command):
        self.sent.append(command)


def ran(bus, operator=None, silence=0.05):
    """Exit status and lines of a run."""
    policy = Policy(EXPORT)
    motors, lines = Motors(policy.description, "policy.json"), []
    controller = Controller(policy, motors, Observer(policy, motors), RANGES, 0.1)
    hand = operator or Remote(RANGES)
    code = loop.Loop(bus, controller, motors, hand, Limits(silence=silence), PERIOD, lines.append).run()
    return code, "\n".join(lines)


@mock.patch.multiple(loop, LISTEN=0.0, FIRST=0.02, DAMPED=5 * PERIOD)
class Endings(unittest.TestCase):
    def damped(self, bus):
        """The last five commands damp, and it had moved before."""
        kinds = [any(motor.kp for motor in command.motor_cmd) for command in bus.sent]
        self.assertIn(True, kinds)
        self.assertEqual(kinds[-5:], [False] * 5)
        self.assertEqual({motor.kd for motor in bus.sent[-1].motor_cmd[:29]}, {3.0})
        self.assertEqual(bus.sent[-1].mode_machine, 4)

    def test_every_fault_ends_in_damping_with_a_reason_and_a_failure(self):
        for name, words in {
            "tilt": "stop: tilt: 70°", "heat": "stop: temperature: left_knee", "speed": "stop: speed: left_knee",
            "position": "stop: position: left_knee", "nan": "stop: state: position is no number", "imu": "stop: state: the IMU",
        }.items():
            with self.subTest(name):
                bus = Bus(lambda step, message, name=name: FAULTS[name](None, message) if step > BEGUN + 5 else None)
                code, said = ran(bus)
                self.assertIn(words, said)
                self.assertEqual(code, 1)
                self.damped(bus)

    def test_silence_ends_in_damping(self):
        bus = Bus(lambda step, message: step <= BEGUN + 5)
        code, said = ran(bus)
        self.assertRegex(said, r"stop: stale state: no new and intact rt/lowstate for \d+ ms, limit 50 ms")
        self.assertEqual(code, 1)
        self.damped(bus)

    def test_the_operator_ends_it_and_that_is_no_failure(self):
        def let_go(step, message):
            if step > BEGUN + 5:
                message.wireless_remote = remote_bytes([])

        bus = Bus(let_go)
        code, said = ran(bus)
        self.assertIn("stop: the operator let go", said)
        self.assertEqual(code, 0)
        self.damped(bus)

    def test_signals_end_in_damping(self):
        for number in loop.ENDS:
            bus = Bus(before=lambda step, number=number: os.kill(os.getpid(), number) if step == BEGUN + 5 else None)
            code, said = ran(bus)
            self.assertIn(f"stop: signal {number.name}", said)
            self.assertEqual(code, 128 + number)
            self.damped(bus)
        self.assertEqual(signal.getsignal(signal.SIGTERM), signal.SIG_DFL)

    def test_another_commander_ends_in_damping(self):
        bus = Bus(before=lambda step: setattr(bus, "rival", step > BEGUN + 5))
        code, said = ran(bus)
        self.assertIn("another program sends rt/lowcmd", said)
        self.assertEqual(code, 1)
        self.damped(bus)

    def test_a_bug_ends_in_damping(self):
        class Broken(Remote):
            def wish(self, state, now):
                if bus.step > BEGUN + 5:
                    raise ZeroDivisionError("division by zero")
                return super().wish(state, now)

        bus = Bus()
        code, said = ran(bus, Broken(RANGES))
        self.assertIn("stop: ZeroDivisionError: division by zero", said)
        self.assertEqual(code, 1)
        self.damped(bus)

    def test_a_loop_that_stood_still_ends_in_damping(self):
        bus = Bus(before=lambda step: time.sleep(0.08) if step == BEGUN + 5 else None)
        code, said = ran(bus)
        self.assertRegex(said, r"stop: late: no command for \d+ ms, limit 50 ms")
        self.assertRegex(said, r"[1-9]\d* deadlines missed")
        self.assertEqual(code, 1)
        self.damped(bus)

    def test_where_nothing_was_sent_nothing_is(self):
        for bus, words in ((Bus(lambda *_: False), "no rt/lowstate for 0.02 s on nowhere"), (Bus(), "another program")):
            bus.rival = words == "another program"
            code, said = ran(bus)
            self.assertIn(words, said)
            self.assertEqual((code, bus.sent), (1, []))

    def test_a_policy_does_not_see_a_state_twice(self):
        # Every other step has none: as many commands as states, damping aside, and the first of both is listened to.
        states = []

        def some(step, message):
            if step > 40:
                message.wireless_remote = remote_bytes([])
            if step % 2:
                states.append(step)
            return bool(step % 2)

        bus = Bus(some)
        _, said = ran(bus)
        # The last one says that the key is let go, and is answered by damping.
        self.assertEqual(len(bus.sent) - 5, len(states) - 2)
        self.assertIn("; 20 without a new state", said)


if __name__ == "__main__":
    unittest.main()
