"""What `--stress` asks for: rows of a table, each a label and the stresses that act at once."""

import re

from .stress import PUSH_EVERY, STRESSES

NONE, ALL, HALF, STANDARD = "none", "all", "half", "standard"


class StressError(Exception):
    """A list of stresses that cannot be read; the message names the part and the remedy."""


def rows(text):
    """Rows of a list as in `delay=20,push,gains=0.8+payload=4`: (label, [(name, value)]), the first without stress."""
    found = [(NONE, [])]
    for part in text.split(","):
        for row in _row(part.strip()):
            if row not in found:
                found.append(row)
    return found


def _row(part):
    if part == NONE:
        return []
    if part == STANDARD:
        singles = [(_label([(name, stress.default)]), [(name, stress.default)]) for name, stress in STRESSES.items()]
        return [*singles, *_row(HALF)]
    if part == ALL:
        return [("all", [(name, stress.default) for name, stress in STRESSES.items()])]
    if part == HALF:
        return [("all, half", [(name, stress.half()) for name, stress in STRESSES.items()])]
    # Not the sign of an exponent.
    stresses = [_one(word.strip(), part) for word in re.split(r"\+(?=[a-z])", part)]
    names = [name for name, _ in stresses]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice:
        raise StressError(f"{part!r} has {twice} twice: give one value")
    return [(_label(stresses), stresses)]


def _one(word, part):
    name, equals, number = word.partition("=")
    if name not in STRESSES:
        words = ", ".join([*STRESSES, STANDARD, ALL, HALF, NONE])
        raise StressError(f"{part!r}: {name!r} is no stress; there are {words} (`--stress help` explains them)")
    stress = STRESSES[name]
    if not equals:
        return name, float(stress.default)
    try:
        value = float(number)
    except ValueError:
        value = float("nan")
    if not stress.least <= value <= stress.most:
        unit = f" {stress.unit}" if stress.unit else ""
        raise StressError(f"{word!r}: give {name} a number from {stress.least:g} to {stress.most:g}{unit}")
    return name, value


def _label(stresses):
    return "+".join(f"{name}={value:g}" for name, value in stresses)


def text(chosen):
    """What `ampco evaluate --stress` reads as these rows; it begins with the one without stress by itself."""
    return ",".join("+".join(f"{name}={value!r}" for name, value in row) for _, row in chosen if row)


def remarks(chosen, terms, timestep, seconds):
    """What of rows comes to something else than it says: `terms` are names that the policy sees; times in s."""
    values = {name: {value for _, row in chosen for stress, value in row if stress == name} for name in STRESSES}
    said = []
    for value in sorted(values["delay"]):
        steps = round(value / 1000 / timestep)
        if abs(value / 1000 / timestep - steps) > 1e-6:
            said.append(f"delay={value:g}: {steps} physics steps of {1000 * timestep:g} ms, {1000 * steps * timestep:g} ms")
    if values["push"] and seconds < PUSH_EVERY[1]:
        said.append(f"push: the first comes after {PUSH_EVERY[0]:g} to {PUSH_EVERY[1]:g} s, episodes last {seconds:g} s")
    if any(value >= seconds for value in values["commands"]):
        said.append(f"commands: the first change comes when episodes of {seconds:g} s are over")
    if values["velocity"] and not {"linear_velocity", "height"} & set(terms):
        said.append("velocity: the policy sees neither velocity nor height of the pelvis, so it changes nothing")
    return said


def explained():
    """What `--stress help` says."""
    lines = [("stress", "default", "unit", "changes nothing at", "what")]
    lines += [
        (name, f"{stress.default:g}", stress.unit, "never" if stress.neutral == float("inf") else f"{stress.neutral:g}",
         stress.help)
        for name, stress in STRESSES.items()
    ]
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    padded = [[cell.ljust(width) for cell, width in zip(line, widths, strict=True)] for line in lines]
    text = "\n".join("  ".join(line).rstrip() for line in padded)
    return f"""{text}

--stress delay,push=300           a row for each, after one without stress; `delay` alone means its default
--stress gains=0.8+payload=4      both at once
--stress standard                 each alone at its default, then all at half strength
--stress all, --stress half       all at once; half is halfway to where a stress changes nothing"""
