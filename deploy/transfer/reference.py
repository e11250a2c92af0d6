"""States, observations and a flight in MuJoCo that rapier is compared with.

`python -m transfer.reference EXPORT FILE` (in `deploy/`) writes `actor/sim/tests/mujoco.json`, which a test of
`sim` reads: both simulators start from the same states, see the same, and move alike in the air. EXPORT is one with
`--self-collision off`, for contacts of two engines are two models.
"""

import json
import sys

import mujoco
import numpy as np

from .policy import Policy
from .robot import FREE, Robot

FLIGHT_SECONDS = 0.2


def states(joints):
    """Standing, and turning and moving with every joint off its default. Numbers that f32 holds exactly."""
    standing = {
        "position": [0.0, 0.0, 2.5], "orientation": [1.0, 0.0, 0.0, 0.0], "linear_velocity": [0.0, 0.0, 0.0],
        "angular_velocity": [0.0, 0.0, 0.0], "joint_positions": joints, "joint_velocities": [0.0] * len(joints),
    }
    moving = {
        "position": [0.0, 0.0, 3.0], "orientation": [0.5, 0.5, 0.5, 0.5], "linear_velocity": [0.5, -0.25, 1.0],
        "angular_velocity": [1.0, -0.5, 0.75],
        "joint_positions": [round((q + 0.125 * (-1) ** i) * 1024) / 1024 for i, q in enumerate(joints)],
        "joint_velocities": [0.25 * (i % 5 - 2) for i in range(len(joints))],
    }
    return [standing, moving]


def targets(default, step):
    """Open loop: a different slow swing of every joint, rad."""
    return np.array([q + 0.3 * np.sin(0.4 * step + i) for i, q in enumerate(default)])


def flight(robot, state):
    """Observation at the start, then targets and joint positions per control step."""
    robot.set_state(state)
    robot.command = np.array([0.5, -0.25, 0.125])
    robot.previous_action = np.arange(robot.joints) / 16 * 0
    seen = robot.observe()
    rows = []
    for step in range(round(FLIGHT_SECONDS * 50)):
        target = targets(robot.default, step)
        work = robot.track(target)
        rows.append({
            "targets": target.tolist(), "joint_positions": robot.data.qpos[FREE:].tolist(),
            "position": robot.data.qpos[:3].tolist(), "work": work,
        })
    return {"state": state, "command": robot.command.tolist(), "observation": seen.tolist(), "steps": rows}


def build(model, policy):
    """The whole file."""
    robot = Robot(model, policy)
    return {
        "mujoco": mujoco.__version__,
        "mass": float(model.body_mass.sum()),
        "flights": [flight(robot, state) for state in states(policy.joint("default_position").tolist())],
    }


if __name__ == "__main__":
    export, out = sys.argv[1:]
    built = build(mujoco.MjModel.from_xml_path(f"{export}/g1.xml"), Policy(export))
    with open(out, "w", encoding="utf-8") as file:
        json.dump(built, file)
        file.write("\n")
