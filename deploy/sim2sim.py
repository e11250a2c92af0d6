#!/usr/bin/env python3
"""Runs an exported policy in MuJoCo: survival, velocity error, energy, beside the same figures from rapier.

    python3 -m venv venv && venv/bin/pip install -r deploy/transfer/requirements.txt
    target/release/ampco export walk --out walk-policy
    venv/bin/python deploy/sim2sim.py walk-policy --run walk --figure figure5.png

MuJoCo steps at 200 Hz, the policy at 50 Hz, as in training. Figures are defined as in `ampco evaluate`.
"""

import argparse
import json
import math
import os
import subprocess
import sys
import time
from pathlib import Path

from transfer import pictures
from transfer.table import table

SPEEDS = [0.5, 1.0, 1.5, 2.0]


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


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("policy", help="folder that `ampco export` wrote")
    parser.add_argument("--speed", type=speed, action="append", dest="commands", metavar="VX",
                        help="forward command, m/s; may be repeated (default: 0.5, 1.0, 1.5, 2.0)")
    parser.add_argument("--command", type=command, action="append", dest="commands", metavar="VX,VY,WZ",
                        help="forward and leftward velocity, m/s, and yaw rate, rad/s; may be repeated, beside --speed "
                        "too; one that begins with a minus as in --command=-0.5,0,0")
    parser.add_argument("--episodes", type=int, default=32, help="episodes per command (default: 32)")
    parser.add_argument("--seconds", type=float, default=20.0, help="length of an episode (default: 20)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--run", help="also evaluate this run, folder or checkpoint in rapier, with `ampco evaluate`")
    parser.add_argument("--ampco", default="target/release/ampco", help="the program (default: target/release/ampco)")
    parser.add_argument("--json", metavar="FILE", help="write all figures")
    parser.add_argument("--figure", metavar="FILE", help="draw Figure 5, as PNG or SVG by the name")
    parser.add_argument("--strip", metavar="FILE", help="draw a strip of images at the first command, as PNG")
    parser.add_argument("--view", action="store_true", help="open MuJoCo's viewer at the first command; no figures")
    given = parser.parse_args()
    if given.episodes < 1:
        parser.error(f"--episodes {given.episodes}: give at least 1")
    if not 0.02 <= given.seconds <= 3600:
        parser.error(f"--seconds {given.seconds}: give 0.02 to 3600")
    given.commands = given.commands or [speed(number) for number in SPEEDS]
    return given


def in_rapier(given, randomize):
    """The same figures by `ampco evaluate`."""
    from transfer.episodes import figures

    call = [given.ampco, "evaluate", given.run, "--json", "--episodes", str(given.episodes),
               "--seconds", str(given.seconds), "--seed", str(given.seed)]
    call += [word for numbers in given.commands for word in ("--command", ",".join(map(str, numbers)))]
    call += ["--randomize"] if randomize else []
    done = subprocess.run(call, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"sim2sim: {' '.join(call)}: {done.stderr.strip()}")
    return [figures(row["command"], row) for row in json.loads(done.stdout)]


def view(model, policy, robot):
    """Lets the robot walk in MuJoCo's window, in real time, until it is closed; it stands up again after a fall."""
    import mujoco.viewer
    import numpy as np

    period = 1 / policy.description["control"]["policy_hz"]
    with mujoco.viewer.launch_passive(model, robot.data) as window:
        while window.is_running():
            began = time.monotonic()
            robot.step(policy.actions([robot.observe()])[0])
            if robot.has_fallen(policy.description["task"]):
                robot.stand()
                robot.previous_action = np.zeros(robot.joints)
            window.sync()
            time.sleep(max(0.0, period - (time.monotonic() - began)))


def main():
    given = arguments()
    pictures.prepare_rendering()
    import mujoco

    from transfer.episodes import walk
    from transfer.policy import ExportError, Policy
    from transfer.robot import Robot

    try:
        policy = Policy(given.policy)
    except ExportError as problem:
        sys.exit(f"sim2sim: {problem}")
    model = mujoco.MjModel.from_xml_path(str(Path(given.policy) / "g1.xml"))

    def first():
        robot = Robot(model, policy)
        robot.command[:] = given.commands[0]
        return robot

    if given.view:
        view(model, policy, first())
        return
    print(f"{policy.title()}: {given.episodes} episodes of {given.seconds:g} s per command, "
          f"MuJoCo {mujoco.__version__}", flush=True)
    result = {"origin": policy.description["origin"], "mujoco_version": mujoco.__version__,
              "episodes": given.episodes, "seconds": given.seconds, "seed": given.seed}
    series = []
    for randomize, suffix in ((False, ""), (True, "_randomized")):
        words = "Table I" if randomize else "nominal"
        rows = [walk(model, policy, numbers, given.episodes, given.seconds, randomize, given.seed)
                for numbers in given.commands]
        result[f"mujoco{suffix}"] = rows
        series.append((f"MuJoCo, {words}", "s" if randomize else "o", rows))
        print("\n" + table(f"MuJoCo, {words}", rows), flush=True)
        if given.run:
            rows = in_rapier(given, randomize)
            result[f"rapier{suffix}"] = rows
            series.append((f"rapier, {words}", "D" if randomize else "^", rows))
            print("\n" + table(f"rapier, {words}", rows), flush=True)
    if given.json:
        replace(given.json, json.dumps(result, indent=1) + "\n")
    if given.figure:
        pictures.figure(given.figure, policy.title(), series)
    if given.strip:
        fell_at = pictures.strip(given.strip, first(), policy, min(given.seconds, 4.0), 9)
        print(f"\n{given.strip}: " + (f"fell after {fell_at:.2f} s" if fell_at is not None else "on its feet"))


def replace(path, text):
    """Written beside and renamed, so that a reader never meets half a file."""
    draft = f"{path}.{os.getpid()}.new"
    with open(draft, "w", encoding="utf-8") as file:
        file.write(text)
        file.flush()
        os.fsync(file.fileno())
    os.replace(draft, path)


if __name__ == "__main__":
    main()
