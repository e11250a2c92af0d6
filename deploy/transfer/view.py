"""MuJoCo's own window, with the command on the keyboard."""

import os
import sys
import time

import numpy as np

# As GLFW numbers them.
RIGHT, LEFT, DOWN, UP, SPACE = 262, 263, 264, 265, 32
# What a key adds to the command: forward and leftward velocity (m/s), yaw rate (rad/s).
KEYS = {
    UP: (0.1, 0.0, 0.0), DOWN: (-0.1, 0.0, 0.0), LEFT: (0.0, 0.0, 0.1), RIGHT: (0.0, 0.0, -0.1),
    ord("Q"): (0.0, 0.1, 0.0), ord("E"): (0.0, -0.1, 0.0),
}
HELP = "arrows: faster, slower, turn left, turn right; Q, E: aside to the left, to the right; space: stop"
PARTS = ("forward", "lateral", "yaw_rate")


class Commander:
    """The command that keys make, within what the policy was taught; begins at `command`."""

    def __init__(self, command, policy):
        self.command = np.array(command, dtype=np.float64)
        ranges = np.array([policy.taught(part) for part in PARTS])
        # What was asked for at the start is allowed.
        self.least, self.most = np.minimum(ranges[:, 0], self.command), np.maximum(ranges[:, 1], self.command)

    def press(self, key):
        """Takes a key's number; says the command if the key means something."""
        if key == SPACE:
            self.command = np.zeros(3)
        elif key in KEYS:
            # No remainders of tenths.
            self.command = np.clip(np.round(self.command + KEYS[key], 6), self.least, self.most)
        else:
            return None
        return self.said()

    def said(self):
        """The command in words."""
        forward, left, turn = self.command + 0.0
        return f"{forward:.1f} m/s forward, {left:.1f} m/s to the left, {turn:.1f} rad/s"


def view(policy, robot):
    """Lets the robot walk in the window, in real time, until it is closed; it stands up again after a fall."""
    if sys.platform == "linux" and not {"DISPLAY", "WAYLAND_DISPLAY"} & set(os.environ):
        raise SystemExit("sim2sim: --view opens a window and there is no screen (DISPLAY): use --video or --strip")
    import mujoco.viewer

    commander = Commander(robot.command, policy)
    print(f"{HELP}\n{commander.said()}", flush=True)

    def heard(key):
        said = commander.press(key)
        if said:
            print(said, flush=True)

    period = 1 / policy.description["control"]["policy_hz"]
    with mujoco.viewer.launch_passive(robot.model, robot.data, key_callback=heard) as window:
        while window.is_running():
            began = time.monotonic()
            advance(policy, robot, commander)
            window.sync()
            time.sleep(max(0.0, period - (time.monotonic() - began)))


def advance(policy, robot, commander):
    """One control step at the keyboard's command."""
    robot.command = commander.command
    robot.step(policy.actions([robot.observe()])[0])
    if robot.has_fallen(policy.description["task"]):
        robot.stand()
