"""From states and wishes to targets and gains: waiting, standing up, ready, walking; or the reason to stop.

Knows neither DDS nor a clock: a call is a control step.
"""

import numpy as np

from .motors import DAMPING
from .state import MOTORS

SLEW = 1.0  # A command changes by at most this, m/s or rad/s, in a second.


class Stop(Exception):
    """Why the robot is not to go on; `code` is the program's exit status."""

    def __init__(self, reason, code=1):
        super().__init__(reason)
        self.code = code


RELEASED = "the operator let go of the key"


class Controller:
    """A policy with what comes before it. `ranges` of commands: least and greatest, a row per part."""

    def __init__(self, policy, motors, observer, ranges, stand_seconds):
        self._policy, self._motors, self._observer, self._ranges = policy, motors, observer, ranges
        control = policy.description["control"]
        self._scale, self._period = control["action_scale"], 1 / control["policy_hz"]
        self._action = np.full(len(motors.driven), control["first_previous_action"])
        self._stand_steps = max(1, round(stand_seconds / self._period))
        self.phase, self._steps, self._begin = "waiting", 0, None
        self._armed = False
        # What is told to the policy comes from nothing, not at once.
        self.command = np.clip(np.zeros(3), *ranges.T)

    def act(self, state, wish):
        """Targets (rad), kp and kd of every motor. Raises `Stop`."""
        if self.phase != "waiting" and not wish.held:
            raise Stop(RELEASED, 0)
        # A key that has been held all the time may be stuck.
        self._armed |= not wish.held
        if self.phase == "waiting" and wish.held and self._armed:
            self._enter("standing up")
            self._begin = state.position
        elif self.phase == "standing up" and self._steps == self._stand_steps:
            self._enter("ready")
        elif self.phase == "ready" and wish.go:
            self._enter("walking")
        self._steps += 1
        match self.phase:
            case "waiting":
                nothing = np.zeros(MOTORS)
                return nothing, nothing, np.full(MOTORS, DAMPING)
            case "standing up":
                target, kp, kd = self._stand(self._steps / self._stand_steps)
            case "ready":
                target, kp, kd = self._stand(1.0)
            case "walking":
                target, kp, kd = self._walk(state, wish), self._motors.kp, self._motors.kd
        return self._motors.limited(target, kp, kd, state), kp, kd

    def _enter(self, phase):
        self.phase, self._steps = phase, 0

    def _stand(self, share):
        """From where it was to the default pose; stiffness comes with it, and damping is there from the start."""
        target = self._begin + share * (self._motors.default - self._begin)
        return target, share * self._motors.kp, DAMPING + share * (self._motors.kd - DAMPING)

    def _walk(self, state, wish):
        change = np.clip(wish.command - self.command, -SLEW * self._period, SLEW * self._period)
        self.command = np.clip(self.command + change, *self._ranges.T)
        seen = self._observer.row(state, self.command, self._action)
        action = np.asarray(self._policy.actions([seen])[0], dtype=np.float64)
        if not np.isfinite(action).all():
            raise Stop("policy: its action is no number")
        self._action = action
        return self._motors.spread(self._motors.default[self._motors.driven] + self._scale * action)
