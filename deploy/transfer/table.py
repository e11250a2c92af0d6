"""The table that `sim2sim.py` prints: one list of columns makes headings, units and numbers alike."""


def _numbers(numbers):
    # No negative zeros.
    return " ".join(f"{round(number, 2) + 0.0:5.2f}" for number in numbers)


def _error(row):
    error = row["normalized_error"]
    return "-" if error is None else f"{100 * error:.1f}"


# Heading, unit, and how a row of `transfer.episodes.figures` fills it.
COLUMNS = [
    ("asked", "m/s, m/s, rad/s", lambda row: _numbers(row["command"])),
    ("survival", "%", lambda row: f"{100 * row['survival']:.1f}"),
    ("upright", "s", lambda row: f"{row['seconds_survived']:.2f}"),
    ("rmse", "m/s", lambda row: f"{row['rmse']:.3f}"),
    ("yaw", "rad/s", lambda row: f"{row['rmse_yaw_rate']:.3f}"),
    ("norm.err", "%", _error),
    ("energy", "J/step", lambda row: f"{row['energy_per_step_j']:.2f}"),
    ("mean velocity", "m/s, m/s, rad/s", lambda row: _numbers([*row["velocity"], row["yaw_rate"]])),
]


def table(label, rows):
    """A label, headings, units and a line per row, every column as wide as its widest cell."""
    lines = [[name for name, _, _ in COLUMNS], [unit for _, unit, _ in COLUMNS]]
    lines += [[value(row) for _, _, value in COLUMNS] for row in rows]
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    text = [f"{label}"]
    text += ["  " + "  ".join(cell.rjust(width) for cell, width in zip(line, widths, strict=True)) for line in lines]
    return "\n".join(text)
