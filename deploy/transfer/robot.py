"""One robot in MuJoCo, built from the export's g1.xml and driven as its policy.json says.

Observations are those of the training environment: same terms, same frames, same order.
"""

import copy

import mujoco
import numpy as np

from .policy import ExportError

TORSO = "torso_link"
SOLES = ("left_ankle_roll_link_sole", "right_ankle_roll_link_sole")
KEYFRAME = "standing"
FREE = 7  # qpos of the floating base: position, quaternion w x y z
CORNERS = np.array([[x, y, -1.0] for x in (-1.0, 1.0) for y in (-1.0, 1.0)])


class Robot:
    """A robot and its floor. `variation` is a row of `Randomization.variation`, or nothing for the nominal robot."""

    def __init__(self, model, policy, variation=None):
        self.model = copy.copy(model) if variation else model
        self.data = mujoco.MjData(self.model)
        self.policy = policy
        control = policy.description["control"]
        self.substeps = round(control["physics_hz"] / control["policy_hz"])
        self.scale = control["action_scale"]
        self.default = policy.joint("default_position")
        self.kp, self.kd, self.effort = (policy.joint(field) for field in ("kp", "kd", "effort"))
        self.joints = len(self.default)
        self.previous_action = np.full(self.joints, control["first_previous_action"])
        self.command = np.zeros(3)
        # What was seen in the steps before, by term, the newest first.
        self.seen = {}
        if variation:
            self._vary(variation)
        self.stand()

    def _vary(self, variation):
        torso = self.model.body(TORSO).id
        mass = self.model.body_mass[torso]
        self.model.body_inertia[torso] *= (mass + variation["torso_mass"]) / mass
        self.model.body_mass[torso] += variation["torso_mass"]
        self.model.body_ipos[torso] += variation["torso_com"]
        for sole in SOLES:
            self.model.geom(sole).friction[0] = variation["friction"]
        mujoco.mj_setConst(self.model, self.data)

    def stand(self):
        """At rest in the default pose, soles on the floor."""
        mujoco.mj_resetDataKeyframe(self.model, self.data, self.model.key(KEYFRAME).id)
        mujoco.mj_forward(self.model, self.data)

    def perturb(self, start, random):
        """Noise of a start as in training, then at least `lift` of clearance under the soles."""
        joints = slice(FREE, FREE + self.joints)
        noise = random.uniform(-start["position_noise"], start["position_noise"], self.joints)
        self.data.qpos[joints] = np.clip(
            self.data.qpos[joints] + noise, self.policy.joint("lower"), self.policy.joint("upper")
        )
        self.data.qvel[6:] += random.uniform(-start["velocity_noise"], start["velocity_noise"], self.joints)
        mujoco.mj_kinematics(self.model, self.data)
        self.data.qpos[2] += max(0.0, start["lift"] - self.lowest_sole_point())
        mujoco.mj_forward(self.model, self.data)

    def lowest_sole_point(self):
        """Height of the lowest corner of both soles, m."""
        heights = []
        for sole in SOLES:
            geom = self.data.geom(sole)
            corners = CORNERS * self.model.geom(sole).size
            heights.append((geom.xpos + corners @ geom.xmat.reshape(3, 3).T)[:, 2].min())
        return min(heights)

    def set_state(self, state):
        """From a dict with the fields of a recording's frame."""
        self.data.qpos[:3] = state["position"]
        self.data.qpos[3:FREE] = state["orientation"]
        self.data.qpos[FREE:] = state["joint_positions"]
        self.data.qvel[:3] = state["linear_velocity"]
        # MuJoCo keeps the angular velocity of a floating base in the frame of the body.
        self.data.qvel[3:6] = rotation(state["orientation"]).T @ np.array(state["angular_velocity"])
        self.data.qvel[6:] = state["joint_velocities"]
        mujoco.mj_forward(self.model, self.data)

    def step(self, action):
        """One control step; gives the positive mechanical work of the motors, J."""
        target = self.default + self.scale * np.asarray(action, dtype=np.float64)
        self.previous_action = np.asarray(action, dtype=np.float64)
        return self.track(target)

    def track(self, target):
        """One control step toward target positions (rad), held over its physics steps."""
        self.data.ctrl[:] = target
        work = 0.0
        for _ in range(self.substeps):
            pull = self.kp * (target - self.data.qpos[FREE:])
            asked = pull - self.kd * self.data.qvel[6:]
            mujoco.mj_step(self.model, self.data)
            speed = self.data.qvel[6:]
            # Damping acts at the end of the step unless the motor is at its limit.
            torque = np.where(
                np.abs(asked) <= self.effort, pull - self.kd * speed, np.clip(asked, -self.effort, self.effort)
            )
            work += np.maximum(torque * speed, 0.0).sum() * self.model.opt.timestep
        return work

    def push(self, change):
        """Adds to the velocity of the whole robot, world frame, m/s."""
        self.data.qvel[:3] += change

    def velocity_in_heading(self):
        """Planar velocity where the robot faces, m/s."""
        w, x, y, z = self.data.qpos[3:FREE]
        yaw = np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
        vx, vy = self.data.qvel[:2]
        return np.array([np.cos(yaw) * vx + np.sin(yaw) * vy, np.cos(yaw) * vy - np.sin(yaw) * vx])

    def yaw_rate(self):
        """About the vertical, rad/s."""
        return (rotation(self.data.qpos[3:FREE]) @ self.data.qvel[3:6])[2]

    def gravity(self):
        """Direction of gravity in the base frame."""
        return -rotation(self.data.qpos[3:FREE])[2]

    def has_fallen(self, task):
        """By the task's rule; a state that is no number has fallen."""
        upright = max(0.0, -self.gravity()[2])
        if "termination" in task:
            height, least = task["termination"]["fall"]["height"], task["termination"]["fall"]["upright"]
        else:  # version 1 of policy.json
            height, least = task["fall_height"], task["fall_upright"]
        return not (self.data.qpos[2] >= height and upright >= least)

    def measured(self):
        """Every term that can be told here, in its unit."""
        base = rotation(self.data.qpos[3:FREE])
        return {
            "height": self.data.qpos[2:3],
            "linear_velocity": base.T @ self.data.qvel[:3],
            "angular_velocity": self.data.qvel[3:6],
            "gravity": self.gravity(),
            "command": self.command,
            "joint_position": self.data.qpos[FREE:] - self.default,
            "joint_angle": self.data.qpos[FREE:],
            "joint_velocity": self.data.qvel[6:],
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

    def sole_force(self):
        """Normal force of the floor on both soles, N."""
        total, wrench = 0.0, np.zeros(6)
        for i in range(self.data.ncon):
            # Legs and arms meet each other, too.
            if 0 not in self.model.geom_bodyid[self.data.contact[i].geom]:
                continue
            mujoco.mj_contactForce(self.model, self.data, i, wrench)
            total += wrench[0]
        return total


def rotation(quaternion):
    """Matrix of a quaternion w x y z: base to world."""
    matrix = np.zeros(9)
    mujoco.mju_quat2Mat(matrix, np.asarray(quaternion, dtype=np.float64))
    return matrix.reshape(3, 3)
