"""Walk in MuJoCo by policy.onnx alone: `python deploy/transfer/alone.py policy.onnx g1.xml 0.5 0 0 [SECONDS]`.

Everything is read from the model's metadata; copy this file to begin a controller of your own.
"""

import sys

import mujoco
import numpy as np
import onnxruntime


def walk(onnx, mjcf, command, seconds=10.0):
    """Seconds on its feet, and mean forward velocity of the second half, m/s."""
    session = onnxruntime.InferenceSession(onnx, providers=["CPUExecutionProvider"])
    told = session.get_modelmeta().custom_metadata_map
    numbers = lambda key: np.array([float(x) for x in told[key].split(",")])
    kp, kd, effort = numbers("joint_stiffness"), numbers("joint_damping"), numbers("joint_effort_limit")
    default, scale = numbers("default_joint_pos"), numbers("action_scale")
    model = mujoco.MjModel.from_xml_path(mjcf)
    joints = [model.joint(name) for name in told["joint_names"].split(",")]
    q, v = [j.qposadr[0] for j in joints], [j.dofadr[0] for j in joints]
    model.actuator_gainprm[:], model.actuator_biasprm[:] = 0, 0  # torques are ours
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    action, past, speeds = np.zeros(len(q)), {}, []

    def seen():
        turn = np.zeros(9)
        mujoco.mju_quat2Mat(turn, data.qpos[3:7])
        to_base = turn.reshape(3, 3).T
        terms = {
            "base_height": data.qpos[2:3],
            "base_lin_vel": to_base @ data.qvel[:3],
            "base_ang_vel": data.qvel[3:6],
            "projected_gravity": to_base @ [0, 0, -1],
            "velocity_commands": np.array(command),
            "joint_pos_rel": data.qpos[q] - default,
            "joint_vel_rel": data.qvel[v],
            "last_action": action,
        }
        row = []
        for name, length, clip, factor in zip(
            told["observation_names"].split(","),
            told["observation_history_lengths"].split(","),
            told["observation_clips"].split(","),
            told["observation_scales"].split(","),
        ):
            now = terms[name] if clip == "none" else np.clip(terms[name], -float(clip), float(clip))
            past[name] = [now * float(factor), *past.get(name, [now * float(factor)] * int(length))][: int(length)]
            row += past[name]  # newest first
        return np.concatenate(row).astype(np.float32)

    for _ in range(round(seconds * float(told["policy_hz"]))):
        action = session.run(None, {"observation": seen()[None]})[0][0]
        for _ in range(round(1 / float(told["policy_hz"]) / model.opt.timestep)):
            torque = kp * (default + scale * action - data.qpos[q]) - kd * data.qvel[v]
            data.qfrc_applied[v] = np.clip(torque, -effort, effort)
            mujoco.mj_step(model, data)
        if data.qpos[2] < 0.5:
            break
        speeds.append(data.qvel[0])
    return data.time, float(np.mean(speeds[len(speeds) // 2 :]))


if __name__ == "__main__":
    print("%.1f s on its feet, %.2f m/s" % walk(*sys.argv[1:3], [float(x) for x in sys.argv[3:6]], *map(float, sys.argv[6:7])))
