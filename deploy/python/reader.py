#!/usr/bin/env python3
"""Prints the reward reports and directives of a running group, from its shared memory.

    python3 -m venv venv && venv/bin/pip install -r deploy/python/requirements.txt
    venv/bin/python deploy/python/reader.py runs/walk

An example to build on: both streams lose their oldest message when a reader is slow, so a reader never holds the run
up. The structures are those of `protocol/src/reward.rs` and `protocol/src/directive.rs`, field by field; the protocol's
version is checked when a stream is opened. Ends with the run: its memory is removed then, and nobody may hold it.
"""

import ctypes
import fcntl
import os
import sys
import time
from pathlib import Path

import iceoryx2 as iox2

PROTOCOL_VERSION = "5"
PHASE_ONE = 2**64 - 1


class RewardReport(ctypes.Structure):
    """Rewards of one iteration's batch, before blending."""

    _fields_ = [
        ("learner", ctypes.c_uint64), ("sequence", ctypes.c_uint64), ("iteration", ctypes.c_uint64),
        ("samples", ctypes.c_uint64), ("style_mean", ctypes.c_double), ("style_std", ctypes.c_double),
        ("style_min", ctypes.c_double), ("style_max", ctypes.c_double), ("task_mean", ctypes.c_double),
        ("task_std", ctypes.c_double), ("episode_share", ctypes.c_double),
    ]

    @staticmethod
    def type_name():
        return "ampco.RewardReport"


class Directive(ctypes.Structure):
    """The scheduler's decision. NaN stands for a number that does not exist yet."""

    _fields_ = [
        ("scheduler", ctypes.c_uint64), ("sequence", ctypes.c_uint64), ("learner", ctypes.c_uint64),
        ("iteration", ctypes.c_uint64), ("switched_at", ctypes.c_uint64), ("phase", ctypes.c_uint32),
        ("rule", ctypes.c_uint32), ("first", ctypes.c_float), ("second", ctypes.c_float),
        ("granularity", ctypes.c_uint32), ("warned", ctypes.c_uint32), ("lower", ctypes.c_double),
        ("upper", ctypes.c_double), ("breakout_rate", ctypes.c_double), ("threshold", ctypes.c_double),
        ("trend", ctypes.c_double), ("decision_seconds", ctypes.c_double),
    ]

    @staticmethod
    def type_name():
        return "ampco.Directive"


RULES = {0: "fixed", 1: "guided", 2: "adamimic", 3: "bounded"}


def root_of(run):
    """Folder of a run's sockets and service files: derived from its path and the user, as every process does it."""
    key = 0xCBF29CE484222325
    for byte in os.fsencode(Path(run).resolve(strict=True)) + os.getuid().to_bytes(4, "little"):
        key = (key ^ byte) * 0x100000001B3 % 2**64
    return Path(f"/tmp/ampco-{os.getuid()}/{key:016x}")


def is_running(run):
    """Whether a learner lives: it holds a lock for as long as it does."""
    try:
        with open(Path(run) / "learner.lock", encoding="utf-8") as file:
            fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
            return False
    except BlockingIOError:
        return True
    except FileNotFoundError:
        return False


class Reader:
    """Both streams of a run. `delete` gives the places back."""

    def __init__(self, run):
        path = iox2.FilePath.new(str(root_of(run) / "iceoryx2.toml"))
        self._config = iox2.config.from_file(path)
        iox2.set_log_level(iox2.LogLevel.Error)
        self._node = (
            iox2.NodeBuilder.new().name(iox2.NodeName.new("reader")).config(self._config)
            .signal_handling_mode(iox2.SignalHandlingMode.Disabled).create(iox2.ServiceType.Ipc)
        )
        self._rewards = self._subscribe("rewards", RewardReport)
        self._directives = self._subscribe("directives", Directive)

    def _subscribe(self, name, kind):
        version = iox2.AttributeVerifier.new().require(
            iox2.AttributeKey.new("ampco.protocol"), iox2.AttributeValue.new(PROTOCOL_VERSION)
        )
        service = (
            self._node.service_builder(iox2.ServiceName.new(name)).publish_subscribe(iox2.Slice[kind])
            .open_with_attributes(version)
        )
        return service.subscriber_builder().create()

    def rewards(self):
        """Reports that came since the last call, oldest first."""
        return self._drain(self._rewards, RewardReport)

    def directives(self):
        """Directives that came since the last call; on the first call the newest, whenever it was sent."""
        return self._drain(self._directives, Directive)

    @staticmethod
    def _drain(subscriber, kind):
        taken = []
        while (sample := subscriber.receive()) is not None:
            # A copy: the sample goes back to the writer.
            taken.append(kind.from_buffer_copy(sample.payload()[0]))
            sample.delete()
        return taken

    def delete(self):
        """Leaves the run."""
        self._rewards.delete()
        self._directives.delete()
        del self._node


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: reader.py RUN_FOLDER")
    run = sys.argv[1]
    if not is_running(run):
        sys.exit(f"reader: no learner is alive in {run}; start one with `ampco train`")
    reader = Reader(run)
    last = None
    while is_running(run):
        for report in reader.rewards():
            if last is not None and report.learner == last.learner and report.sequence > last.sequence + 1:
                print(f"{report.sequence - last.sequence - 1} reports lost")
            last = report
            print(f"iteration {report.iteration}: style {report.style_mean:.3f} ± {report.style_std:.3f}, "
                  f"task {report.task_mean:.3f} over {report.samples} samples", flush=True)
        for directive in reader.directives():
            switched = "" if directive.switched_at == PHASE_ONE else f", switched at {directive.switched_at}"
            print(f"directive for iteration {directive.iteration}: phase {directive.phase}, "
                  f"{RULES.get(directive.rule, directive.rule)} {directive.first:.3f}{switched}", flush=True)
        time.sleep(0.1)
    reader.delete()


if __name__ == "__main__":
    main()
