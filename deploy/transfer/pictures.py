"""Figures: Figure 5 of both simulators, and what stresses do."""

import os
from pathlib import Path

COLOURS = ["#4878a8", "#3d8f6a", "#c9882c", "#b5483c", "#7a5aa0", "#5b6675"]
FORMATS = (".png", ".svg", ".pdf")


def _pyplot():
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    return pyplot


def _save(fig, path):
    # Written beside and renamed, so that a reader never meets half a file.
    draft = f"{path}.{os.getpid()}.new"
    fig.savefig(draft, dpi=130, format=Path(path).suffix[1:].lower())
    os.replace(draft, path)
    _pyplot().close(fig)


def figure(path, title, series):
    """Energy per step over velocity (Fig. 5): `series` is (label, marker, rows); colours are commands."""
    fig, axes = _pyplot().subplots(figsize=(7, 4.5), layout="constrained")
    commands = [row["command"] for row in series[0][2]]
    for i, command in enumerate(commands):
        axes.axvline(command[0], color=COLOURS[i % len(COLOURS)], linestyle="--", linewidth=0.8)
    for label, marker, rows in series:
        for i, row in enumerate(rows):
            # Hollow: no robot was on its feet to the end.
            face = COLOURS[i % len(COLOURS)] if row["survival"] > 0 else "none"
            axes.scatter(
                row["velocity"][0], row["energy_per_step_j"], marker=marker, s=70,
                facecolors=face, edgecolors=COLOURS[i % len(COLOURS)],
            )
        axes.scatter([], [], marker=marker, color="#5b6675", label=label)
    axes.set_xlabel("mean forward velocity, m/s (dashed: asked for)")
    axes.set_ylabel("energy per control step, J")
    axes.set_title(f"{title}\nhollow: every robot fell before the end", fontsize=10)
    axes.set_ylim(0, 1.15 * max(row["energy_per_step_j"] for _, _, rows in series for row in rows))
    axes.legend()
    _save(fig, path)


# Of `stress_figure`: a figure's name in a row, what it is, and how much of it is one unit of the axis.
BARS = [
    ("survival", "survival, %", 100), ("rmse", "error of velocity, m/s", 1),
    ("cost_of_transport", "cost of transport", 1),
]


def stress_figure(path, title, rows):
    """Bars of survival, error and cost by stress, a colour for each command; of what is not measured no bar."""
    labels = list(dict.fromkeys(row["stress"] for row in rows))
    commands = list(dict.fromkeys(tuple(row["command"]) for row in rows))
    thick = 0.8 / len(commands)
    height = 1.2 + 0.32 * len(labels) * max(1, len(commands) / 2)
    fig, all_axes = _pyplot().subplots(1, len(BARS), figsize=(11, height), sharey=True, layout="constrained")
    for axes, (name, words, unit) in zip(all_axes, BARS, strict=True):
        for i, command in enumerate(commands):
            own = {row["stress"]: row[name] for row in rows if tuple(row["command"]) == command}
            axes.barh(
                [at + (i - (len(commands) - 1) / 2) * thick for at in range(len(labels))],
                [unit * (own.get(label) or 0.0) for label in labels], height=0.9 * thick, color=COLOURS[i % len(COLOURS)],
                label=", ".join(f"{part:g}" for part in command),
            )
        axes.set_xlabel(words)
    all_axes[0].set_yticks(range(len(labels)), labels)
    all_axes[0].invert_yaxis()
    handles, words = all_axes[0].get_legend_handles_labels()
    fig.legend(
        handles, words, title="asked, m/s, m/s, rad/s", fontsize=8, title_fontsize=8, ncols=4, loc="outside lower center"
    )
    fig.suptitle(title, fontsize=10)
    _save(fig, path)
