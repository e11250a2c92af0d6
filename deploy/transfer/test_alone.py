"""A policy that walks forward goes by its ONNX file alone."""

import os
import unittest
from pathlib import Path

from .alone import walk

EXPORT = Path(os.environ.get("AMPCO_EXPORT", "policy"))


class Alone(unittest.TestCase):
    def test_what_the_metadata_says_is_enough_to_walk(self):
        seconds, speed = walk(str(EXPORT / "policy.onnx"), str(EXPORT / "g1.xml"), [0.6, 0.0, 0.0])
        self.assertAlmostEqual(seconds, 10.0, places=3)
        self.assertAlmostEqual(speed, 0.6, delta=0.15)
