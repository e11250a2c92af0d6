"""What `sim2sim.py` can be told, and whether it makes sense."""

import argparse
import math
import os
from pathlib import Path

from . import rows
from .pictures import FORMATS
from .table import LEGEND

SPEEDS = [0.5, 1.0, 1.5, 2.0]
EXAMPLES = """\
examples:
  deploy/sim2sim.py walk-policy --run walk --figure figure5.png    MuJoCo beside rapier, without and with Table I
  deploy/sim2sim.py walk-policy --model unitree_g1.xml --speed 1   on another MJCF of the robot
  deploy/sim2sim.py walk-policy --speed 1 --stress standard        what each stress does, then all at half strength
  deploy/sim2sim.py walk-policy --stress push=300,gains=0.8+payload=6 --json figures.json
  deploy/sim2sim.py walk-policy --speed 0.8 --strip strip.png --video walk.gif
  deploy/sim2sim.py walk-policy --view                             MuJoCo's window, the command on the keyboard

A model may be any MJCF whose joints have the robot's names, with or without `_joint`. Its bodies, contacts, floor, dry
friction and timestep stay; its actuators are replaced by the motors that policy.json describes; a floor and a light
are added if there is none. What is changed is said."""


def speed(text):
    """A forward command."""
    number = float(text)
    if not math.isfinite(number):
        raise ValueError
    return [number, 0.0, 0.0]


def command(text):
    """Forward and leftward velocity, m/s, and yaw rate, rad/s."""
    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError:
        numbers = []
    if len(numbers) != 3 or not all(map(math.isfinite, numbers)):
        raise argparse.ArgumentTypeError(f"{text!r}: give three numbers, as in 0.5,0,0.5")
    return numbers


def stresses(text):
    """Rows of stresses."""
    if text == "help":
        return text
    try:
        return rows.rows(text)
    except rows.StressError as problem:
        raise argparse.ArgumentTypeError(str(problem)) from None


def file(*endings):
    """A file to be written: its folder is there, and its ending is known."""

    def checked(text):
        path = Path(text)
        if endings and path.suffix.lower() not in endings:
            raise argparse.ArgumentTypeError(f"{text!r}: give a name that ends in {' or '.join(endings)}")
        if not path.parent.is_dir():
            raise argparse.ArgumentTypeError(f"{text!r}: folder {path.parent} is not there: make it")
        if not os.access(path.parent, os.W_OK):
            raise argparse.ArgumentTypeError(f"{text!r}: nothing can be written in {path.parent}: give another folder")
        if path.is_dir():
            raise argparse.ArgumentTypeError(f"{text!r} is a folder: give a file")
        return text

    return checked


def parser(about):
    """All options."""
    made = argparse.ArgumentParser(
        description=about, epilog=f"{EXAMPLES}\n\n{LEGEND}", formatter_class=argparse.RawDescriptionHelpFormatter
    )
    add = made.add_argument
    add("policy", nargs="?", help="folder that `ampco export` wrote")
    add("--model", metavar="FILE", help="MJCF of the robot (default: g1.xml of the export)")
    add("--speed", type=speed, action="append", dest="commands", metavar="VX",
        help="forward command, m/s; may be repeated (default: 0.5, 1.0, 1.5, 2.0)")
    add("--command", type=command, action="append", dest="commands", metavar="VX,VY,WZ",
        help="forward and leftward velocity, m/s, and yaw rate, rad/s; may be repeated, beside --speed too; one that "
        "begins with a minus as in --command=-0.5,0,0")
    add("--stress", type=stresses, metavar="LIST", help="rows of stresses instead of Table I, as in delay=20,push or "
        "standard; `--stress help` lists them")
    add("--episodes", type=int, default=32, help="episodes per command (default: 32)")
    add("--seconds", type=float, default=20.0, help="length of an episode (default: 20)")
    add("--seed", type=int, default=1, help="of starts, Table I and stresses: the same seed, the same figures")
    add("--run", help="also evaluate this run, folder or checkpoint in rapier, with `ampco evaluate`, under the same stresses")
    add("--ampco", default="target/release/ampco", help="the program (default: target/release/ampco)")
    add("--json", metavar="FILE", type=file(), help="write all figures")
    add("--figure", metavar="FILE", type=file(*FORMATS), help="draw Figure 5, or what stresses do, as PNG, SVG or PDF")
    add("--strip", metavar="FILE", type=file(".png"),
        help="draw ten images of a stride at the first command and under the last stress, as PNG")
    add("--video", metavar="FILE", type=file(".mp4", ".gif"),
        help="film an episode of the same, 20 s at most; .mp4 needs ffmpeg, without it a .gif is written")
    add("--view", action="store_true",
        help="open MuJoCo's window on the same, the command on the keyboard (arrows, Q, E, space); no figures")
    return made


def arguments(about):
    """What is given, checked."""
    made = parser(about)
    given = made.parse_args()
    if given.stress == "help":
        return given
    if given.policy is None:
        made.error("give the folder that `ampco export RUN --out FOLDER` wrote")
    if given.episodes < 1:
        made.error(f"--episodes {given.episodes}: give at least 1")
    if not 0.02 <= given.seconds <= 3600:
        made.error(f"--seconds {given.seconds}: give 0.02 to 3600")
    if given.seed < 0:
        made.error(f"--seed {given.seed}: give 0 or more")
    given.commands = given.commands or [speed(number) for number in SPEEDS]
    return given
