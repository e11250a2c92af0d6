"""A robot in MuJoCo behind Unitree's topics, with a gantry that holds it until it walks and a remote that is pressed.

It obeys LowCmd as the robot does: torque = tau + kp·(q − measured) + kd·(dq − measured) within the motors' efforts; a
command with a wrong checksum or another mode_machine is ignored.
"""

import copy
import json
import time

import numpy as np
from cyclonedds.core import Policy as QosPolicy
from cyclonedds.core import Qos

from . import crc
from .bus import COMMANDS, NEWEST, ODOMETRY, STATES, Participant, newest
from .error import RobotError
from .faults import FAULTS, lying
from .messages import LowCmd, LowState, SportModeState, low_state, odometry
from .pace import Pace
from .state import remote_bytes
from .wish import sticks

HEARD = Qos(QosPolicy.IgnoreLocal.Participant, base=NEWEST)
MODE_MACHINE = 4  # a G1 of 23 joints
PAUSE = 0.02  # s that a command is waited for in lockstep
GONE = 3.0  # s without a command after which a controller is taken to be gone
DAMPED = 5  # commands of damping that end a run
# Where it hangs at first: legs drawn up, arms down.
CROUCH = {"hip_pitch": -0.6, "knee": 1.2, "ankle_pitch": -0.6}


class StandIn:
    """One robot, one controller after another; `given` are the options."""

    def __init__(self, given):
        # Only here: a controller does without MuJoCo.
        from transfer.model import load
        from transfer.policy import Policy
        from transfer.robot import Robot

        from .command import ranges
        from .motors import Motors

        policy = Policy(given.policy)
        model, _ = load(policy.folder / "g1.xml", policy)
        self.given, self.policy = given, policy
        self.robot = Robot(model, policy, own=True)
        self.motors = Motors(policy.description, f"{policy.folder}/policy.json")
        self.ranges = ranges(policy.description, f"{policy.folder}/policy.json")
        self.period = 1 / policy.description["control"]["policy_hz"]
        self.sessions = _sessions(given.fault)
        self.participant = participant = Participant(given.domain, given.interface)
        self.commands = participant.reader(COMMANDS, LowCmd, HEARD)
        self.states = participant.writer(STATES, LowState)
        self.odometry = participant.writer(ODOMETRY, SportModeState)
        # A second one beside the controller's, for a fault.
        self.command_too = participant.writer(COMMANDS, LowCmd).write if given.fault else None
        self.tick = 1
        self.hang()

    def hang(self):
        """On the gantry, nothing heard yet."""
        robot = self.robot
        robot.stand()
        for i, joint in enumerate(self.policy.description["joints"]):
            part = next((part for part in CROUCH if part in joint["name"]), None)
            robot.data.qpos[robot.q[i]] = CROUCH.get(part, 0.0)
        self.faults = self.sessions.pop(0)
        self.muted = self.frozen = self.lies = False
        self.held, self.ready = True, False
        self.moved, self.damped, self.heard, self.ignored, self.fallen = False, 0, 0, 0, None
        self.walked, self.distance = 0.0, 0.0
        self.last_command = time.monotonic()

    def run(self):
        """Until Ctrl-C, or with `--once` until controllers have come and gone; gives the exit status."""
        place = f"DDS domain {self.given.domain}, interface {self.given.interface}"
        print(f"stand-in of {self.policy.title()} on {place}; Ctrl-C ends it", flush=True)
        pace = Pace(self.period / 2)
        try:
            while True:
                self._turn(pace)
                self.publish()
                if self.is_over():
                    print(json.dumps(self.told()), flush=True)
                    if not self.sessions and self.given.once:
                        return 0
                    self.sessions = self.sessions or [[]]
                    self.hang()
        except KeyboardInterrupt:
            return 130

    def _turn(self, pace):
        """Takes a command and goes on with time."""
        if not self.given.lockstep:
            pace.wait()
            self.obey()
            self.advance(self.period / 2)
            return
        deadline = time.monotonic() + PAUSE
        while not (obeyed := self.obey()) and time.monotonic() < deadline:
            time.sleep(0.001)
        # A controller waits for a state that is new before it commands.
        if obeyed or not self.moved:
            self.advance(self.period)

    def is_over(self):
        """Whether a controller that moved the robot has damped it or gone."""
        gone = time.monotonic() - self.last_command > GONE
        return self.moved and (self.damped >= DAMPED or gone)

    def told(self):
        """What became of it."""
        return {
            "walked_seconds": round(self.walked, 3), "distance_m": round(float(self.distance), 3),
            "fell": self.fallen, "damped": self.damped >= DAMPED, "commands": self.heard, "ignored": self.ignored,
        }

    def obey(self):
        """Takes a command, if there is a new one."""
        command = newest(self.commands)
        if command is None:
            return False
        if not crc.is_intact(command, crc.LOW_CMD) or command.mode_machine != MODE_MACHINE:
            self.ignored += 1
            return False
        self.heard, self.last_command = self.heard + 1, time.monotonic()
        motors = [command.motor_cmd[i] for i in self.motors.driven]
        on = np.array([motor.mode == 1 for motor in motors])
        target, kp, kd = (np.array([getattr(motor, part) for motor in motors]) for part in ("q", "kp", "kd"))
        push = np.array([motor.tau + motor.kd * motor.dq for motor in motors])
        model = self.robot.model
        self.robot.data.ctrl[:] = target
        model.actuator_gainprm[:, 0] = on * kp
        model.actuator_biasprm[:, :3] = on[:, None] * np.stack([push, -kp, -kd], axis=1)
        self._notice(target, kp)
        return True

    def _notice(self, target, kp):
        """Whether it is damped, ready, or walks."""
        self.moved |= bool(kp.any())
        self.damped = 0 if kp.any() else self.damped + 1
        stands = np.allclose(target, self.robot.default, atol=1e-3) and np.allclose(kp, self.robot.kp)
        if self.held and self.ready and not stands and kp.any():
            self.held = False
            print("the gantry lets go", flush=True)
        self.ready |= stands

    def advance(self, seconds):
        """Physics; on the gantry the pelvis stays where it is."""
        import mujoco

        robot = self.robot
        for _ in range(round(seconds / robot.model.opt.timestep)):
            if self.held:
                robot.position[:], robot.orientation[:] = [0, 0, robot.standing_height], [1, 0, 0, 0]
                robot.data.qvel[robot.base_v : robot.base_v + 6] = 0
            mujoco.mj_step(robot.model, robot.data)
        self.tick += round(1000 * seconds)
        walks = not self.held and self.damped == 0
        if walks:
            self.walked += seconds
            self.distance = np.hypot(*robot.position[:2])
        if walks and self.fallen is None and robot.has_fallen(self.policy.description["task"]):
            self.fallen = round(self.walked, 3)
            print(f"fallen after {self.walked:.2f} s", flush=True)

    def publish(self):
        """Odometry and a state, as its faults have them."""
        robot, state = self.robot, low_state(MODE_MACHINE)
        state.tick = self.tick
        state.imu_state.quaternion, state.imu_state.gyroscope = robot.orientation.tolist(), robot.turning.tolist()
        force = robot.data.actuator_force
        for i, motor in enumerate(self.motors.driven):
            told = state.motor_state[motor]
            told.q, told.dq = float(robot.data.qpos[robot.q[i]]), float(robot.data.qvel[robot.v[i]])
            told.tau_est = float(force[i])
        state.wireless_remote = self._remote()
        for fault, after in self.faults:
            if not self.held and self.walked >= after:
                fault(self, state)
        if self.muted:
            return
        if self.frozen:
            state.tick = self.frozen
        self.odometry.write(odometry(robot.position.tolist(), robot.velocity.tolist()))
        self.states.write(crc.sealed(state, crc.LOW_STATE))
        if self.lies:
            lie = copy.deepcopy(state)
            lie.tick += 1
            lying(lie)
            self.states.write(lie)

    def _remote(self):
        """What the operator presses: L1, again and again until the robot moves, and START until it walks."""
        if self.given.remote is None or self.walked >= self.given.walk:
            return remote_bytes([])
        # By commands, soon after a controller is heard; by time for one that says nothing.
        presses = self.heard % 16 >= 4 if self.heard else self.tick % 1200 < 1000
        keys = ["L1"] if self.moved or presses else []
        keys += ["start"] if self.held and self.ready and self.tick % 200 < 100 else []
        return remote_bytes(keys, **sticks(self.given.remote, self.ranges))


def _sessions(text):
    """Faults and when they begin, s of walking, for each controller that comes."""
    if text is None:
        return [[]]
    try:
        return [[_fault(part) for part in session.split("+")] for session in text.split(",")]
    except (KeyError, ValueError):
        raise RobotError(
            f"--fault {text}: give NAME@SECONDS, NAME of {', '.join(FAULTS)}; + for several, a comma for the next controller"
        ) from None


def _fault(text):
    name, _, seconds = text.partition("@")
    return FAULTS[name], float(seconds)
