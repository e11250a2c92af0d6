"""Messages of Unitree's robots with up to 35 motors (unitree_hg) and of their simulator's odometry (unitree_go).

Names, order and types are those of the public IDL of unitree_sdk2 (BSD-3-Clause): readers and writers meet only if all
three agree.
"""

from dataclasses import dataclass

from cyclonedds.idl import IdlStruct
from cyclonedds.idl.annotations import autoid, final
from cyclonedds.idl.types import array, float32, int8, int16, int32, uint8, uint32

SLOTS = 35  # Motors in a message; the G1 has 29 at most.


@dataclass
@final
@autoid("sequential")
class MotorCmd(IdlStruct, typename="unitree_hg.msg.dds_.MotorCmd_"):
    """torque = tau + kp·(q − measured) + kd·(dq − measured); rad, rad/s, N·m."""

    mode: uint8  # 1: enabled
    q: float32
    dq: float32
    tau: float32
    kp: float32
    kd: float32
    reserve: uint32


@dataclass
@final
@autoid("sequential")
class LowCmd(IdlStruct, typename="unitree_hg.msg.dds_.LowCmd_"):
    """What motors are told."""

    mode_pr: uint8  # 0: ankles by pitch and roll
    mode_machine: uint8  # as the robot says it
    motor_cmd: array[MotorCmd, SLOTS]
    reserve: array[uint32, 4]
    crc: uint32


@dataclass
@final
@autoid("sequential")
class ImuState(IdlStruct, typename="unitree_hg.msg.dds_.IMUState_"):
    """Of the pelvis: quaternion w x y z, base to world; rad/s, m/s² and rad in the base frame."""

    quaternion: array[float32, 4]
    gyroscope: array[float32, 3]
    accelerometer: array[float32, 3]
    rpy: array[float32, 3]
    temperature: int16


@dataclass
@final
@autoid("sequential")
class MotorState(IdlStruct, typename="unitree_hg.msg.dds_.MotorState_"):
    """rad, rad/s, rad/s², N·m, °C (two places), V."""

    mode: uint8
    q: float32
    dq: float32
    ddq: float32
    tau_est: float32
    temperature: array[int16, 2]
    vol: float32
    sensor: array[uint32, 2]
    motorstate: uint32  # 0: no fault
    reserve: array[uint32, 4]


@dataclass
@final
@autoid("sequential")
class LowState(IdlStruct, typename="unitree_hg.msg.dds_.LowState_"):
    """What motors and sensors say."""

    version: array[uint32, 2]
    mode_pr: uint8
    mode_machine: uint8
    tick: uint32  # ms
    imu_state: ImuState
    motor_state: array[MotorState, SLOTS]
    wireless_remote: array[uint8, 40]
    reserve: array[uint32, 4]
    crc: uint32


@dataclass
@final
@autoid("sequential")
class TimeSpec(IdlStruct, typename="unitree_go.msg.dds_.TimeSpec_"):
    """A time."""

    sec: int32
    nanosec: uint32


@dataclass
@final
@autoid("sequential")
class GoImuState(IdlStruct, typename="unitree_go.msg.dds_.IMUState_"):
    """As `ImuState`, of other robots."""

    quaternion: array[float32, 4]
    gyroscope: array[float32, 3]
    accelerometer: array[float32, 3]
    rpy: array[float32, 3]
    temperature: int8


@dataclass
@final
@autoid("sequential")
class PathPoint(IdlStruct, typename="unitree_go.msg.dds_.PathPoint_"):
    """Not used here."""

    t_from_start: float32
    x: float32
    y: float32
    yaw: float32
    vx: float32
    vy: float32
    vyaw: float32


@dataclass
@final
@autoid("sequential")
class SportModeState(IdlStruct, typename="unitree_go.msg.dds_.SportModeState_"):
    """Odometry, as simulators tell it: position (m) and velocity (m/s) of the pelvis in the world frame."""

    stamp: TimeSpec
    error_code: uint32
    imu_state: GoImuState
    mode: uint8
    progress: float32
    gait_type: uint8
    foot_raise_height: float32
    position: array[float32, 3]
    body_height: float32
    velocity: array[float32, 3]
    yaw_speed: float32
    range_obstacle: array[float32, 4]
    foot_force: array[int16, 4]
    foot_position_body: array[float32, 12]
    foot_speed_body: array[float32, 12]
    path_point: array[PathPoint, 10]


def low_cmd(mode_machine):
    """A command that asks nothing of any motor."""
    motors = [MotorCmd(0, 0.0, 0.0, 0.0, 0.0, 0.0, 0) for _ in range(SLOTS)]
    return LowCmd(0, mode_machine, motors, [0] * 4, 0)


def low_state(mode_machine):
    """A state of all zeros, upright, motors at 30 °C."""
    imu = ImuState([1.0, 0.0, 0.0, 0.0], [0.0] * 3, [0.0] * 3, [0.0] * 3, 30)
    motors = [MotorState(1, 0.0, 0.0, 0.0, 0.0, [30, 30], 48.0, [0, 0], 0, [0] * 4) for _ in range(SLOTS)]
    return LowState([1, 0], 0, mode_machine, 0, imu, motors, [0] * 40, [0] * 4, 0)


def odometry(position, velocity):
    """What a simulator says of the pelvis."""
    imu = GoImuState([1.0, 0.0, 0.0, 0.0], [0.0] * 3, [0.0] * 3, [0.0] * 3, 0)
    path = [PathPoint(*[0.0] * 7) for _ in range(10)]
    return SportModeState(
        TimeSpec(0, 0), 0, imu, 0, 0.0, 0, 0.0, list(position), 0.0, list(velocity), 0.0, [0.0] * 4, [0] * 4,
        [0.0] * 12, [0.0] * 12, path,
    )
