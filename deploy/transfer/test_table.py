"""Tests of what `sim2sim.py` prints and takes: `python -m unittest transfer.test_table` in deploy/. Needs no export."""

import subprocess
import sys
import unittest
from pathlib import Path

from .table import COLUMNS, table

ROW = {
    "command": [0.5, 0.0, -0.8], "survival": 0.75, "seconds_survived": 17.25, "rmse": 0.1234, "rmse_yaw_rate": 0.25,
    "normalized_error": 0.125, "energy_per_step_j": 2.5, "velocity": [0.45, -0.001], "yaw_rate": -0.7,
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
        cells = names.split(), lines[0].split()
        self.assertEqual(cells[0], "asked survival upright rmse yaw norm.err energy mean velocity".split())
        self.assertEqual(cells[1], "0.50 0.00 -0.80 75.0 17.25 0.123 0.250 12.5 2.50 0.45 0.00 -0.70".split())
        self.assertEqual(lines[1].split()[7], "-")

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


if __name__ == "__main__":
    unittest.main()
