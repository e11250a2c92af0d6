"""The 29 motors of the G1 as a policy's description has them: its own joints, and those that are held."""

import numpy as np

from .error import RobotError
from .messages import low_cmd
from .state import MOTORS

# N·m·s/rad, of every motor: what Unitree's controllers damp with when they are passive.
DAMPING = 3.0
# How many times its effort a motor may be asked for. Drives cut torques to the effort many times within a control step; a
# target that is cut to it once, at the step's beginning, leaves a motor too weak for the rest of it. This is against
# targets that are far off only.
HEADROOM = 2.0


class Motors:
    """Figures by motor: `default` (rad), `lower`, `upper`, `kp`, `kd`, `effort` (N·m), `speed` (rad/s), `name`; `driven` are
    the motors of the policy's joints in its order."""

    def __init__(self, description, place):
        joints = description["joints"]
        every = [*joints, *description.get("held_motors", [])]
        if sorted(part.get("unitree_motor", -1) for part in every) != list(range(MOTORS)):
            raise RobotError(f"{place} does not say which of {MOTORS} motors are driven and held: export the run again")
        self.driven = np.array([joint["unitree_motor"] for joint in joints])
        every.sort(key=lambda part: part["unitree_motor"])
        self.name = [part["name"].removesuffix("_joint") for part in every]

        def figures(key):
            return np.array([part[key] for part in every], dtype=np.float64)

        self.default, self.lower, self.upper = figures("default_position"), figures("lower"), figures("upper")
        self.kp, self.kd = figures("kp"), figures("kd")
        self.effort, self.speed = figures("effort"), figures("velocity_limit")

    def spread(self, numbers):
        """A number for each of the policy's joints to all motors; held ones get their default position."""
        every = self.default.copy()
        every[self.driven] = numbers
        return every

    def limited(self, target, kp, kd, state):
        """Targets within the joints' range, and then such that no motor is asked for more than `HEADROOM` efforts."""
        target = np.clip(target, self.lower, self.upper)
        # −asked ≤ kp·(target − q) − kd·q̇ ≤ asked
        stiff, asked = np.maximum(kp, 1e-6), HEADROOM * self.effort
        least = state.position + (kd * state.velocity - asked) / stiff
        most = state.position + (kd * state.velocity + asked) / stiff
        return np.clip(target, least, most)

    def torque(self, target, kp, kd, state):
        """What motors will be asked for at once, N·m."""
        return kp * (target - state.position) - kd * state.velocity

    def command(self, target, kp, kd, mode_machine):
        """A LowCmd without its checksum."""
        command = low_cmd(mode_machine)
        for motor, q, stiffness, damping in zip(command.motor_cmd, target, kp, kd, strict=False):
            motor.mode, motor.q, motor.kp, motor.kd = 1, float(q), float(stiffness), float(damping)
        return command

    def damping(self, mode_machine):
        """Every motor gives way, slowly."""
        nothing = np.zeros(MOTORS)
        return self.command(nothing, nothing, np.full(MOTORS, DAMPING), mode_machine)
