"""MuJoCo's part in `ampco bench fidelity`: the same robot through the same cases, and its speed.

    pip install -r deploy/fidelity.txt
    ampco bench fidelity --cases cases.json
    python deploy/fidelity.py cases.json mujoco.json
    ampco bench fidelity --beside mujoco.json

It only simulates. The robot, the cases and the judgement are the program's; all settings of MuJoCo
but the step, the integrator (implicitfast) and the motors' gains are its defaults.
"""

import json
import math
import sys
import time

import mujoco
import numpy as np


class Simulator:
    def __init__(self, document, step, hold):
        self.model = mujoco.MjModel.from_xml_string(document)
        self.step, self.hold = step, hold
        model = self.model
        feet = [model.body("left_ankle_roll_link").id, model.body("right_ankle_roll_link").id]
        self.feet = set(feet)
        self.gravity = model.opt.gravity.copy()
        self.limited = model.jnt_limited.copy()

    def motors(self, gains):
        model = self.model
        kp, kd, effort = (np.array(gains[k]) for k in ("stiffness", "damping", "effort"))
        model.actuator_gainprm[:, 0] = kp
        model.actuator_biasprm[:, 1] = -kp
        model.actuator_biasprm[:, 2] = -kd
        # A range of nothing would be no limit.
        model.actuator_forcerange[:, 0] = -np.maximum(effort, 1e-9)
        model.actuator_forcerange[:, 1] = np.maximum(effort, 1e-9)

    def start(self, state):
        data = mujoco.MjData(self.model)
        i, j, k, w = state["orientation"]
        norm = math.sqrt(w * w + i * i + j * j + k * k)
        data.qpos[:3] = state["position"]
        data.qpos[3:7] = np.array([w, i, j, k]) / norm
        data.qpos[7:] = state["joint_positions"]
        data.qvel[:3] = state["linear_velocity"]
        # MuJoCo has the angular velocity of a free body in its own frame.
        turn = np.zeros(9)
        mujoco.mju_quat2Mat(turn, data.qpos[3:7])
        data.qvel[3:6] = turn.reshape(3, 3).T @ np.array(state["angular_velocity"])
        data.qvel[6:] = state["joint_velocities"]
        return data

    def floor_force(self, data):
        wrench, total = np.zeros(6), 0.0
        for c in range(data.ncon):
            contact = data.contact[c]
            bodies = {int(self.model.geom_bodyid[g]) for g in contact.geom}
            if 0 in bodies and bodies & self.feet:
                mujoco.mj_contactForce(self.model, data, c, wrench)
                total += wrench[0] * contact.frame[2]
        return abs(total)

    def run(self, case, finer):
        model = self.model
        model.opt.timestep = self.step / finer
        self.motors(case["gains"])
        data = self.start(case["start"])
        targets, frames, forces = case["targets"], [], []
        pushes = {push["at"] * self.hold: push["change"] for push in case["pushes"]}
        for step in range(case["steps"]):
            data.ctrl[:] = targets[min(step // self.hold, len(targets) - 1)]
            model.opt.gravity[:] = self.gravity
            if step >= case["pull_from"]:
                model.opt.gravity[:] += case["pull"]
            if step in pushes:
                data.qvel[:3] += pushes[step]
            for _ in range(finer):
                mujoco.mj_step(model, data)
                forces.append(self.floor_force(data))
            if (step + 1) % case["every"] == 0:
                frames.append(
                    {
                        "position": data.qpos[:3].tolist(),
                        "orientation": data.qpos[3:7].tolist(),
                        "joints": data.qpos[7:].tolist(),
                        "peak": max(forces),
                        "force": sum(forces) / len(forces),
                    }
                )
                forces = []
        # MuJoCo begins anew where numbers break, and warns.
        broken = (mujoco.mjtWarning.mjWARN_BADQPOS, mujoco.mjtWarning.mjWARN_BADQVEL,
                  mujoco.mjtWarning.mjWARN_BADQACC)
        sound = bool(np.isfinite(data.qpos).all()) and not any(data.warning[w].number for w in broken)
        return {"case": case["name"], "dt": self.step / finer, "frames": frames, "sound": sound}

    def microseconds(self, case, steps=400, rounds=9):
        """Of one step of a robot that stands, the least of several rounds."""
        self.model.opt.timestep = self.step
        self.motors(case["gains"])
        data = self.start(case["start"])
        data.ctrl[:] = case["targets"][0]
        mujoco.mj_step(self.model, data, nstep=steps)
        times = []
        for _ in range(rounds):
            begun = time.perf_counter()
            mujoco.mj_step(self.model, data, nstep=steps)
            times.append((time.perf_counter() - begun) / steps)
        return 1e6 * min(times)


def main():
    if len(sys.argv) != 3:
        sys.exit("usage: python deploy/fidelity.py CASES.json TRACES.json")
    with open(sys.argv[1]) as file:
        given = json.load(file)
    simulator = Simulator(given["document"], given["step"], given["hold"])
    finer = given["finer"]
    traces = {
        "engine": f"MuJoCo {mujoco.__version__}",
        "coarse": [simulator.run(case, 1) for case in given["cases"]],
        "fine": [simulator.run(case, finer) for case in given["cases"] if case["refined"]],
        "stress": [simulator.run(case, 1) for case in given["stress"]],
    }
    with open(sys.argv[2], "w") as file:
        json.dump(traces, file)
    standing = next(case for case in given["cases"] if case["name"] == "stand")
    print(f"{simulator.microseconds(standing):.1f} µs a step of one standing robot", file=sys.stderr)


if __name__ == "__main__":
    main()
