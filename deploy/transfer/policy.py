"""An exported policy: policy.onnx with the description that says how it is to be used."""

import hashlib
import json
from pathlib import Path

import numpy as np
import onnxruntime

from .error import ExportError

VERSION = 3

# Names of terms in descriptions before version 3.
OLDER_NAMES = {"pelvis_height": "height", "projected_gravity": "gravity"}

# What policy.json has to say.
PARTS = ("origin", "network", "control", "joints", "observation", "task", "example")


class Policy:
    """Actions of observations, a row each, and everything in policy.json as `description`."""

    def __init__(self, folder):
        self.folder = Path(folder)
        path = self.folder / "policy.json"
        try:
            self.description = json.loads(path.read_text())
        except FileNotFoundError:
            raise ExportError(f"{path} is not there: write it with `ampco export RUN --out {folder}`") from None
        except ValueError as problem:
            raise ExportError(f"{path} is no JSON ({problem}): export the run again") from None
        if not isinstance(self.description, dict):
            self.description = {}
        if self.description.get("format") != "ampco policy" or self.description.get("version", 0) > VERSION:
            raise ExportError(f"{path} is of another format or a newer version: use the script that came with it")
        missing = [part for part in PARTS if part not in self.description]
        if missing:
            raise ExportError(f"{path} lacks {', '.join(missing)}: export the run again")
        for name, expected in self.description["origin"]["files_sha256"].items():
            try:
                found = hashlib.sha256((self.folder / name).read_bytes()).hexdigest()
            except OSError as problem:
                raise ExportError(f"{self.folder / name}: {problem.strerror}: export the run again") from None
            if found != expected:
                raise ExportError(f"{self.folder / name} is not the file that was exported: export the run again")
        options = onnxruntime.SessionOptions()
        # Small products: more threads only wait for each other.
        options.intra_op_num_threads = 1
        self._session = onnxruntime.InferenceSession(
            str(self.folder / "policy.onnx"), options, providers=["CPUExecutionProvider"]
        )
        self._network = self.description["network"]
        self.check()

    def actions(self, observations):
        """Deterministic actions, float32."""
        inputs = {self._network["input"]: np.asarray(observations, dtype=np.float32)}
        return self._session.run([self._network["output"]], inputs)[0]

    def check(self):
        """Compares this runtime with the one that exported, on the example in the description."""
        example = self.description["example"]
        error = np.abs(self.actions([example["observation"]])[0] - np.float32(example["action"])).max()
        if not error < 1e-5:
            raise ExportError(f"{self.folder}/policy.onnx gives another action than its example, by {error:.2e}")

    def joint(self, field):
        """One number per joint, in the one joint order."""
        return np.array([joint[field] for joint in self.description["joints"]], dtype=np.float64)

    def terms(self):
        """The terms of an observation in order, as of the newest version."""
        terms = []
        for term in self.description["observation"]:
            term = {"past": 0, "noise": 0.0, "clip": None} | term
            terms.append(term | {"name": OLDER_NAMES.get(term["name"], term["name"])})
        return terms

    def title(self):
        """Run and iteration."""
        origin = self.description["origin"]
        return f"{origin['run']}, iteration {origin['iteration']}"

    def taught(self, part):
        """Least and greatest of a part of the commands in training: `forward`, `lateral`, `yaw_rate`."""
        found = self.description["task"].get("command", {}).get(part)
        return tuple(found) if isinstance(found, list) and len(found) == 2 else (0.0, 0.0)
