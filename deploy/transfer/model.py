"""Any MJCF of the robot made into one that a policy can drive: its joints found by name, motors as policy.json says.

What the file says of bodies, contacts, dry friction, floor, timestep and integrator stays. What it lacks is added, what
the policy cannot use is taken out, and `load` says both.
"""

import sys
from pathlib import Path

import mujoco
import numpy as np

from .check import check
from .error import ExportError
from .stress import BUMPS, BUMPS_GRID

SUFFIX = "_joint"
# Half the width of the height field, m.
BUMPS_REACH = 50.0
# Numbers of an error that are named; the rest is counted.
NAMED = 3


def load(path, policy, bumps=0.0):
    """The model, and what was changed in it as sentences. With a height field of `bumps` m, flat yet."""
    if not hasattr(mujoco.MjSpec, "delete"):
        raise ExportError(f"MuJoCo {mujoco.__version__} is too old: pip install -r deploy/transfer/requirements.txt")
    path = Path(path)
    if not path.is_file():
        raise ExportError(f"{path} is not a file: give the MJCF of the robot (`ampco export --mjcf` writes one)")
    try:
        spec = mujoco.MjSpec.from_file(str(path))
    except Exception as problem:
        raise ExportError(f"{path} cannot be read as MJCF ({_line(problem)}): mend the file") from None
    mujoco.set_mju_user_warning(_tell)
    notes = []
    joints = _joints(spec, path, policy, notes)
    root = _root(joints[0], path)
    names = [joint.name for joint in joints]
    if bumps > 0 and not _has_plane(spec) and _has_floor(spec):
        raise ExportError(f"{path}: bumps lie on a plane, and its floor is none: put a geom of type=\"plane\" into it")
    # A state that is no number has to be seen, and not to begin anew.
    spec.option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_AUTORESET)
    try:
        _hold_others(spec, root, joints, notes)
        _motors(spec, joints, policy, notes)
        _surroundings(spec, notes)
        if bumps > 0:
            _lay_bumps(spec, bumps)
        model = spec.compile()
    except Exception as problem:
        raise ExportError(
            f"{path} does not compile with the policy's motors ({_line(problem)}): take out what names a removed part"
        ) from None
    try:
        check(model, policy, names, notes)
    except ExportError as problem:
        raise ExportError(f"{path}: {problem}") from None
    return model, [f"{path}: {note}" for note in notes]


def _line(problem):
    return " ".join(str(problem).split())


_told = set()


def _tell(text):
    """A warning of the physics, each kind once, and not into a file of MuJoCo's."""
    kind = text.split(" at ")[0]
    if kind not in _told:
        _told.add(kind)
        print(f"MuJoCo: {text.strip()}", file=sys.stderr)


def find(names, wanted):
    """The name in `names` that means the joint `wanted`, with or without `_joint`, or nothing."""
    short = wanted.removesuffix(SUFFIX)
    return next((name for name in (wanted, short, short + SUFFIX) if name in names), None)


def _joints(spec, path, policy, notes):
    """The policy's joints in its order."""
    there = {joint.name: joint for joint in spec.joints}
    wanted = [joint["name"] for joint in policy.description["joints"]]
    found = [find(there, name) for name in wanted]
    missing = [name for name, joint in zip(wanted, found, strict=True) if joint is None]
    if missing:
        more = f" and {len(missing) - NAMED} more" if len(missing) > NAMED else ""
        raise ExportError(
            f"{path} has no joint {', '.join(missing[:NAMED])}{more} (with or without `{SUFFIX}`), which the policy "
            "drives: name the joints as policy.json does"
        )
    for name in found:
        if there[name].type != mujoco.mjtJoint.mjJNT_HINGE:
            raise ExportError(f"{path}: joint {name} is no hinge: give it type=\"hinge\"")
    renamed = [name for name, joint in zip(wanted, found, strict=True) if name != joint]
    if renamed:
        notes.append(f"{len(renamed)} joints are named without `{SUFFIX}`")
    return [there[name] for name in found]


def _root(joint, path):
    """The body that floats."""
    body = joint.parent
    while body.parent.name != "world":
        body = body.parent
    if not any(joint.type == mujoco.mjtJoint.mjJNT_FREE for joint in body.joints):
        raise ExportError(f"{path}: body {body.name} is fixed to the world: put <freejoint/> into it")
    return body


def _hold_others(spec, root, joints, notes):
    """Joints of the robot that the policy does not know become rigid."""
    known = {joint.name for joint in joints}
    others = [
        joint for joint in root.find_all(mujoco.mjtObj.mjOBJ_JOINT)
        if joint.name not in known and joint.type != mujoco.mjtJoint.mjJNT_FREE
    ]
    if others:
        notes.append(f"joints that the policy does not drive are rigid: {', '.join(joint.name for joint in others)}")
    for joint in others:
        spec.delete(joint)


def _motors(spec, joints, policy, notes):
    """One position servo for each joint: kp, kd, and effort of policy.json, in its order."""
    # Neither fits another number of joints and motors.
    for element in [*spec.keys, *spec.sensors]:
        spec.delete(element)
    if len(spec.actuators) > 0:
        notes.append(f"its {len(spec.actuators)} actuators are replaced by the motors of policy.json")
    for actuator in list(spec.actuators):
        spec.delete(actuator)
    for joint, said in zip(joints, policy.description["joints"], strict=True):
        motor = spec.add_actuator(name=said["name"].removesuffix(SUFFIX), target=joint.name)
        motor.trntype = mujoco.mjtTrn.mjTRN_JOINT
        motor.dyntype = mujoco.mjtDyn.mjDYN_NONE
        motor.gaintype, motor.biastype = mujoco.mjtGain.mjGAIN_FIXED, mujoco.mjtBias.mjBIAS_AFFINE
        motor.gainprm = [said["kp"], *np.zeros(9)]
        motor.biasprm = [0, -said["kp"], -said["kd"], *np.zeros(7)]
        motor.gear = [1, 0, 0, 0, 0, 0]
        motor.ctrllimited, motor.forcelimited = False, True
        motor.forcerange = [-said["effort"], said["effort"]]


def _still(body):
    """Geoms that never move."""
    rigid = [child for child in body.bodies if len(child.joints) == 0]
    return [*body.geoms, *(geom for child in rigid for geom in _still(child))]


def _has_floor(spec):
    """Whether something that never moves can be met."""
    paired = {name for pair in spec.pairs for name in (pair.geomname1, pair.geomname2)}
    return any(geom.contype or geom.conaffinity or geom.name in paired for geom in _still(spec.worldbody))


def _has_plane(spec):
    return any(geom.type == mujoco.mjtGeom.mjGEOM_PLANE for geom in spec.worldbody.geoms)


def _surroundings(spec, notes):
    """A floor and a light, if there is none."""
    if not _has_floor(spec):
        notes.append("there is no floor: a plane at z = 0 is added")
        spec.worldbody.add_geom(
            type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 0.1], contype=1, conaffinity=1, rgba=[0.8, 0.82, 0.85, 1]
        )
    if len(spec.lights) == 0:
        notes.append("there is no light: one is added")
        spec.worldbody.add_light(pos=[0, 0, 4], dir=[0.2, 0.3, -1])
    # Room for pictures.
    spec.visual.global_.offwidth = max(spec.visual.global_.offwidth, 640)
    spec.visual.global_.offheight = max(spec.visual.global_.offheight, 480)


def _lay_bumps(spec, height):
    """A height field upon the floor; what meets the floor by a pair meets it too."""
    floors = [geom for geom in spec.worldbody.geoms if geom.type == mujoco.mjtGeom.mjGEOM_PLANE]
    floor = max(floors, key=lambda geom: geom.pos[2])
    points = round(2 * BUMPS_REACH / BUMPS_GRID) + 1
    field = spec.add_hfield(name=BUMPS, nrow=points, ncol=points, size=[BUMPS_REACH, BUMPS_REACH, height, 0.1])
    # The compiler stretches what it is given to 0 to 1: one point up; `stress.bumps` fills it in for each robot.
    data = np.zeros(points * points)
    data[0] = 1.0
    field.userdata = data
    spec.worldbody.add_geom(
        name=BUMPS, type=mujoco.mjtGeom.mjGEOM_HFIELD, hfieldname=BUMPS, pos=[0, 0, floor.pos[2]],
        contype=floor.contype, conaffinity=floor.conaffinity, condim=floor.condim, friction=floor.friction,
        rgba=[0.7, 0.72, 0.7, 1],
    )
    names = {geom.name for geom in floors}
    for pair in list(spec.pairs):
        other = {pair.geomname1, pair.geomname2} - names
        if len(other) == 1:
            spec.add_pair(
                geomname1=other.pop(), geomname2=BUMPS, condim=pair.condim, friction=pair.friction,
                solref=pair.solref, solimp=pair.solimp, margin=pair.margin, gap=pair.gap,
            )

