"""What is measured of robots on their feet, by the definitions of `ampco evaluate` where that has the same.

Sums over control steps, so that robots add up. Settled is a robot two seconds after its start or a new command.
"""

from dataclasses import dataclass

import numpy as np

from .error import ExportError

SETTLING_SECONDS = 2.0
CONTACT_FORCE = 20.0  # A foot that carries less (N) is in the air.
SOMEWHERE = 0.1  # Below this speed (m/s) a robot goes nowhere.


@dataclass
class Step:
    """One control step of one robot, at its end."""

    command: np.ndarray  # forward, leftward m/s, yaw rate rad/s
    velocity: np.ndarray  # the same, heading frame
    work: float  # positive, of all motors, J
    forces: np.ndarray  # of the floor on the left and the right foot, N
    heights: np.ndarray  # of the lowest points of both soles, m
    speeds: np.ndarray  # of these points, horizontal, m/s
    shoulders: np.ndarray  # pitch, left and right, rad
    lean: float  # of the trunk, rad
    saturated: np.ndarray  # by joint: whether it gave all it has
    sole_peak: float  # greatest force on one foot in a physics step, N
    action_change: float  # mean |a_t − a_{t−1}| over joints


class Record:
    """Sums of one robot, or of several once they are added up."""

    NAMES = ("steps", "squared", "squared_yaw", "velocity", "work", "settled", "settled_squared", "settled_squared_yaw",
             "off", "off_yaw", "off_steps", "down", "flight", "landings", "swing", "clearance", "slip", "swings",
             "swing_angle", "lean", "saturated", "saturated_any", "action_change")

    def __init__(self, hz):
        self.hz = hz
        for name in self.NAMES:
            setattr(self, name, 0.0)
        self.sole_peak = 0.0
        self.before = None
        self.held = 0
        self._begin_strides(None)

    def _begin_strides(self, command):
        self.command = command
        self.whole, self.whole_steps, self.since, self.begun = np.zeros(3), 0, [], False

    def add(self, step):
        """A step; a new command begins anew."""
        if self.command is None or not np.array_equal(step.command, self.command):
            self.close()
            self._begin_strides(step.command.copy())
            self.held = 0
        error = step.velocity - step.command
        self.steps += 1
        self.squared += (error[:2] ** 2).sum()
        self.squared_yaw += error[2] ** 2
        self.velocity = self.velocity + step.velocity
        self.work += step.work
        down = step.forces > CONTACT_FORCE
        landed = down & ~(down if self.before is None else self.before)
        self.before = down
        self.down += down.sum()
        self.flight += not down.any()
        self.landings += landed.sum()
        self.swing += (~down).sum()
        self.clearance += np.maximum(step.heights, 0.0)[~down].sum()
        self.slip += step.speeds[down].sum()
        self.lean += step.lean
        self.saturated = self.saturated + step.saturated
        self.saturated_any += step.saturated.any()
        self.action_change += step.action_change
        self.sole_peak = max(self.sole_peak, step.sole_peak)
        if self.held >= round(SETTLING_SECONDS * self.hz):
            self.settled += 1
            self.settled_squared += (error[:2] ** 2).sum()
            self.settled_squared_yaw += error[2] ** 2
            self._stride(step, landed[0])
        self.held += 1

    def _stride(self, step, left_landed):
        """A stride goes from one landing of the left foot to the next."""
        self.since.append((step.velocity, step.shoulders))
        if not left_landed:
            return
        if self.begun:
            velocities, shoulders = map(np.array, zip(*self.since, strict=True))
            self.whole = self.whole + velocities.sum(axis=0)
            self.whole_steps += len(velocities)
            self.swings += 1
            self.swing_angle += np.ptp(shoulders, axis=0).mean()
        self.begun, self.since = True, []

    def close(self):
        """Ends a stretch under one command. Of a robot without a whole stride, as one that stands, all steps count."""
        total, steps = self.whole, self.whole_steps
        if steps == 0 and self.since:
            total, steps = np.sum([velocity for velocity, _ in self.since], axis=0), len(self.since)
        if steps > 0:
            away = total / steps - self.command
            self.off += steps * np.hypot(*away[:2])
            self.off_yaw += steps * abs(away[2])
            self.off_steps += steps
        self._begin_strides(None)

    def merge(self, other):
        """Adds the sums of another robot; both are closed."""
        for name in self.NAMES:
            setattr(self, name, getattr(self, name) + getattr(other, name))
        self.sole_peak = max(self.sole_peak, other.sole_peak)


def outcome(record, weight, joints):
    """Figures by their names in `ampco evaluate --json`, and those that it lacks; `weight` in N."""
    steps, hz = record.steps, record.hz
    if steps == 0:
        raise ExportError("the physics gives no numbers in the first step: set a smaller timestep in the model")
    velocity = record.velocity / steps
    strides = record.landings / 2
    shares = dict(zip(joints, (np.asarray(record.saturated) / steps * np.ones(len(joints))).tolist(), strict=True))
    worst = max(shares, key=shares.get)
    return {
        "rmse": root(record.squared, steps),
        "rmse_settled": root(record.settled_squared, record.settled),
        "rmse_yaw_rate": root(record.squared_yaw, steps),
        "rmse_yaw_rate_settled": root(record.settled_squared_yaw, record.settled),
        "off": mean(record.off, record.off_steps),
        "off_yaw_rate": mean(record.off_yaw, record.off_steps),
        "energy_j": float(record.work / steps * 1000),
        "velocity": velocity[:2].tolist(),
        "yaw_rate": float(velocity[2]),
        "cost_of_transport": cost_of_transport(record.work / steps * hz, weight, float(np.hypot(*velocity[:2]))),
        "stride_rate_hz": float(strides / steps * hz),
        "duty_factor": float(record.down / (2 * steps)),
        # n = left + right − both + neither
        "double_support": float((record.down + record.flight) / steps - 1),
        "flight_share": float(record.flight / steps),
        "foot_clearance": mean(record.clearance, record.swing),
        "slip_per_stride": mean(record.slip / hz, record.landings),
        "arm_swing_deg": mean(np.degrees(record.swing_angle), record.swings),
        "trunk_lean_deg": float(np.degrees(record.lean / steps)),
        "torque_saturated_share": float(record.saturated_any / steps),
        "saturated_shares": shares,
        "saturated_joint": worst if shares[worst] > 0 else None,
        "sole_force_peak_weights": float(record.sole_peak / weight),
        "action_rate": float(record.action_change / steps),
    }


def mean(total, count):
    """Or nothing of nothing."""
    return float(total / count) if count > 0 else None


def root(total, count):
    """Root of the mean, or nothing of nothing."""
    return float(np.sqrt(total / count)) if count > 0 else None


def cost_of_transport(power, weight, speed):
    """Work per weight and way, from W, N and m/s; none of a robot that goes nowhere."""
    return float(power / (weight * speed)) if speed >= SOMEWHERE else None
