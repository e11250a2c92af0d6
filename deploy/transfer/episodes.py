"""Episodes of one command, measured as `ampco evaluate` measures them.

Figures are means over all steps that robots were on their feet, the step of the fall included.
"""

import numpy as np

from . import stress
from .measure import Record, Step, outcome
from .robot import Robot


# The row of Table I that blurs a term.
SENSORS = {
    "linear_velocity": "linear_velocity_noise",
    "angular_velocity": "angular_velocity_noise",
    "gravity": "gravity_noise",
    "joint_position": "joint_position_noise",
    "joint_angle": "joint_position_noise",
    "joint_velocity": "joint_velocity_noise",
}


class Randomization:
    """Table I: rows of policy.json as draws. Without a table every robot is the nominal one."""

    def __init__(self, table, random):
        self.table, self.random = table, random

    def _uniform(self, row, size=None, key="range"):
        return self.random.uniform(*self.table[row][key], size=size)

    def variation(self):
        """Robot and floor of an episode, or nothing."""
        if self.table is None:
            return None
        return {
            "torso_mass": self._uniform("mass_variation"),
            "torso_com": self._uniform("com_offset", 3),
            "friction": self._uniform("friction"),
        }

    def push_after(self, policy_hz):
        """Control steps until the next push."""
        if self.table is None:
            return np.inf
        return max(1, round(self._uniform("impulse", key="seconds") * policy_hz))

    def push(self):
        """Change of velocity, world frame, m/s."""
        size = self._uniform("impulse", 2) * self.random.choice([-1.0, 1.0], 2)
        return np.array([*size, 0.0])

    def blur(self, term, values):
        """A term's values with sensor noise, drawn anew each step."""
        if self.table is None:
            return values
        row = SENSORS.get(term["name"])
        least, greatest = self.table[row]["range"] if row else (0.0, 0.0)
        noise = term["noise"]
        return values + self.random.uniform(least - noise, greatest + noise, np.shape(values))


def robot_of(model, policy, command, stresses=(), seed=0, index=0, variation=None):
    """A robot that stands, is told `command`, and is stressed as the episode `index` of this seed."""
    robot = Robot(model, policy, variation, own=bool(stresses), index=index)
    robot.command = np.array(command, dtype=np.float64)
    stress.apply(robot, stresses, seed)
    return robot


def walk(model, policy, command, episodes, seconds, randomize, seed, stresses=()):
    """The figures of `episodes` robots that follow `command` from standing, as a dict."""
    random = np.random.default_rng(seed)
    description = policy.description
    table = Randomization(description["randomization"] if randomize else None, random)
    hz = description["control"]["policy_hz"]
    steps = round(seconds * hz)
    robots = [
        robot_of(model, policy, command, stresses, seed, index, table.variation()) for index in range(episodes)
    ]
    for robot in robots:
        robot.perturb(description["task"]["start"], random)
    push_in = [table.push_after(hz) for _ in robots]
    records = [Record(hz) for _ in robots]
    lived = np.full(episodes, steps)
    standing = list(range(episodes))
    for step in range(steps):
        for i in standing:
            for act in robots[i].each_step:
                act()
        seen = [robots[i].observe(table.blur) for i in standing]
        actions = policy.actions(seen)
        for i, action in zip(list(standing), actions):
            robot = robots[i]
            push_in[i] -= 1
            if push_in[i] == 0:
                robot.push(table.push())
                push_in[i] = table.push_after(hz)
            measured = measured_step(robot, action)
            if measured is not None:
                records[i].add(measured)
            if robot.has_fallen(description["task"]):
                lived[i] = step + 1
                standing.remove(i)
        if not standing:
            break
    for record in records:
        record.close()
    total = Record(hz)
    for record in records:
        total.merge(record)
    row = figures(command, {
        "episodes": episodes,
        "survival": len(standing) / episodes,
        "seconds_survived": float(lived.mean() / hz),
        **outcome(total, robots[0].weight(), [joint["name"] for joint in description["joints"]]),
    })
    if any(robot.each_step for robot in robots):
        # Of commands that change the first says nothing about the mean.
        row["normalized_error"] = None
    return row


def measured_step(robot, action):
    """Lets a robot act, and measures it; nothing of a state that is no number."""
    change = np.abs(np.asarray(action, dtype=np.float64) - robot.previous_action).mean()
    work = robot.step(action)
    if not (np.isfinite(robot.data.qpos).all() and np.isfinite(robot.data.qvel).all()):
        return None
    heights, speeds = robot.feet.lowest(robot.data)
    return Step(
        command=robot.command, velocity=np.array([*robot.velocity_in_heading(), robot.yaw_rate()]), work=work,
        forces=robot.feet.forces(robot.data), heights=heights, speeds=speeds, shoulders=robot.shoulders(),
        lean=robot.lean(), saturated=robot.saturated, sole_peak=robot.sole_peak, action_change=change,
    )


def figures(command, row):
    """A row of `walk` or of `ampco evaluate --json` with the two figures that follow from others."""
    asked = np.array(command[:2], dtype=np.float64)
    speed = np.linalg.norm(asked)
    row["command"] = [float(x) for x in command]
    row["energy_per_step_j"] = row["energy_j"] / 1000
    # Deviation of the mean velocity from the command, as a share of it (Section IV-C): of going, not of turning.
    row["normalized_error"] = (
        float(np.linalg.norm(np.array(row["velocity"]) - asked) / speed) if speed > 0 else None
    )
    return row
