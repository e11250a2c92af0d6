"""What `python deploy/robot` can be told."""

import argparse
import sys

import numpy as np

from .error import RobotError

ABOUT = """\
Runs an exported policy on Unitree's DDS topics (rt/lowstate, rt/lowcmd), or stands in for the robot.

    python3 -m venv venv && venv/bin/pip install -r deploy/robot/requirements.txt
    target/release/ampco export walk --out walk-policy
    venv/bin/python deploy/robot stand-in walk-policy --remote 0.6,0,0     # a robot in MuJoCo; its remote starts it
    venv/bin/python deploy/robot run walk-policy --interface lo --state-from-simulator

Read deploy/robot/README.md before a robot hears of it."""


def parser():
    """All options."""
    made = argparse.ArgumentParser(
        prog="robot", description=ABOUT, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    kinds = made.add_subparsers(dest="kind", required=True, metavar="run|stand-in")
    run = kinds.add_parser("run", help="the controller")
    add = run.add_argument
    add("policy", help="folder that `ampco export` wrote")
    add("--operator", choices=("remote", "keyboard"), default="remote",
        help="who holds the dead man's key: the robot's remote (L1) or this terminal (space)")
    add("--state-from-simulator", action="store_true",
        help="take height and velocity from a simulator's rt/sportmodestate; a robot has no such sensors")
    add("--any-checksum", action="store_true", help="take states whatever their checksum; some simulators set none")
    add("--dry-run", action="store_true", help="send nothing, print what would be sent")
    add("--stand-seconds", type=number(0.1, 60), default=3.0, help="length of standing up (default: 3)")
    add("--max-tilt", type=number(1, 90), default=57.0, metavar="DEGREES", help="stop beyond this (default: 57)")
    add("--max-temperature", type=number(20, 150), default=90.0, metavar="CELSIUS",
        help="stop where a motor is hotter (default: 90)")
    add("--max-silence", type=number(20, 5000), default=100.0, metavar="MS",
        help="stop without a new state, or a command, for so long (default: 100)")
    stand_in = kinds.add_parser("stand-in", help="a robot in MuJoCo that speaks the same messages")
    add = stand_in.add_argument
    add("policy", help="folder that `ampco export` wrote; its g1.xml is the robot")
    add("--remote", type=command, metavar="VX,VY,WZ", help="its remote holds L1, presses START and asks for this")
    add("--walk", type=number(0.1, 3600), default=5.0, metavar="SECONDS",
        help="the remote lets go of L1 after walking for so long (default: 5)")
    add("--lockstep", action="store_true",
        help="time stands still until a command comes: the same figures on a busy machine; otherwise it runs by the clock")
    add("--fault", metavar="NAME@SECONDS", help="what goes wrong after walking for so long; a+b is both, a,b the one and "
        "then, for the next controller, the other; `--fault help` lists them")
    add("--once", action="store_true", help="end when a controller has come and gone, or one for every fault")
    for part in (run, stand_in):
        part.add_argument("--interface", default="lo", help="network interface (default: lo, this machine)")
        part.add_argument("--domain", type=int, default=0, help="DDS domain (default: 0, which robots use)")
    return made


def number(least, most):
    """A number within these."""

    def checked(text):
        value = float(text)
        if not least <= value <= most:
            raise argparse.ArgumentTypeError(f"{text}: give {least:g} to {most:g}")
        return value

    checked.__name__ = "number"
    return checked


def command(text):
    """Forward and leftward velocity, m/s, and yaw rate, rad/s."""
    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError:
        numbers = []
    if len(numbers) != 3 or not np.isfinite(numbers).all():
        raise argparse.ArgumentTypeError(f"{text!r}: give three numbers, as in 0.5,0,0.5")
    return numbers


def ranges(description, place):
    """Of commands: least and greatest, a row per part."""
    told = description.get("operation", {}).get("commands", {})
    try:
        return np.array([told[part] for part in ("forward", "left", "yaw_rate")], dtype=np.float64)
    except KeyError:
        raise RobotError(f"{place} does not say what the policy may be told: export the run again") from None


def main(arguments=None):
    """Gives the exit status."""
    given = parser().parse_args(arguments)
    try:
        return stand_in(given) if given.kind == "stand-in" else run(given)
    except (RobotError, _export_error()) as problem:
        sys.exit(f"robot: {problem}")


def _export_error():
    from transfer.error import ExportError

    return ExportError


def run(given):
    """The controller."""
    from transfer.policy import Policy

    from . import observation
    from .control import Controller
    from .loop import Loop
    from .motors import Motors
    from .safety import Limits
    from .tell import Teller
    from .wish import operator

    policy = Policy(given.policy)
    place = f"{policy.folder}/policy.json"
    simulated = observation.check(policy, given.state_from_simulator)
    motors = Motors(policy.description, place)
    allowed = ranges(policy.description, place)
    hand = operator(given.operator, allowed)
    from .bus import Bus

    bus = Bus(given.domain, given.interface, bool(simulated), given.any_checksum, given.dry_run)
    limits = Limits(np.radians(given.max_tilt), given.max_temperature, given.max_silence / 1000)
    controller = Controller(policy, motors, observation.Observer(policy, motors), allowed, given.stand_seconds)
    period = 1 / policy.description["control"]["policy_hz"]
    with Teller() as tell, hand:
        tell(f"policy: {policy.title()}{', dry run' if given.dry_run else ''}")
        return Loop(bus, controller, motors, hand, limits, period, tell).run()


def stand_in(given):
    """The robot."""
    if given.fault == "help":
        from .faults import explained

        print(explained())
        return 0
    from .stand_in import StandIn

    return StandIn(given).run()
