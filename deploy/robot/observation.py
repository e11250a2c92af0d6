"""What a policy sees, from a robot's state; and whether a robot can tell it at all."""

import numpy as np

from .error import RobotError

MEASURED = (
    "angular_velocity", "gravity", "command", "joint_position", "joint_angle", "joint_velocity", "previous_action",
)
SIMULATED = ("height", "linear_velocity")


def check(policy, from_simulator):
    """Refuses a policy that sees what cannot be told; gives the terms that only a simulator tells."""
    names = [term["name"] for term in policy.terms()]
    place = f"{policy.folder}/policy.json"
    unknown = [name for name in names if name not in MEASURED + SIMULATED]
    if unknown:
        raise RobotError(
            f"{place}: the policy sees {', '.join(unknown)}, which neither a robot nor its simulator tells: train one "
            f"whose observation.actor.terms are of {', '.join(MEASURED)}"
        )
    simulated = [name for name in names if name in SIMULATED]
    if simulated and not from_simulator:
        raise RobotError(
            f"{place}: the policy sees {' and '.join(simulated)}, which no robot measures: train one without "
            "(observation.actor.terms), or give --state-from-simulator where a simulator answers"
        )
    return simulated


class Observer:
    """Rows for the policy, with the past that it remembers."""

    def __init__(self, policy, motors):
        self._terms, self._motors = policy.terms(), motors
        self._seen = {}

    def row(self, state, command, previous_action):
        """What is seen now; once in a control step."""
        row = []
        for term in self._terms:
            now = np.asarray(self._told(term["name"], state, command, previous_action), dtype=np.float64)
            if term["clip"] is not None:
                now = np.clip(now, -term["clip"], term["clip"])
            now = now * term["scale"]
            # The first stands for those before it; the newest comes first.
            before = self._seen.get(term["name"], [now] * term["past"])
            self._seen[term["name"]] = [now, *before][: 1 + term["past"]]
            row += self._seen[term["name"]]
        return np.concatenate(row)

    def _told(self, name, state, command, previous_action):
        driven = self._motors.driven
        match name:
            case "angular_velocity":
                return state.turning
            case "gravity":
                return state.gravity()
            case "command":
                return command
            case "joint_position":
                return state.position[driven] - self._motors.default[driven]
            case "joint_angle":
                return state.position[driven]
            case "joint_velocity":
                return state.velocity[driven]
            case "previous_action":
                return previous_action
            case "height":
                return state.pelvis[0][2:]
            case "linear_velocity":
                return state.to_base() @ state.pelvis[1]
