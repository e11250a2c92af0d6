"""Where the floor and the soles are in any model: heights, slip, and forces of the floor."""

import mujoco
import numpy as np

from .error import ExportError

BOX = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
AROUND = np.linspace(0, 2 * np.pi, 16, endpoint=False)
RING = np.stack([np.cos(AROUND), np.sin(AROUND), np.zeros(16)], axis=1)

ANKLES = ("left_ankle_roll_joint", "right_ankle_roll_joint")
LEVEL = 0.9999  # Cosine of a floor's tilt.
ABOVE = 100.0  # m


class Feet:
    """Both feet, left and right: bodies and what is welded to them; and the floor, whatever never moves."""

    def __init__(self, model, data, bodies):
        self.model, self.bodies = model, bodies
        still = model.body_weldid[model.geom_bodyid] == 0
        self.ground = _ground(model, data, model.body_rootid[bodies[0]], still)
        # −1: no foot.
        self.foot_of = np.full(model.ngeom, -1)
        self.is_floor = still
        self.points, self.radii = [], []
        mujoco.mj_kinematics(model, data)
        for side, body in enumerate(bodies):
            own = np.flatnonzero(model.body_weldid[model.geom_bodyid] == model.body_weldid[body])
            self.foot_of[own] = side
            soles = [geom for geom in own if _meets_floor(model, geom, still)]
            if not soles:
                name = model.body(body).name
                raise ExportError(
                    f"nothing of body {name} meets the floor: give it a geom with contype and conaffinity in the model"
                )
            points, radii = zip(*(_outline(model, geom) for geom in soles), strict=True)
            world = [
                data.geom_xpos[geom] + local @ data.geom_xmat[geom].reshape(3, 3).T
                for geom, local in zip(soles, points, strict=True)
            ]
            # Into the frame of the foot.
            turn = data.xmat[body].reshape(3, 3)
            self.points.append((np.concatenate(world) - data.xpos[body]) @ turn)
            self.radii.append(np.concatenate(radii))

    def lowest(self, data):
        """Of each foot the lowest point of its sole: height above the floor (m), and horizontal speed (m/s)."""
        heights, speeds, twist = np.zeros(2), np.zeros(2), np.zeros(6)
        for side, body in enumerate(self.bodies):
            world = self.points[side] @ data.xmat[body].reshape(3, 3).T
            z = world[:, 2] - self.radii[side]
            at = z.argmin()
            heights[side] = data.xpos[body][2] + z[at] - self.ground
            mujoco.mj_objectVelocity(self.model, data, mujoco.mjtObj.mjOBJ_XBODY, body, twist, 0)
            arm = world[at] - [0, 0, self.radii[side][at]]
            speeds[side] = np.hypot(*(twist[3:] + np.cross(twist[:3], arm))[:2])
        return heights, speeds

    def forces(self, data):
        """Normal force of the floor on each foot, N."""
        total, wrench = np.zeros(2), np.zeros(6)
        if data.ncon == 0:
            return total
        pairs = data.contact.geom
        feet, floors = self.foot_of[pairs], self.is_floor[pairs]
        # Legs and arms meet each other, too.
        for i in np.flatnonzero((feet.max(axis=1) >= 0) & floors.any(axis=1)):
            mujoco.mj_contactForce(self.model, data, i, wrench)
            total[feet[i].max()] += wrench[0]
        return total

    def set_friction(self, friction):
        """Sliding friction of floor and feet: without priorities MuJoCo takes the greater of two."""
        geoms = self.is_floor | (self.foot_of >= 0)
        self.model.geom_friction[geoms, 0] = friction
        for pair in range(self.model.npair):
            if self.is_floor[[self.model.pair_geom1[pair], self.model.pair_geom2[pair]]].any():
                self.model.pair_friction[pair, :2] = friction


def _ground(model, data, pelvis, still):
    """Height of the floor at the start, m: of its highest level plane, or of whatever lies there."""
    mujoco.mj_kinematics(model, data)
    level = data.geom_xmat[:, 8] > LEVEL
    planes = still & level & (model.geom_type == mujoco.mjtGeom.mjGEOM_PLANE)
    if planes.any():
        return float(data.geom_xpos[planes, 2].max())
    # From above, the robot being out of the way.
    data.qpos[model.jnt_qposadr[model.body_jntadr[pelvis]]] += 10 * ABOVE
    mujoco.mj_kinematics(model, data)
    met = np.zeros(1, dtype=np.int32)
    distance = mujoco.mj_ray(model, data, np.array([0, 0, ABOVE]), np.array([0.0, 0, -1]), None, 1, -1, met)
    return float(ABOVE - distance) if distance >= 0 else 0.0


def _meets_floor(model, geom, still):
    types, affinities = model.geom_contype, model.geom_conaffinity
    if np.any(still & ((types[geom] & affinities != 0) | (types & affinities[geom] != 0))):
        return True
    pairs = zip(model.pair_geom1, model.pair_geom2, strict=True)
    return any((a == geom and still[b]) or (b == geom and still[a]) for a, b in pairs)


def _outline(model, geom):
    """Points of a geom in its own frame, and how far its surface is from them, m."""
    kind, size = model.geom_type[geom], model.geom_size[geom]
    kinds = mujoco.mjtGeom
    if kind == kinds.mjGEOM_MESH:
        mesh = model.geom_dataid[geom]
        begin = model.mesh_vertadr[mesh]
        points, radius = model.mesh_vert[begin : begin + model.mesh_vertnum[mesh]].astype(float), 0.0
    elif kind == kinds.mjGEOM_BOX:
        points, radius = BOX * size, 0.0
    elif kind == kinds.mjGEOM_CAPSULE:
        points, radius = np.array([[0, 0, -size[1]], [0, 0, size[1]]]), size[0]
    elif kind == kinds.mjGEOM_CYLINDER:
        ring = RING * size[0]
        points, radius = np.concatenate([ring - [0, 0, size[1]], ring + [0, 0, size[1]]]), 0.0
    elif kind == kinds.mjGEOM_ELLIPSOID:
        # Three rings of it.
        points, radius = np.concatenate([RING, RING[:, [0, 2, 1]], RING[:, [2, 0, 1]]]) * size, 0.0
    else:
        points, radius = np.zeros((1, 3)), size[0]
    return points, np.full(len(points), radius)
