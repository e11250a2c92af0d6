"""What can go wrong with the stand-in: each changes a state before it is sent, from a moment on."""

import math

from .messages import low_cmd
from .state import remote_bytes

KNEE = 3


def lying(state):
    half = math.radians(70) / 2
    state.imu_state.quaternion = [math.cos(half), math.sin(half), 0.0, 0.0]


def tilt(robot, state):
    """the IMU says 70° of roll"""
    lying(state)


def heat(robot, state):
    """the left knee's motor is at 120 °C"""
    state.motor_state[KNEE].temperature = [50, 120]


def speed(robot, state):
    """the left knee turns at 60 rad/s"""
    state.motor_state[KNEE].dq = 60.0


def position(robot, state):
    """the left knee is at −1 rad, where it cannot be"""
    state.motor_state[KNEE].q = -1.0


def nan(robot, state):
    """the left knee's position is no number"""
    state.motor_state[KNEE].q = math.nan


def imu(robot, state):
    """the IMU's quaternion is all zeros"""
    state.imu_state.quaternion = [0.0] * 4


def silence(robot, state):
    """no state is sent any more"""
    robot.muted = True


def frozen(robot, state):
    """the same state is sent again and again"""
    robot.frozen = robot.frozen or robot.tick


def key(robot, state):
    """the remote's keys are let go"""
    state.wireless_remote = remote_bytes([])


def checksum(robot, state):
    """after each state another one comes that says 70° of roll, with a wrong checksum"""
    robot.lies = True


def rival(robot, state):
    """another program sends commands"""
    robot.command_too(low_cmd(state.mode_machine))


FAULTS = {fault.__name__: fault for fault in (
    tilt, heat, speed, position, nan, imu, silence, frozen, key, checksum, rival
)}


def explained():
    """The list, for people."""
    return "\n".join(f"{name:10} {fault.__doc__}" for name, fault in FAULTS.items())
