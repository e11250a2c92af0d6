#!/usr/bin/env python3
"""Runs an exported policy in MuJoCo, on any MJCF of the robot: how well it walks, and what stresses do to it.

    python3 -m venv venv && venv/bin/pip install -r deploy/transfer/requirements.txt
    target/release/ampco export walk --out walk-policy
    venv/bin/python deploy/sim2sim.py walk-policy --run walk --figure figure5.png

The policy acts at 50 Hz, as in training; MuJoCo steps as the model says, the export's own at 200 Hz. Figures are
defined as in `ampco evaluate`.
"""

import json
import os
import subprocess
import sys
from pathlib import Path

from transfer import film, pictures, rows
from transfer.error import ExportError
from transfer.options import arguments
from transfer.table import table


def in_rapier(given, randomize):
    """The same figures by `ampco evaluate`, a row for each command and stress."""
    from transfer.episodes import figures

    call = [given.ampco, "evaluate", given.run, "--json", "--episodes", str(given.episodes),
            "--seconds", str(given.seconds), "--seed", str(given.seed)]
    call += [word for numbers in given.commands for word in ("--command", ",".join(map(str, numbers)))]
    call += ["--randomize"] if randomize else []
    # Without a row that is stressed there is nothing to ask for: the one without stress is what it does anyway.
    call += ["--stress", text] if given.stress and (text := rows.text(given.stress)) else []
    try:
        done = subprocess.run(call, capture_output=True, text=True)
    except OSError as problem:
        sys.exit(f"sim2sim: {given.ampco}: {problem.strerror}: build it, or say where it is by --ampco")
    if done.returncode != 0:
        sys.exit(f"sim2sim: {' '.join(call)}: {done.stderr.strip()}")
    return [figures(row["command"], row) for row in json.loads(done.stdout)]


def compared(given, policy, model, result):
    """Without and with Table I, in MuJoCo and by `--run` in rapier; gives series for the figure."""
    from transfer.episodes import walk

    series = []
    for randomize, suffix in ((False, ""), (True, "_randomized")):
        words = "Table I" if randomize else "nominal"
        found = [walk(model, policy, numbers, given.episodes, given.seconds, randomize, given.seed)
                 for numbers in given.commands]
        result[f"mujoco{suffix}"] = found
        series.append((f"MuJoCo, {words}", "s" if randomize else "o", found))
        print("\n" + table(f"MuJoCo, {words}", found), flush=True)
        if given.run:
            found = in_rapier(given, randomize)
            result[f"rapier{suffix}"] = found
            series.append((f"rapier, {words}", "D" if randomize else "^", found))
            print("\n" + table(f"rapier, {words}", found), flush=True)
    return series


def stressed(given, policy, path, result):
    """A row for each stress and command; gives them all."""
    from transfer import model, stress
    from transfer.episodes import walk

    found = []
    for numbers in given.commands:
        own = []
        for label, stresses in given.stress:
            if sys.stderr.isatty():
                print(f"\r\033[K{label} …", end="", file=sys.stderr, flush=True)
            # Bumps are a part of the model.
            made, _ = model.load(path, policy, stress.height_of_bumps(stresses))
            row = walk(made, policy, numbers, given.episodes, given.seconds, False, given.seed, stresses)
            own.append({"stress": label, "stresses": dict(stresses)} | row)
        if sys.stderr.isatty():
            print("\r\033[K", end="", file=sys.stderr, flush=True)
        print("\n" + table("MuJoCo, stressed", own), flush=True)
        found += own
    result["stress"] = found
    if given.run:
        asked = [(label, dict(stresses)) for _ in given.commands for label, stresses in given.stress]
        result["rapier_stress"] = [
            row | {"stress": label, "stresses": stresses}
            for (label, stresses), row in zip(asked, in_rapier(given, False), strict=True)
        ]
        print("\n" + table("rapier, stressed", result["rapier_stress"]), flush=True)
    return found


def main():
    given = arguments(__doc__)
    if given.stress == "help":
        print(rows.explained())
        return
    film.prepare_rendering()
    try:
        judge(given)
    except ExportError as problem:
        sys.exit(f"sim2sim: {problem}")
    except OSError as problem:
        sys.exit(f"sim2sim: {problem.filename}: {problem.strerror}: give a file that can be written")
    except KeyboardInterrupt:
        sys.exit(130)


def judge(given):
    """Everything that is asked for, once the options make sense."""
    import mujoco

    from transfer.episodes import robot_of
    from transfer.model import load
    from transfer.policy import Policy
    from transfer.stress import height_of_bumps
    from transfer.view import view

    policy = Policy(given.policy)
    path = Path(given.model or Path(given.policy) / "g1.xml")
    # What a robot cannot stand on or tell is found out before episodes begin.
    load(path, policy, max(height_of_bumps(stresses) for _, stresses in given.stress or [("", [])]))
    model, notes = load(path, policy)
    robot_of(model, policy, given.commands[0]).observe()
    for note in notes if given.model else []:
        print(note, flush=True)

    def first():
        """As the last row of stresses is, if there are any."""
        stresses = given.stress[-1][1] if given.stress else []
        own, _ = load(path, policy, height_of_bumps(stresses))
        return robot_of(own, policy, given.commands[0], stresses, given.seed)

    if given.view:
        view(policy, first())
        return
    where = f"{path}, " if given.model else ""
    print(f"{policy.title()}: {given.episodes} episodes of {given.seconds:g} s per command, {where}"
          f"{1 / model.opt.timestep:g} Hz, MuJoCo {mujoco.__version__}", flush=True)
    result = {"origin": policy.description["origin"], "mujoco_version": mujoco.__version__, "model": str(path),
              "episodes": given.episodes, "seconds": given.seconds, "seed": given.seed}
    if given.stress:
        seen = [term["name"] for term in policy.terms()]
        for remark in rows.remarks(given.stress, seen, model.opt.timestep, given.seconds):
            print(remark, flush=True)
        found = stressed(given, policy, path, result)
    else:
        series = compared(given, policy, model, result)
    if given.json:
        replace(given.json, json.dumps(result, indent=1) + "\n")
    if given.figure and given.stress:
        pictures.stress_figure(given.figure, policy.title(), found)
    elif given.figure:
        pictures.figure(given.figure, policy.title(), series)
    if given.strip:
        print(f"\n{given.strip}: {film.strip(given.strip, first(), policy)}")
    if given.video:
        print("\n{}: {}".format(*film.video(given.video, first(), policy, given.seconds)))


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
