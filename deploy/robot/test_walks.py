"""A policy walks over DDS: `AMPCO_EXPORT=DIR python -m unittest robot.test_walks` in deploy/.

The robot is a process of its own on this machine's loopback; what it says of itself is compared with what the controller
says. Time stands still until a command comes, so that a busy machine changes nothing.
"""

import json
import os
import re
import subprocess
import sys
import threading
import unittest
from pathlib import Path
from unittest import mock

from transfer.policy import Policy

from . import loop
from .bus import COMMANDS, Bus, Participant, newest
from .command import main, ranges
from .control import Controller
from .error import RobotError
from .messages import LowCmd
from .motors import Motors
from .observation import Observer
from .safety import Limits
from .wish import Remote

EXPORT = Path(os.environ.get("AMPCO_EXPORT", "policy"))
PROGRAM = Path(__file__).parent
# Two at once do not meet; ports are below those that systems give away.
DOMAIN = 10 + os.getpid() % 90
SECONDS = 5.0
# Each for one controller: what goes wrong, and when.
RUNS = {
    "walk": f"key@{SECONDS}", "checksum": "checksum@0.2+frozen@0.6", "tilt": "tilt@0.2", "heat": "heat@0.2",
    "silence": "silence@0.2", "rival": "rival@0.2",
}
# The robot's time goes by commands, 20 ms each: they may come faster than that.
PERIOD = 0.005
PATIENCE = 120.0  # s for all


def program(kind, *options):
    return [sys.executable, str(PROGRAM), kind, str(EXPORT), "--domain", str(DOMAIN), *options]


class OverDds(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        options = ("--lockstep", "--once", "--remote", "0.8,0,0", "--walk", "60", "--fault", ",".join(RUNS.values()))
        cls.robot = subprocess.Popen(program("stand-in", *options), stdout=subprocess.PIPE, text=True)
        cls.watchdog = threading.Timer(PATIENCE, cls.robot.kill)
        cls.watchdog.start()
        cls.robot.stdout.readline()
        cls.bus = Bus(DOMAIN, "lo", simulator=True)
        cls.heard = cls.bus._participant.reader(COMMANDS, LowCmd)

    @classmethod
    def tearDownClass(cls):
        cls.watchdog.cancel()
        cls.robot.kill()
        cls.robot.communicate()

    def controlled(self, silence):
        """Exit status and lines of a controller, and what the robot says afterwards."""
        policy = Policy(EXPORT)
        motors, allowed = Motors(policy.description, "policy.json"), ranges(policy.description, "policy.json")
        controller = Controller(policy, motors, Observer(policy, motors), allowed, 0.1)
        lines = []
        made = loop.Loop(self.bus, controller, motors, Remote(allowed), Limits(silence=silence), PERIOD, lines.append)
        code = made.run()
        while not (line := self.robot.stdout.readline()).startswith("{"):
            self.assertNotEqual(line, "", "the robot has ended")
        return code, "\n".join(lines), json.loads(line)

    # More damping than the robot waits for.
    @mock.patch.multiple(loop, LISTEN=0.1, DAMPED=60 * PERIOD)
    def test_it_walks_and_every_stop_ends_in_damping(self):
        for name in RUNS:
            with self.subTest(name):
                code, said, robot = self.controlled(0.3 if name in ("silence", "checksum") else 5.0)
                last = newest(self.heard)
                self.assertEqual([motor.kp for motor in last.motor_cmd], [0.0] * 35)
                self.assertEqual({motor.kd for motor in last.motor_cmd[:29]}, {3.0})
                self.assertEqual((last.mode_machine, robot["damped"], robot["ignored"]), (4, True, 0))
                self.assertIsNone(robot["fell"])
                getattr(self, f"after_{name}")(code, said, robot)

    def test_a_dry_run_says_everything_and_sends_nothing(self):
        done = subprocess.run(
            program("run", "--state-from-simulator", "--dry-run", "--stand-seconds", "0.1", "--max-silence", "5000"),
            capture_output=True, text=True, timeout=PATIENCE,
        )
        # The remote is let go as nothing moves.
        self.assertEqual((done.returncode, done.stderr), (0, ""), done.stdout)
        for words in ("policy: walk", "dry run", "standing up: command", "left_knee", "stop: the operator let go"):
            self.assertIn(words, done.stdout)
        self.assertIsNone(newest(self.heard))

    def test_a_network_that_is_not_there_is_named(self):
        for interface in ("nowhere0", '"/>'):
            with self.assertRaisesRegex(RobotError, re.escape(interface) + ".*--interface"):
                Participant(DOMAIN + 100, interface)

    def test_a_policy_that_a_robot_cannot_run_is_refused(self):
        with self.assertRaises(SystemExit) as ended:
            main(["run", str(EXPORT), "--domain", str(DOMAIN)])
        self.assertRegex(ended.exception.code, "policy.json: the policy sees height and linear_velocity, which no robot")

    def after_walk(self, code, said, robot):
        self.assertEqual(code, 0)
        self.assertIn("stop: the operator let go", said)
        self.assertAlmostEqual(robot["walked_seconds"], SECONDS, delta=0.1)
        # Told 0.4 and then 0.8 m/s, from standing: it has set off, and goes no faster.
        self.assertGreater(robot["distance_m"] / SECONDS, 0.15)
        self.assertLess(robot["distance_m"] / SECONDS, 0.95)

    def after_checksum(self, code, said, robot):
        # Whatever the damaged states say it walks on; then they are the only ones that are new.
        self.assertEqual(code, 1)
        self.assertAlmostEqual(robot["walked_seconds"], 0.6, delta=0.1)
        self.assertIn("stop: stale state: no new and intact rt/lowstate", said)
        self.assertRegex(said, r"; [1-9]\d+ states with a wrong checksum ignored")

    def stopped(self, code, said, robot, words):
        self.assertEqual(code, 1)
        self.assertRegex(said, words)
        self.assertAlmostEqual(robot["walked_seconds"], 0.2, delta=0.1)

    def after_tilt(self, *told):
        self.stopped(*told, "stop: tilt: 70°, limit 57°")

    def after_heat(self, *told):
        self.stopped(*told, "stop: temperature: left_knee at 120 °C")

    def after_silence(self, *told):
        self.stopped(*told, "stop: stale state: no new and intact rt/lowstate and rt/sportmodestate for 3..? ms")

    def after_rival(self, code, said, robot):
        self.stopped(code, said, robot, "stop: another program sends rt/lowcmd")


if __name__ == "__main__":
    unittest.main()
