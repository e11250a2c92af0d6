#!/usr/bin/env python3
"""Runs an exported policy in MuJoCo: survival, velocity error, energy, beside the same figures from rapier.

    python3 -m venv venv && venv/bin/pip install -r deploy/transfer/requirements.txt
    target/release/ampco export walk --out walk-policy
    venv/bin/python deploy/sim2sim.py walk-policy --run walk --figure figure5.png

MuJoCo steps at 200 Hz, the policy at 50 Hz, as in training. Figures are defined as in `ampco evaluate`.
"""

import argparse
import json
import os
import subprocess
import sys
import time
from pathlib import Path

from transfer import pictures

SPEEDS = [0.5, 1.0, 1.5, 2.0]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("policy", help="folder that `ampco export` wrote")
    parser.add_argument("--speed", type=float, action="append", help="forward command, m/s; may be repeated "
                        "(default: 0.5, 1.0, 1.5, 2.0)")
    parser.add_argument("--episodes", type=int, default=32, help="episodes per command (default: 32)")
    parser.add_argument("--seconds", type=float, default=20.0, help="length of an episode (default: 20)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--run", help="also evaluate this run, folder or checkpoint in rapier, with `ampco evaluate`")
    parser.add_argument("--ampco", default="target/release/ampco", help="the program (default: target/release/ampco)")
    parser.add_argument("--json", metavar="FILE", help="write all figures")
    parser.add_argument("--figure", metavar="FILE", help="draw Figure 5, as PNG or SVG by the name")
    parser.add_argument("--strip", metavar="FILE", help="draw a strip of images at the first speed, as PNG")
    parser.add_argument("--view", action="store_true", help="open MuJoCo's viewer at the first speed; no figures")
    given = parser.parse_args()
    if given.episodes < 1 or not given.seconds > 0:
        parser.error("--episodes and --seconds must be above zero")
    return given


def in_rapier(given, speeds, randomize):
    """The same figures by `ampco evaluate`."""
    from transfer.episodes import figures

    command = [given.ampco, "evaluate", given.run, "--json", "--episodes", str(given.episodes),
               "--seconds", str(given.seconds), "--seed", str(given.seed)]
    command += [word for speed in speeds for word in ("--command", f"{speed},0,0")]
    command += ["--randomize"] if randomize else []
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"sim2sim: {' '.join(command)}: {done.stderr.strip()}")
    return [figures(row["command"], row) for row in json.loads(done.stdout)]


def table(label, rows):
    print(f"\n{label}\n  asked  survival    rmse   norm.err   energy   velocity")
    print("    m/s         %     m/s          %   J/step        m/s")
    for row in rows:
        error = row["normalized_error"]
        error = "-" if error is None else f"{100 * error:.1f}"
        print(f"  {row['command'][0]:5.2f}  {100 * row['survival']:8.1f}  {row['seconds_survived']:7.2f}  {row['rmse']:6.3f}  {error:>9}"
              f"  {row['energy_per_step_j']:7.2f}  {row['velocity'][0]:9.2f}", flush=True)


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
    speeds = given.speed or SPEEDS

    def asked(speed):
        robot = Robot(model, policy)
        robot.command[0] = speed
        return robot

    if given.view:
        view(model, policy, asked(speeds[0]))
        return
    print(f"{policy.title()}: {given.episodes} episodes of {given.seconds:g} s per command, "
          f"MuJoCo {mujoco.__version__}", flush=True)
    result = {"origin": policy.description["origin"], "mujoco_version": mujoco.__version__,
              "episodes": given.episodes, "seconds": given.seconds, "seed": given.seed}
    series = []
    for randomize, suffix in ((False, ""), (True, "_randomized")):
        words = "Table I" if randomize else "nominal"
        rows = [walk(model, policy, [speed, 0.0, 0.0], given.episodes, given.seconds, randomize, given.seed)
                for speed in speeds]
        result[f"mujoco{suffix}"] = rows
        series.append((f"MuJoCo, {words}", "s" if randomize else "o", rows))
        table(f"MuJoCo, {words}", rows)
        if given.run:
            rows = in_rapier(given, speeds, randomize)
            result[f"rapier{suffix}"] = rows
            series.append((f"rapier, {words}", "D" if randomize else "^", rows))
            table(f"rapier, {words}", rows)
    if given.json:
        replace(given.json, json.dumps(result, indent=1) + "\n")
    if given.figure:
        pictures.figure(given.figure, policy.title(), series)
    if given.strip:
        fell_at = pictures.strip(given.strip, asked(speeds[0]), policy, min(given.seconds, 4.0), 9)
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
