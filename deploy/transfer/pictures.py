"""Figure 5 of both simulators, and a strip of images of the walking robot."""

import os
import sys

import numpy as np

COLOURS = ["#4878a8", "#3d8f6a", "#c9882c", "#b5483c", "#7a5aa0", "#5b6675"]


def figure(path, title, series):
    """Energy per step over velocity (Fig. 5): `series` is (label, marker, rows); colours are commands."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    fig, axes = pyplot.subplots(figsize=(7, 4.5), layout="constrained")
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
    fig.savefig(path, dpi=130)
    pyplot.close(fig)


def prepare_rendering():
    """Chooses how MuJoCo draws, before it is imported: without a display by EGL, in software if need be."""
    if "MUJOCO_GL" not in os.environ and sys.platform == "linux" and "DISPLAY" not in os.environ:
        os.environ["MUJOCO_GL"] = "egl"


# A pelvis below this height lies on the floor, m: nothing more is to be seen.
LYING = 0.3


def strip(path, robot, policy, seconds, images):
    """Images at equal times of an episode, side by side, as PNG. Gives when the robot had fallen, s, or nothing."""
    import matplotlib.image
    import mujoco

    hz = policy.description["control"]["policy_hz"]
    poses, fell_at = [], None
    for step in range(round(seconds * hz) + 1):
        poses.append(robot.data.qpos.copy())
        if fell_at is None and robot.has_fallen(policy.description["task"]):
            fell_at = step / hz
        if not robot.data.qpos[2] > LYING:
            break
        robot.step(policy.actions([robot.observe()])[0])
    try:
        renderer = mujoco.Renderer(robot.model, height=400, width=270)
    except Exception as problem:
        raise SystemExit(
            f"sim2sim: MuJoCo cannot draw here ({problem}): install libegl1 and libgl1-mesa-dri, "
            "or libosmesa6 and set MUJOCO_GL=osmesa"
        ) from problem
    camera = mujoco.MjvCamera()
    camera.distance, camera.azimuth, camera.elevation = 2.3, 115, -8
    frames = []
    for moment in np.linspace(0, len(poses) - 1, images).round().astype(int):
        robot.data.qpos[:] = poses[moment]
        mujoco.mj_forward(robot.model, robot.data)
        camera.lookat[:] = [*poses[moment][:2], 0.62]
        renderer.update_scene(robot.data, camera=camera)
        frames.append(renderer.render())
    renderer.close()
    matplotlib.image.imsave(path, np.concatenate(frames, axis=1))
    return fell_at
