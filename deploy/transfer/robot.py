"""One robot in MuJoCo, built from a model that `model.load` made and driven as policy.json says.

Observations are those of the training environment: same terms, same frames, same order. Stresses (`stress`) change a
robot's own copy of the model, what it reads and what its motors do.
"""

import copy

import mujoco
import numpy as np

from .error import ExportError
from .feet import ANKLES, Feet
from .model import find

FREE = 7  # qpos of the floating base: position, quaternion w x y z
SATURATED = 0.999  # From this share of its effort on a motor gives all it has.
SHOULDERS = ("left_shoulder_pitch_joint", "right_shoulder_pitch_joint")
WAIST = "waist_yaw_joint"


class Robot:
    """A robot and its floor. `variation` is a row of `Randomization.variation`, or nothing for the nominal robot.

    With `own` it has a model of its own, which stresses may change; `index` is its episode.
    """

    def __init__(self, model, policy, variation=None, own=False, index=0):
        self.index = index
        self.model = copy.copy(model) if variation or own else model
        self.data = mujoco.MjData(self.model)
        self.policy = policy
        control = policy.description["control"]
        self.substeps = round(1 / control["policy_hz"] / self.model.opt.timestep)
        self.scale = control["action_scale"]
        self.first_action = control["first_previous_action"]
        self.default = policy.joint("default_position")
        self.kp, self.kd, self.effort = (policy.joint(field) for field in ("kp", "kd", "effort"))
        self.joints = len(self.default)
        self._find_joints()
        self.command = np.zeros(3)
        # What a stress changes: offsets of encoders (rad), mounting of the IMU, share of height and velocity that is
        # told, physics steps until an action arrives; and what is done at each control step and each physics step.
        self.encoder = np.zeros(self.joints)
        self.imu = np.eye(3)
        self.told = 1.0
        self.delay = 0
        self.each_step, self.each_substep = [], []
        if variation:
            self._vary(variation)
        self.stand()
        self.standing_height = self.height()

    def _find_joints(self):
        names = [self.model.joint(i).name for i in range(self.model.njnt)]
        wanted = [joint["name"] for joint in self.policy.description["joints"]]
        ids = np.array([names.index(find(names, name)) for name in wanted])
        self.q, self.v = self.model.jnt_qposadr[ids], self.model.jnt_dofadr[ids]
        at = dict(zip(wanted, self.model.jnt_bodyid[ids], strict=True))
        # Some models have a link of little weight between the waist and the torso, rigid or made so.
        rigid = np.flatnonzero(self.model.body_weldid == self.model.body_weldid[at[WAIST]])
        self.torso = rigid[self.model.body_mass[rigid].argmax()]
        self.arms = [wanted.index(name) for name in SHOULDERS]
        self.pelvis = self.model.body_rootid[self.torso]
        root = self.model.body_jntadr[self.pelvis]
        self.base, self.base_v = self.model.jnt_qposadr[root], self.model.jnt_dofadr[root]
        self.feet = Feet(self.model, self.data, [at[name] for name in ANKLES])
        limited = self.model.jnt_actfrclimited[ids].astype(bool)
        self.effort = np.where(limited, np.minimum(self.effort, self.model.jnt_actfrcrange[ids, 1]), self.effort)
        # How these integrate, damping acts at the end of a step.
        self.is_implicit = self.model.opt.integrator in (
            mujoco.mjtIntegrator.mjINT_IMPLICIT, mujoco.mjtIntegrator.mjINT_IMPLICITFAST
        )

    def _vary(self, variation):
        mass = self.model.body_mass[self.torso]
        self.model.body_inertia[self.torso] *= (mass + variation["torso_mass"]) / mass
        self.model.body_mass[self.torso] += variation["torso_mass"]
        self.model.body_ipos[self.torso] += variation["torso_com"]
        self.feet.set_friction(variation["friction"])
        mujoco.mj_setConst(self.model, self.data)

    def load(self, mass):
        """Puts a point of so many kg at the torso's centre of mass."""
        self.model.body_mass[self.torso] += mass
        mujoco.mj_setConst(self.model, mujoco.MjData(self.model))

    def stand(self):
        """At rest in the default pose, soles on the floor, nothing remembered."""
        mujoco.mj_resetData(self.model, self.data)
        self.position[:] = 0.0
        self.data.qpos[self.base + 3 : self.base + FREE] = [1, 0, 0, 0]
        self.data.qpos[self.q] = self.default
        mujoco.mj_kinematics(self.model, self.data)
        self.position[2] -= self.lowest_sole_point()
        mujoco.mj_forward(self.model, self.data)
        self.previous_action = np.full(self.joints, self.first_action)
        # What was seen in the steps before, by term, the newest first.
        self.seen = {}
        self.waiting = []
        # Of the last control step.
        self.saturated, self.sole_peak = np.zeros(self.joints, dtype=bool), 0.0

    @property
    def position(self):
        """Of the pelvis, world frame, m; to be written to, too."""
        return self.data.qpos[self.base : self.base + 3]

    @property
    def orientation(self):
        """Of the pelvis, w x y z."""
        return self.data.qpos[self.base + 3 : self.base + FREE]

    @property
    def velocity(self):
        """Of the pelvis, world frame, m/s; to be written to, too."""
        return self.data.qvel[self.base_v : self.base_v + 3]

    @property
    def turning(self):
        """Angular velocity of the pelvis, base frame as MuJoCo keeps it, rad/s."""
        return self.data.qvel[self.base_v + 3 : self.base_v + 6]

    def height(self):
        """Of the pelvis above the floor, m."""
        return self.position[2] - self.feet.ground

    def weight(self):
        """N."""
        return self.model.body_subtreemass[self.pelvis] * 9.81

    def perturb(self, start, random):
        """Noise of a start as in training, then at least `lift` of clearance under the soles."""
        noise = random.uniform(-start["position_noise"], start["position_noise"], self.joints)
        self.data.qpos[self.q] = np.clip(
            self.data.qpos[self.q] + noise, self.policy.joint("lower"), self.policy.joint("upper")
        )
        self.data.qvel[self.v] += random.uniform(-start["velocity_noise"], start["velocity_noise"], self.joints)
        mujoco.mj_kinematics(self.model, self.data)
        self.position[2] += max(0.0, start["lift"] - self.lowest_sole_point())
        mujoco.mj_forward(self.model, self.data)

    def lowest_sole_point(self):
        """Height of the lowest point of both soles above the floor, m."""
        return self.feet.lowest(self.data)[0].min()

    def sole_force(self):
        """Normal force of the floor on both soles, N."""
        return self.feet.forces(self.data).sum()

    def set_state(self, state):
        """From a dict with the fields of a recording's frame."""
        self.position[:] = state["position"]
        self.orientation[:] = state["orientation"]
        self.data.qpos[self.q] = state["joint_positions"]
        self.velocity[:] = state["linear_velocity"]
        self.turning[:] = rotation(state["orientation"]).T @ np.array(state["angular_velocity"])
        self.data.qvel[self.v] = state["joint_velocities"]
        mujoco.mj_forward(self.model, self.data)

    def step(self, action):
        """One control step; gives the positive mechanical work of the motors, J."""
        target = self.default + self.scale * np.asarray(action, dtype=np.float64)
        self.previous_action = np.asarray(action, dtype=np.float64)
        return self.track(target)

    def track(self, target):
        """One control step toward target positions (rad), held over its physics steps."""
        data, work = self.data, 0.0
        self.saturated, self.sole_peak = np.zeros(self.joints, dtype=bool), 0.0
        for _ in range(self.substeps):
            for act in self.each_substep:
                act()
            self.waiting.append(target)
            # Before the first action arrives motors hold the pose of the start.
            arrived = self.waiting.pop(0) if len(self.waiting) > self.delay else self.default
            # A motor turns to where its encoder reads the target.
            data.ctrl[:] = aim = arrived - self.encoder
            pull = self.kp * (aim - data.qpos[self.q])
            before = data.qvel[self.v]
            asked = pull - self.kd * before
            mujoco.mj_step(self.model, data)
            speed = data.qvel[self.v]
            # At its limit a motor does not damp.
            given = pull - self.kd * (speed if self.is_implicit else before)
            torque = np.where(np.abs(asked) <= self.effort, given, np.clip(asked, -self.effort, self.effort))
            work += np.maximum(torque * speed, 0.0).sum() * self.model.opt.timestep
            self.saturated |= np.abs(asked) >= SATURATED * self.effort
            self.sole_peak = max(self.sole_peak, self.feet.forces(data).max())
        return work

    def push(self, change):
        """Adds to the velocity of the whole robot, world frame, m/s."""
        self.velocity[:] += change

    def velocity_in_heading(self):
        """Planar velocity where the robot faces, m/s."""
        cos, sin = self.facing()
        vx, vy = self.velocity[:2]
        return np.array([cos * vx + sin * vy, cos * vy - sin * vx])

    def facing(self):
        """Cosine and sine of the yaw."""
        w, x, y, z = self.orientation
        yaw = np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
        return np.cos(yaw), np.sin(yaw)

    def yaw_rate(self):
        """About the vertical, rad/s."""
        return (rotation(self.orientation) @ self.turning)[2]

    def down(self):
        """Direction of gravity, world frame."""
        gravity = self.model.opt.gravity
        size = np.linalg.norm(gravity)
        return gravity / size if size > 0 else np.array([0.0, 0.0, -1.0])

    def gravity(self):
        """Direction of gravity in the base frame."""
        return rotation(self.orientation).T @ self.down()

    def lean(self):
        """Angle of the trunk's axis to the vertical, rad."""
        up = self.data.xmat[self.torso].reshape(3, 3)[:, 2]
        return np.arccos(np.clip(-up @ self.down(), -1.0, 1.0))

    def shoulders(self):
        """Pitch of the left and the right one, rad."""
        return self.data.qpos[self.q[self.arms]]

    def has_fallen(self, task):
        """By the task's rule; a state that is no number has fallen."""
        upright = max(0.0, -self.gravity()[2])
        if "termination" in task:
            height, least = task["termination"]["fall"]["height"], task["termination"]["fall"]["upright"]
        else:  # version 1 of policy.json
            height, least = task["fall_height"], task["fall_upright"]
        return not (self.height() >= height and upright >= least and np.isfinite(self.data.qvel).all())

    def measured(self):
        """Every term that can be told here, in its unit."""
        base = rotation(self.orientation)
        angle = self.data.qpos[self.q] + self.encoder
        return {
            "height": np.array([self.standing_height + self.told * (self.height() - self.standing_height)]),
            "linear_velocity": self.told * (base.T @ self.velocity),
            "angular_velocity": self.imu @ self.turning,
            "gravity": self.imu @ self.gravity(),
            "command": self.command,
            "joint_position": angle - self.default,
            "joint_angle": angle,
            "joint_velocity": self.data.qvel[self.v],
            "previous_action": self.previous_action,
        }

    def observe(self, blur=lambda term, values: values):
        """What the policy sees now, once in a control step; `blur` adds the noise of sensors."""
        measured, row = self.measured(), []
        for term in self.policy.terms():
            if term["name"] not in measured:
                raise ExportError(
                    f"{self.policy.folder}/policy.json: the policy sees `{term['name']}`, which is not told here: "
                    "train one whose observation.actor.terms a robot can measure"
                )
            now = np.array(blur(term, measured[term["name"]]), dtype=np.float64)
            if term["clip"] is not None:
                now = np.clip(now, -term["clip"], term["clip"])
            now = now * term["scale"]
            # The first stands for those before it.
            before = self.seen.get(term["name"], [now] * term["past"])
            frames = [now, *before][: 1 + term["past"]]
            self.seen[term["name"]] = frames
            row += frames
        return np.concatenate(row)


def rotation(quaternion):
    """Matrix of a quaternion w x y z: base to world."""
    matrix = np.zeros(9)
    mujoco.mju_quat2Mat(matrix, np.asarray(quaternion, dtype=np.float64))
    return matrix.reshape(3, 3)
