"""The table that `sim2sim.py` prints: one list of columns makes headings, units and numbers alike."""


def _numbers(numbers):
    # No negative zeros.
    return " ".join(f"{round(number, 2) + 0.0:5.2f}" for number in numbers)


def _figure(name, digits, unit=1):
    """A figure by its name; a dash where it is not measured."""
    return lambda row: "-" if row.get(name) is None else f"{unit * row[name]:.{digits}f}"


def _worst(row):
    """The joint that gives all it has most often, and its share of the steps."""
    joint = row.get("saturated_joint")
    if joint is None:
        return "-"
    return f"{joint.removesuffix('_joint')} {100 * row['saturated_shares'][joint]:.1f}"


STRESS = ("stress", "-", lambda row: row["stress"])

# Heading, unit, and how a row of `transfer.episodes.figures` fills it.
COLUMNS = [
    ("asked", "m/s, m/s, rad/s", lambda row: _numbers(row["command"])),
    ("survival", "%", _figure("survival", 1, 100)),
    ("upright", "s", _figure("seconds_survived", 2)),
    ("rmse", "m/s", _figure("rmse", 3)),
    ("settled", "m/s", _figure("rmse_settled", 3)),
    ("off", "m/s", _figure("off", 3)),
    ("yaw", "rad/s", _figure("rmse_yaw_rate", 3)),
    ("norm.err", "%", _figure("normalized_error", 1, 100)),
    ("energy", "J/step", _figure("energy_per_step_j", 2)),
    ("transport", "1", _figure("cost_of_transport", 2)),
    ("stride", "Hz", _figure("stride_rate_hz", 2)),
    ("duty", "1", _figure("duty_factor", 2)),
    ("double", "%", _figure("double_support", 1, 100)),
    ("flight", "%", _figure("flight_share", 1, 100)),
    ("clear", "cm", _figure("foot_clearance", 1, 100)),
    ("slip", "cm/stride", _figure("slip_per_stride", 1, 100)),
    ("arms", "°", _figure("arm_swing_deg", 1)),
    ("lean", "°", _figure("trunk_lean_deg", 1)),
    ("saturated", "%", _figure("torque_saturated_share", 1, 100)),
    ("worst joint", "%", _worst),
    ("sole", "weights", _figure("sole_force_peak_weights", 2)),
    ("rate", "1/step", _figure("action_rate", 3)),
    ("mean velocity", "m/s, m/s, rad/s", lambda row: _numbers([*row["velocity"], row["yaw_rate"]])),
]

LEGEND = """\
columns, over all steps of robots on their feet, as in `ampco evaluate`:
  survival       episodes that had all their time; upright: mean time to the fall or the end
  rmse           of the planar velocity, step by step; settled: without the two seconds after a start or a new command
  off            mean velocity of settled robots over whole strides, off the command
  yaw            root mean squared error of the yaw rate
  norm.err       of the mean velocity, as a share of the command
  energy         positive mechanical work of the motors; transport: the same per weight and way
  stride         landings of one foot; duty: time that a foot is down (more than 20 N); double: both; flight: none
  clear          mean height of a foot's sole in swing; slip: way of a foot on the ground
  arms           how far a shoulder swings in a stride, from end to end; lean: mean angle of the trunk to the vertical
  saturated      steps in which some joint gives all the torque it has; worst joint: the one that does so most often
  sole           greatest force of the floor on one foot in any physics step, in body weights
  rate           mean change of an action from step to step"""


def table(label, rows):
    """A label, headings, units and a line per row, every column as wide as its widest cell."""
    columns = [STRESS, *COLUMNS] if any("stress" in row for row in rows) else COLUMNS
    lines = [[name for name, _, _ in columns], [unit for _, unit, _ in columns]]
    lines += [[value(row) for _, _, value in columns] for row in rows]
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    text = [f"{label}"]
    text += ["  " + "  ".join(cell.rjust(width) for cell, width in zip(line, widths, strict=True)) for line in lines]
    return "\n".join(text)
