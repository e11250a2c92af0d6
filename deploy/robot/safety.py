"""What a robot must not go on with: each is looked for in every state, before anything else is done with it."""

from dataclasses import dataclass

import numpy as np

# Shares of a motor's velocity limit, and rad beyond a joint's range, that measurements may be off by.
FAST, BEYOND = 1.2, 0.15


@dataclass
class Limits:
    """When to stop."""

    tilt: float = 1.0  # rad; as Unitree's own controllers
    temperature: float = 90.0  # °C, of the hotter place of any motor
    silence: float = 0.1  # s without a new state


def fault(state, motors, limits):
    """Why the robot has to be stopped, in words, or nothing."""
    for name in ("position", "velocity", "orientation", "turning"):
        if not np.isfinite(getattr(state, name)).all():
            return f"state: {name} is no number"
    if not 0.9 < np.linalg.norm(state.orientation) < 1.1:
        return "state: the IMU tells no orientation"
    if state.tilt() > limits.tilt:
        return f"tilt: {np.degrees(state.tilt()):.0f}°, limit {np.degrees(limits.tilt):.0f}°"
    at = state.temperature.argmax()
    if state.temperature[at] > limits.temperature:
        return f"temperature: {motors.name[at]} at {state.temperature[at]} °C, limit {limits.temperature:g} °C"
    share = np.abs(state.velocity) / motors.speed
    at = share.argmax()
    if share[at] > FAST:
        return f"speed: {motors.name[at]} at {state.velocity[at]:.1f} rad/s, limit {motors.speed[at]:g} rad/s"
    beyond = np.maximum(motors.lower - state.position, state.position - motors.upper)
    at = beyond.argmax()
    if beyond[at] > BEYOND:
        return (
            f"position: {motors.name[at]} at {state.position[at]:.2f} rad, range {motors.lower[at]:.2f} to "
            f"{motors.upper[at]:.2f} rad"
        )
    return None


def silence(now, last, limits, awaited):
    """Why a robot whose topics `awaited` were last heard at `last` (s) has to be stopped, or nothing."""
    if now - last <= limits.silence:
        return None
    return f"stale state: no new and intact {awaited} for {1000 * (now - last):.0f} ms, limit {1000 * limits.silence:.0f} ms"
