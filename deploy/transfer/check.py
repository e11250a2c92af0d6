"""Whether a policy can drive a compiled model, and what is odd about it."""

import mujoco
import numpy as np

from .error import ExportError
from .feet import ANKLES, LEVEL, Feet

WALL = 0.1  # A plane this steep (cosine) is no floor.


def check(model, policy, names, notes):
    """Refuses what cannot work; says what may be meant. `names` are the policy's joints as the model has them."""
    _timestep(model, policy)
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    _floor(model, data)
    joints = [model.joint(name) for name in names]
    for joint, said in zip(joints, policy.description["joints"], strict=True):
        _joint(model, joint, said, notes)
    by_name = {said["name"]: joint for said, joint in zip(policy.description["joints"], joints, strict=True)}
    Feet(model, data, [model.jnt_bodyid[by_name[name].id] for name in ANKLES])


def _timestep(model, policy):
    period = 1 / policy.description["control"]["policy_hz"]
    steps = period / model.opt.timestep
    if round(steps) < 1 or abs(steps - round(steps)) > 1e-6:
        raise ExportError(
            f"its timestep of {model.opt.timestep:g} s does not divide the policy's period of {period:g} s: "
            'set <option timestep="0.002"/>'
        )


def _floor(model, data):
    """Heights are told above a level floor."""
    still = model.body_weldid[model.geom_bodyid] == 0
    planes = still & (model.geom_type == mujoco.mjtGeom.mjGEOM_PLANE)
    upright = data.geom_xmat[planes, 8]
    aslant = upright[(upright > WALL) & (upright <= LEVEL)]
    if aslant.size > 0:
        degrees = np.degrees(np.arccos(aslant[0]))
        raise ExportError(f"its floor is tilted by {degrees:.1f}°: level it, and ask for --stress slope={degrees:.1f}")


def _joint(model, joint, said, notes):
    least, most = joint.range
    pose = said["default_position"]
    if model.jnt_limited[joint.id] and not least <= pose <= most:
        raise ExportError(
            f"joint {joint.name} goes from {least:.4g} to {most:.4g} rad and the policy stands at {pose:g} rad: "
            "give ranges in the unit of <compiler angle=\"…\"/>"
        )
    zero = model.qpos0[joint.qposadr[0]]
    if zero != 0:
        notes.append(f"joint {joint.name} has ref {zero:g} rad: the policy's angles count from there too")
