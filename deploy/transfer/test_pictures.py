"""Tests of figures and films: `AMPCO_EXPORT=DIR python -m unittest transfer.test_pictures` in deploy/."""

import os
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import numpy as np
from PIL import Image, ImageSequence

from . import film
from .episodes import robot_of
from .model import load
from .pictures import figure, stress_figure
from .policy import Policy

EXPORT = Path(os.environ.get("AMPCO_EXPORT", "policy"))
ROW = {"command": [1.0, 0.0, 0.0], "velocity": [0.9, 0.0], "energy_per_step_j": 2.0, "survival": 1.0, "rmse": 0.2,
       "cost_of_transport": 0.3}


class Camera:
    """Draws the height of the pelvis as a shade of grey, needs no screen."""

    def __init__(self, robot, width, height):
        self.robot, self.size = robot, (height, width, 3)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass

    def picture(self, pose):
        return np.full(self.size, round(100 * pose[self.robot.base + 2]), dtype=np.uint8)


class Pictures(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def written(self):
        return sorted(path.name for path in self.folder.iterdir())

    def robot(self):
        policy = Policy(EXPORT)
        return robot_of(load(EXPORT / "g1.xml", policy)[0], policy, [0.8, 0.0, 0.0]), policy

    def test_figures_are_written_whole_in_the_format_of_their_name(self):
        figure(self.folder / "five.png", "a title", [("MuJoCo", "s", [ROW])])
        fell = ROW | {"survival": 0.0, "cost_of_transport": None}
        rows = [{"stress": "none"} | ROW, {"stress": "push=250"} | fell, {"stress": "none"} | ROW | {"command": [0, 0, 1]}]
        stress_figure(self.folder / "stress.SVG", "a title", rows)
        self.assertEqual(self.written(), ["five.png", "stress.SVG"])
        self.assertEqual((self.folder / "five.png").read_bytes()[:4], b"\x89PNG")
        self.assertIn("<svg", (self.folder / "stress.SVG").read_text())

    def test_a_strip_is_ten_images_side_by_side(self):
        with mock.patch.object(film, "Camera", Camera):
            said = film.strip(self.folder / "strip.png", *self.robot())
        self.assertEqual(self.written(), ["strip.png"])
        with Image.open(self.folder / "strip.png") as image:
            self.assertEqual(image.size, (2400, 400))
        self.assertRegex(said, r"^(one stride of \d\.\d\d s|fell after .*|no whole stride; its last second)$")

    def test_a_video_has_25_images_a_second_and_is_a_gif_without_an_encoder(self):
        with mock.patch.object(film, "Camera", Camera), mock.patch.object(film.shutil, "which", lambda _: None):
            path, said = film.video(self.folder / "walk.mp4", *self.robot(), 1.0)
        self.assertEqual((path.name, self.written()), ("walk.gif", ["walk.gif"]))
        self.assertEqual(said, "1.0 s, on its feet; there is no ffmpeg that writes MP4")
        with Image.open(path) as image:
            # Images that are alike are one: 26 of 40 ms together.
            shown = [frame.info["duration"] for frame in ImageSequence.Iterator(image)]
        self.assertEqual(sum(shown), 26 * 40)


if __name__ == "__main__":
    unittest.main()
