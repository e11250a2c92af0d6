#!/usr/bin/env python3
"""Turns a page of `ampco play --html` into a recording for the Rerun viewer.

    python3 -m venv venv && venv/bin/pip install -r deploy/python/requirements-rerun.txt
    target/release/ampco play walk --html walk.html
    venv/bin/python deploy/python/to_rerun.py walk.html walk.rrd && venv/bin/rerun walk.rrd

The page holds the shapes and the poses of all bodies, so nothing about the robot is repeated here. In Python because
the viewer comes with the same package, and because Rerun's Rust crate would bring 500 crates into the build.
"""

import json
import re
import sys
from pathlib import Path

import numpy as np
import rerun as rr

DATA = re.compile(r'<script id="recording" type="application/json">(.*?)</script>', re.S)
TITLE = re.compile(r"<h1>(.*?)</h1>", re.S)
# Length of the arrow of a foot that carries 1 N, m.
METRES_PER_NEWTON = 0.001
TOUCH = 10.0


def read(path):
    """The page's data, positions in m and quaternions x y z w as arrays `[frame, body, …]`."""
    text = Path(path).read_text(encoding="utf-8")
    found = DATA.search(text)
    if not found:
        sys.exit(f"to_rerun: {path} is no page of `ampco play --html`")
    data = json.loads(found[1])
    bodies = len(data["bodies"])
    data["positions"] = np.array(data["positions"]).reshape(-1, bodies, 3) / data["resolution"]
    rotations = np.array(data["rotations"]).reshape(-1, bodies, 4) / data["resolution"]
    data["rotations"] = np.roll(rotations, -1, axis=2)
    for name in ("command", "velocity"):
        data[name] = np.array(data[name]).reshape(-1, 3)
    if data["forces"] is not None:
        data["forces"] = np.array(data["forces"]).reshape(-1, 2)
    data["title"] = TITLE.search(text)[1]
    return data


def upright(axis):
    """Quaternion x y z w that turns z onto a unit vector."""
    cross = np.cross([0.0, 0.0, 1.0], axis)
    quaternion = np.array([*cross, 1.0 + axis[2]])
    length = np.linalg.norm(quaternion)
    return quaternion / length if length > 1e-9 else np.array([1.0, 0.0, 0.0, 0.0])


def log_shapes(data):
    """Once: what each body looks like in its own frame."""
    for body, shapes in enumerate(data["bodies"]):
        for number, shape in enumerate(shapes):
            place = f"world/robot/{body}/shape_{number}"
            if "half" in shape:
                solid = rr.Boxes3D(centers=[shape["centre"]], half_sizes=[shape["half"]],
                                   fill_mode="solid", colors=[[200, 205, 212]])
            else:
                start, along = np.array(shape["from"]), np.subtract(shape["to"], shape["from"])
                length = np.linalg.norm(along)
                turn = upright(along / length) if length > 1e-9 else [0.0, 0.0, 0.0, 1.0]
                solid = rr.Capsules3D(lengths=[length], radii=[shape["radius"]], translations=[start],
                                      quaternions=[turn], fill_mode="solid", colors=[[200, 205, 212]])
            rr.log(place, solid, static=True)


def log_frame(data, frame):
    """One moment: poses, contacts, what was asked and done."""
    rr.set_time("time", duration=frame * data["frameSeconds"])
    for body in range(len(data["bodies"])):
        rr.log(f"world/robot/{body}", rr.Transform3D(
            translation=data["positions"][frame, body], quaternion=data["rotations"][frame, body]))
    for i, name in enumerate(("forward", "left", "yaw_rate")):
        rr.log(f"{name}/asked", rr.Scalars(data["command"][frame, i]))
        rr.log(f"{name}/done", rr.Scalars(data["velocity"][frame, i]))
    if data["forces"] is None:
        return
    for foot, body in enumerate(data["feet"]):
        force = data["forces"][frame, foot]
        rr.log(f"foot_force/{('left', 'right')[foot]}", rr.Scalars(force))
        arrow = [[0, 0, force * METRES_PER_NEWTON]] if force > TOUCH else []
        rr.log(f"world/contact/{foot}", rr.Arrows3D(
            vectors=arrow, origins=[data["positions"][frame, body]] * len(arrow), colors=[[220, 115, 50]]))


def main():
    if len(sys.argv) != 3:
        sys.exit("usage: to_rerun.py PAGE.html RECORDING.rrd")
    data = read(sys.argv[1])
    rr.init("ampco", recording_id=data["title"])
    rr.save(sys.argv[2])
    rr.log("world", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
    rr.log("world/ground", rr.Boxes3D(centers=[[0, 0, -0.005]], half_sizes=[[20, 20, 0.005]],
                                      fill_mode="solid", colors=[[222, 227, 232]]), static=True)
    log_shapes(data)
    for frame in range(data["count"]):
        log_frame(data, frame)


if __name__ == "__main__":
    main()
