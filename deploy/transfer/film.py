"""Pictures of the walking robot: a strip of one stride, and a video."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np

from .measure import CONTACT_FORCE, SETTLING_SECONDS

LYING = 0.3  # A pelvis below this height lies on the floor, m: nothing more is to be seen.
STRIP_SECONDS, IMAGES = 6.0, 10
# Landings that follow each other within less are one foot's patter, s.
SHORTEST_STRIDE = 0.3
FRAMES_PER_SECOND = 25
VIDEO_SECONDS, VIDEO_SIZE = 20.0, (480, 360)


def prepare_rendering():
    """Chooses how MuJoCo draws, before it is imported: without a display by EGL, in software if need be."""
    if "MUJOCO_GL" not in os.environ and sys.platform == "linux" and "DISPLAY" not in os.environ:
        os.environ["MUJOCO_GL"] = "egl"


def walked(robot, policy, seconds):
    """Poses at every control step, forces of the floor on both feet, and when the robot had fallen, s, or nothing."""
    hz = policy.description["control"]["policy_hz"]
    poses, forces, fell_at = [], [], None
    for step in range(round(seconds * hz) + 1):
        poses.append(robot.data.qpos.copy())
        forces.append(robot.feet.forces(robot.data))
        if fell_at is None and robot.has_fallen(policy.description["task"]):
            fell_at = step / hz
        if not robot.height() > LYING:
            break
        for act in robot.each_step:
            act()
        robot.step(policy.actions([robot.observe()])[0])
    return poses, np.array(forces), fell_at


def stride(forces, hz):
    """First and last control step of the first whole stride of a settled robot, between landings of the left foot."""
    down = forces[:, 0] > CONTACT_FORCE
    landings = np.flatnonzero(down[1:] & ~down[:-1]) + 1
    begin = None
    for landing in landings[landings >= SETTLING_SECONDS * hz]:
        if begin is not None and landing - begin >= SHORTEST_STRIDE * hz:
            return int(begin), int(landing)
        begin = landing if begin is None else begin
    return None


def strip(path, robot, policy):
    """Ten images of a stride side by side, as PNG; gives what is to be seen in words."""
    import matplotlib.image

    hz = policy.description["control"]["policy_hz"]
    poses, forces, fell_at = walked(robot, policy, STRIP_SECONDS)
    found = stride(forces, hz) if fell_at is None else None
    begin, end = found or (max(0, len(poses) - 1 - round(hz)), len(poses) - 1)
    moments = np.linspace(begin, end, IMAGES).round().astype(int)
    with Camera(robot, 240, 400) as camera:
        image = np.concatenate([camera.picture(poses[moment]) for moment in moments], axis=1)
    draft = _draft(path)
    matplotlib.image.imsave(draft, image, format="png")
    os.replace(draft, path)
    if fell_at is not None:
        return f"fell after {fell_at:.2f} s; its last second"
    return f"one stride of {(end - begin) / hz:.2f} s" if found else "no whole stride; its last second"


def video(path, robot, policy, seconds):
    """At most 20 s of an episode, as MP4 by ffmpeg or as GIF; gives the file and what is to be seen in words."""
    path = Path(path)
    remark = ""
    if path.suffix == ".mp4" and not shutil.which("ffmpeg"):
        path = path.with_suffix(".gif")
        remark = "; there is no ffmpeg that writes MP4"
    hz = policy.description["control"]["policy_hz"]
    poses, _, fell_at = walked(robot, policy, min(seconds, VIDEO_SECONDS))
    with Camera(robot, *VIDEO_SIZE) as camera:
        images = [camera.picture(pose) for pose in poses[:: max(1, round(hz / FRAMES_PER_SECOND))]]
    draft = _draft(path)
    (_write_mp4 if path.suffix == ".mp4" else _write_gif)(draft, images)
    os.replace(draft, path)
    seen = f"fell after {fell_at:.2f} s" if fell_at is not None else "on its feet"
    return path, f"{(len(poses) - 1) / hz:.1f} s, {seen}{remark}"


def _draft(path):
    """Beside it, so that nobody meets half a file."""
    return f"{path}.{os.getpid()}.new"


def _write_gif(path, images):
    from PIL import Image

    # One palette: drawn for each image anew it would flicker.
    first = Image.fromarray(images[len(images) // 2]).quantize(128)
    frames = [Image.fromarray(image).quantize(palette=first, dither=Image.Dither.NONE) for image in images]
    frames[0].save(
        path, format="GIF", save_all=True, append_images=frames[1:], duration=1000 // FRAMES_PER_SECOND, loop=0
    )


def _write_mp4(path, images):
    height, width = images[0].shape[:2]
    call = ["ffmpeg", "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}",
            "-r", str(FRAMES_PER_SECOND), "-i", "-", "-pix_fmt", "yuv420p", "-f", "mp4", path]
    done = subprocess.run(call, input=b"".join(image.tobytes() for image in images), capture_output=True)
    if done.returncode != 0:
        Path(path).unlink(missing_ok=True)
        words = done.stderr.decode(errors="replace").strip()
        raise SystemExit(f"sim2sim: ffmpeg: {words}: give a name that ends in .gif")


class Camera:
    """Follows the robot from the side; to be closed, for a context of drawing is behind it."""

    def __init__(self, robot, width, height):
        import mujoco

        self.robot, self.mujoco = robot, mujoco
        try:
            self.renderer = mujoco.Renderer(robot.model, height=height, width=width)
        except Exception as problem:
            raise SystemExit(
                f"sim2sim: MuJoCo cannot draw here ({problem}): install libegl1 and libgl1-mesa-dri, "
                "or libosmesa6 and set MUJOCO_GL=osmesa"
            ) from problem
        self.camera = mujoco.MjvCamera()
        self.camera.distance, self.camera.azimuth, self.camera.elevation = 2.3, 115, -8

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.renderer.close()

    def picture(self, pose):
        """Of a pose, height by width by 3 bytes."""
        self.robot.data.qpos[:] = pose
        self.mujoco.mj_forward(self.robot.model, self.robot.data)
        self.camera.lookat[:] = [*self.robot.position[:2], self.robot.feet.ground + 0.62]
        self.renderer.update_scene(self.robot.data, camera=self.camera)
        return self.renderer.render()
