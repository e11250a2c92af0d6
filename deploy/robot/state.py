"""A LowState as numbers: what a controller looks at, in the units and frames of the policy."""

import math
import struct
from collections import namedtuple

import numpy as np

MOTORS = 29
# Bits of the remote's keys, as unitree_sdk2 names them.
KEYS = {name: 1 << bit for bit, name in enumerate(
    ("R1", "L1", "start", "select", "R2", "L2", "F1", "F2", "A", "B", "X", "Y", "up", "right", "down", "left")
)}
# Keys, then the left stick to the right, the right stick to the right and forward, L2, the left stick forward.
REMOTE = struct.Struct("<2xH5f16x")

Remote = namedtuple("Remote", "keys left_x right_x right_y left_y")


class State:
    """Of a LowState that arrived at `time` (s, monotonic); `pelvis` is position and velocity by a simulator, if any."""

    def __init__(self, message, time, pelvis=None):
        motors = message.motor_state[:MOTORS]
        self.time, self.tick = time, message.tick
        self.mode_machine = message.mode_machine
        self.position = np.array([motor.q for motor in motors])
        self.velocity = np.array([motor.dq for motor in motors])
        self.temperature = np.array([max(motor.temperature) for motor in motors])
        self.motor_fault = np.array([motor.motorstate for motor in motors])
        self.turning = np.array(message.imu_state.gyroscope)
        self.orientation = np.array(message.imu_state.quaternion)
        self.remote = remote(bytes(message.wireless_remote))
        self.pelvis = None if pelvis is None else tuple(np.array(part) for part in pelvis)

    def to_base(self):
        """Rotation from the world frame into that of the pelvis."""
        w, x, y, z = self.orientation / np.linalg.norm(self.orientation)
        return np.array([
            [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)],
            [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)],
            [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)],
        ])

    def gravity(self):
        """Direction of gravity in the frame of the pelvis: (0, 0, −1) upright."""
        return self.to_base() @ [0.0, 0.0, -1.0]

    def tilt(self):
        """Angle of the pelvis to the vertical, rad."""
        return math.acos(min(1.0, max(-1.0, -self.gravity()[2])))


def remote(data):
    """The remote's 40 bytes. Sticks are −1 to 1; what is no such number is 0."""
    keys, *sticks = REMOTE.unpack(data)
    left_x, right_x, right_y, _, left_y = (stick if -1.0 <= stick <= 1.0 else 0.0 for stick in sticks)
    return Remote(keys, left_x, right_x, right_y, left_y)


def remote_bytes(keys, left_x=0.0, right_x=0.0, right_y=0.0, left_y=0.0):
    """As `remote` reads them."""
    return REMOTE.pack(sum(KEYS[key] for key in keys), left_x, right_x, right_y, 0.0, left_y)
