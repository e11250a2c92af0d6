"""Stresses: what a real robot and a real floor do to a policy, each one number and one small function of a robot.

Every robot draws from a generator of its own for every stress, so that a stress does the same alone and among others.
Weaker and stronger: a value stands between its neutral one, which changes nothing, and its default.
"""

import math
from dataclasses import dataclass
from typing import Callable

import numpy as np

# The height field in the model, and the distance of its points, m.
BUMPS, BUMPS_GRID = "stress of bumps", 0.2
PUSH_SECONDS = 0.05
PUSH_EVERY = (3.0, 5.0)
# Around the start the floor is level, m.
LEVEL = 0.4
TURN_OF_COMMANDS = 0.5
# Where uphill is, by the episode; robots start facing (1, 0).
SLOPES = [(1, 0), (-1, 0), (0, 1), (0, -1)]


def delay(robot, milliseconds, _):
    """An action reaches the motors later, by whole physics steps."""
    robot.delay = round(milliseconds / 1000 / robot.model.opt.timestep)


def gains(robot, factor, _):
    """Both of a motor's gains."""
    robot.kp, robot.kd = robot.kp * factor, robot.kd * factor
    robot.model.actuator_gainprm[:, 0] *= factor
    robot.model.actuator_biasprm[:, 1:3] *= factor


def strength(robot, factor, _):
    """The greatest torque of every motor."""
    robot.effort = robot.effort * factor
    robot.model.actuator_forcerange[:, 1] = robot.effort
    robot.model.actuator_forcerange[:, 0] = -robot.effort


def payload(robot, mass, _):
    """A point at the torso's centre of mass."""
    robot.load(mass)


def friction(robot, coefficient, _):
    """Sliding friction of floor and feet."""
    robot.feet.set_friction(coefficient)


def slope(robot, degrees, _):
    """Gravity is turned, the floor stays level: uphill ahead, behind, to the left or to the right of the start."""
    uphill = np.array(SLOPES[robot.index % len(SLOPES)])
    size, angle = np.linalg.norm(robot.model.opt.gravity), math.radians(degrees)
    robot.model.opt.gravity[:2] = -size * math.sin(angle) * uphill
    robot.model.opt.gravity[2] = -size * math.cos(angle)


def bumps(robot, centimetres, random):
    """Heights at every 20 cm, drawn between the floor and the peak, straight lines between them."""
    field = robot.model.hfield(BUMPS)
    heights = random.uniform(size=(field.nrow[0], field.ncol[0]))
    around = (np.arange(field.nrow[0]) - field.nrow[0] // 2) * BUMPS_GRID
    heights[np.hypot(*np.meshgrid(around, around)) <= LEVEL + BUMPS_GRID] = 0.0
    field.size[2] = centimetres / 100
    field.data[:] = heights


def push(robot, newtons, random):
    """On the trunk for 50 ms, every 3 to 5 s, in any horizontal direction."""
    per_second = 1 / robot.model.opt.timestep
    length = round(PUSH_SECONDS * per_second)
    left = {"rest": 0, "push": 0}

    def draw():
        left["rest"], left["push"] = round(random.uniform(*PUSH_EVERY) * per_second), length
        way = random.uniform(0, 2 * math.pi)
        left["force"] = newtons * np.array([math.cos(way), math.sin(way), 0.0])

    def act():
        pushes = left["rest"] == 0
        robot.data.xfrc_applied[robot.torso, :3] = left["force"] if pushes else 0.0
        left["push" if pushes else "rest"] -= 1
        if left["push"] == 0:
            draw()

    draw()
    robot.each_substep.append(act)


def encoder(robot, radians, random):
    """Every joint reads too much or too little, the same all the time; its motor is misled with it."""
    robot.encoder = random.uniform(-radians, radians, robot.joints)


def imu(robot, degrees, random):
    """It is mounted aslant, about any horizontal axis: gravity and angular velocity are told turned."""
    way, angle = random.uniform(0, 2 * math.pi), math.radians(degrees)
    x, y = math.cos(way), math.sin(way)
    across = np.array([[0, 0, y], [0, 0, -x], [-y, x, 0]])
    # Rodrigues' formula.
    robot.imu = np.eye(3) + math.sin(angle) * across + (1 - math.cos(angle)) * across @ across


def dry(robot, torque, _):
    """Dry friction in every joint, besides what the model has."""
    robot.model.dof_frictionloss[robot.v] += torque


def velocity(robot, share, _):
    """This share of the pelvis' velocity is told, and of its height above that of standing; 0 withholds both."""
    robot.told = share


def commands(robot, seconds, random):
    """Another command every so often: a share of the one asked for, and up to 0.5 rad/s beside its turn."""
    asked, hz = robot.command.copy(), robot.policy.description["control"]["policy_hz"]
    least, most = robot.policy.taught("yaw_rate")
    every, past = max(1, round(seconds * hz)), {"steps": 0}

    def act():
        if past["steps"] > 0 and past["steps"] % every == 0:
            turn = asked[2] + random.uniform(-TURN_OF_COMMANDS, TURN_OF_COMMANDS)
            # No turn that it was never taught, unless it is asked for.
            turn = np.clip(turn, min(least, asked[2]), max(most, asked[2]))
            robot.command = np.array([*(random.uniform() * asked[:2]), turn])
        past["steps"] += 1

    robot.each_step.append(act)


@dataclass(frozen=True)
class Stress:
    """`apply(robot, value, random)`; `neutral` changes nothing; values lie from `least` to `most`."""

    apply: Callable
    unit: str
    default: float
    neutral: float
    least: float
    most: float
    help: str

    @property
    def name(self):
        return self.apply.__name__

    def half(self):
        """The value of half strength; what comes every so often comes half as often."""
        return 2 * self.default if math.isinf(self.neutral) else (self.default + self.neutral) / 2


STRESSES = {stress.name: stress for stress in [
    Stress(delay, "ms", 20, 0, 0, 1000, "actions reach the motors later"),
    Stress(gains, "times", 0.8, 1, 0.01, 10, "both gains of the motors"),
    Stress(strength, "times", 0.9, 1, 0.01, 10, "greatest torque of the motors"),
    Stress(payload, "kg", 4, 0, 0, 100, "at the torso's centre of mass"),
    Stress(friction, "", 0.3, 1, 0, 10, "sliding friction of floor and feet"),
    Stress(slope, "degrees", 5, 0, 0, 45, "gravity is turned: episodes go up, down, across to either side, in turn"),
    Stress(bumps, "cm", 2, 0, 0, 50, "a height field, from valley to peak, a point every 20 cm"),
    Stress(push, "N", 250, 0, 0, 10000, "on the trunk for 50 ms, every 3 to 5 s, in any horizontal direction"),
    Stress(encoder, "rad", 0.02, 0, 0, 1, "joints read wrong by up to this, each by its own"),
    Stress(imu, "degrees", 2, 0, 0, 45, "the IMU is mounted aslant, about any horizontal axis"),
    Stress(dry, "N·m", 1, 0, 0, 100, "dry friction in every joint, besides the model's"),
    Stress(velocity, "share", 0, 1, 0, 10, "of the pelvis' velocity and change of height that the policy is told"),
    Stress(commands, "s", 2, math.inf, 0.02, 3600, "another command as often: less of it, and ±0.5 rad/s"),
]}


def apply(robot, stresses, seed):
    """Stresses, as pairs of name and value, upon a robot with a model of its own; `robot.index` is its episode."""
    for place, name in enumerate(STRESSES):
        for chosen, value in stresses:
            if chosen == name:
                STRESSES[name].apply(robot, value, np.random.default_rng([seed, robot.index, place]))


def height_of_bumps(stresses):
    """For `model.load`, m."""
    return next((value / 100 for name, value in stresses if name == "bumps"), 0.0)
