"""Tests of what `sim2sim.py` prints and takes: `python -m unittest transfer.test_table` in deploy/. Needs no export."""

import re
import subprocess
import sys
import unittest
from pathlib import Path

from .table import COLUMNS, LEGEND, table

ROW = {
    "command": [0.5, 0.0, -0.8], "survival": 0.75, "seconds_survived": 17.25, "rmse": 0.1234, "rmse_yaw_rate": 0.25,
    "normalized_error": 0.125, "energy_per_step_j": 2.5, "velocity": [0.45, -0.001], "yaw_rate": -0.7,
    "rmse_settled": 0.1, "off": 0.05, "cost_of_transport": 0.271, "stride_rate_hz": 1.25, "duty_factor": 0.625,
    "double_support": 0.25, "flight_share": 0.0, "foot_clearance": 0.025, "slip_per_stride": 0.012,
    "arm_swing_deg": 30.0, "trunk_lean_deg": 2.5, "torque_saturated_share": 0.1,
    "sole_force_peak_weights": 1.75, "action_rate": 0.107,
    "saturated_joint": "left_knee_joint", "saturated_shares": {"left_knee_joint": 0.075, "right_knee_joint": 0.05},
}
SCRIPT = Path(__file__).parents[1] / "sim2sim.py"


def ends(line):
    """Where words end that two spaces or the end of the line follow."""
    return [i + 1 for i in range(len(line)) if line[i] != " " and line[i + 1 : i + 3] in ("", "  ")]


class Table(unittest.TestCase):
    def test_every_number_stands_under_its_heading_and_unit(self):
        turn = ROW | {"command": [0.0, 0.0, 1.0], "normalized_error": None, "survival": 1.0}
        label, names, units, *lines = table("MuJoCo, nominal", [ROW, turn]).split("\n")
        self.assertEqual(label, "MuJoCo, nominal")
        self.assertEqual(len(lines), 2)
        for line in (units, *lines):
            self.assertEqual(len(line), len(names))
            # The three numbers of a velocity are one column: single spaces, or two before a number without a sign.
            self.assertEqual(set(ends(names)) - set(ends(line)), set(), line)
        words = "asked survival upright rmse settled off yaw norm.err energy transport stride duty double flight clear "
        words += "slip arms lean saturated worst joint sole rate mean velocity"
        self.assertEqual(names.split(), words.split())
        numbers = "0.50 0.00 -0.80 75.0 17.25 0.123 0.100 0.050 0.250 12.5 2.50 0.27 1.25 0.62 25.0 0.0 2.5 1.2 "
        numbers += "30.0 2.5 10.0 left_knee 7.5 1.75 0.107 0.45 0.00 -0.70"
        self.assertEqual(lines[0].split(), numbers.split())
        self.assertEqual(lines[1].split()[9], "-")

    def test_what_is_not_measured_is_a_dash_and_a_stress_has_a_column(self):
        kept = ("command", "velocity", "yaw_rate", "survival", "seconds_survived")
        rapier = {name: value for name, value in ROW.items() if name in kept}
        cells = table("rapier", [rapier]).split("\n")[3].split()
        self.assertEqual(cells, "0.50 0.00 -0.80 75.0 17.25".split() + ["-"] * 19 + "0.45 0.00 -0.70".split())
        _, names, units, line = table("", [ROW | {"stress": "gains=0.8+payload=4"}]).split("\n")
        self.assertEqual((names.split()[0], units.split()[0], line.split()[0]), ("stress", "-", "gains=0.8+payload=4"))

    def test_every_column_is_explained(self):
        for name, _, _ in COLUMNS:
            if name not in ("asked", "mean velocity"):
                self.assertRegex(LEGEND, rf"(\W|^){re.escape(name)}[: ]")

    def test_there_is_a_heading_and_a_unit_for_every_number(self):
        self.assertTrue(all(name and unit for name, unit, _ in COLUMNS))
        self.assertEqual(len({name for name, _, _ in COLUMNS}), len(COLUMNS))


class Arguments(unittest.TestCase):
    def refused(self, *options):
        done = subprocess.run([sys.executable, SCRIPT, "nowhere", *options], capture_output=True, text=True)
        self.assertEqual(done.returncode, 2, done.stderr)
        return done.stderr

    def test_a_command_is_three_finite_numbers(self):
        for command in ("0.5", "0.5,0", "0.5,0,0,0", "a,b,c", "inf,0,0", "nan,0,0"):
            self.assertIn("three numbers", self.refused("--command", command))
        self.assertIn("--speed", self.refused("--speed", "nan"))
        self.assertIn("--seconds", self.refused("--seconds", "0.01"))
        self.assertIn("--seed", self.refused("--seed", "-1"))

    def test_a_file_that_cannot_be_written_is_refused_before_anything_runs(self):
        self.assertIn("make it", self.refused("--json", "nowhere/at/all.json"))
        self.assertIn("is a folder", self.refused("--json", "."))
        self.assertIn("ends in .png", self.refused("--strip", "strip.jpg"))
        self.assertIn("ends in .mp4 or .gif", self.refused("--video", "walk"))
        self.assertIn("ends in .png or .svg", self.refused("--figure", "figure"))

    def test_stresses_are_explained_and_mistaken_ones_refused(self):
        for options in (["--stress", "help"], ["nowhere", "--stress", "help"]):
            done = subprocess.run([sys.executable, SCRIPT, *options], capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertIn("payload", done.stdout)
        self.assertIn("'dealy' is no stress; there are delay", self.refused("--stress", "dealy"))
        done = subprocess.run([sys.executable, SCRIPT], capture_output=True, text=True)
        self.assertIn("ampco export RUN", done.stderr)


if __name__ == "__main__":
    unittest.main()
