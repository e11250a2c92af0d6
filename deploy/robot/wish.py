"""What the operator wants, told by Unitree's remote or by a keyboard; in both a key has to be held for anything to move."""

import os
import select
import sys
import termios
import tty
from collections import namedtuple

import numpy as np

from .error import RobotError
from .state import KEYS

# The dead man's key is held; walking is to begin; forward and leftward velocity (m/s), yaw rate (rad/s).
Wish = namedtuple("Wish", "held go command")

REMOTE_HELP = "remote: press and hold L1 for anything to move, let go to stop; START: walk; left stick: go, right stick: turn"
KEYBOARD_HELP = (
    "keyboard: press and hold space for anything to move, let go to stop; Enter: walk; up, down: faster, slower; left, right: turn; "
    "Q, E: aside to the left, to the right; 0: command nothing"
)
# A held key repeats after half a second at most, and some thirty times a second from then on.
REPEAT = 0.7  # s
STEP = 0.1  # m/s or rad/s, of a key
STEPS = {
    b"\x1b[A": (1, 0, 0), b"\x1b[B": (-1, 0, 0), b"\x1b[D": (0, 0, 1), b"\x1b[C": (0, 0, -1), b"q": (0, 1, 0), b"e": (0, -1, 0),
}


class Remote:
    """Sticks ask for a share of what the policy was taught; `ranges` are least and greatest, a row per part."""

    help = REMOTE_HELP

    def __init__(self, ranges):
        self._least, self._most = ranges.T
        self._started = True

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass

    def wish(self, state, now):
        """Of the remote's bytes in a state."""
        remote = state.remote
        started = bool(remote.keys & KEYS["start"])
        go, self._started = started and not self._started, started
        # To the right is minus in both.
        sticks = np.array([remote.left_y, -remote.left_x, -remote.right_x])
        asked = np.where(sticks >= 0, sticks * self._most, sticks * np.abs(self._least))
        return Wish(bool(remote.keys & KEYS["L1"]), go, np.clip(asked, self._least, self._most))


def sticks(command, ranges):
    """Where the remote's sticks are if this is asked for, as `remote_bytes` takes them."""
    reach = np.where(np.asarray(command) >= 0, ranges[:, 1], np.abs(ranges[:, 0]))
    share = np.divide(command, reach, out=np.zeros(3), where=reach > 0)
    forward, left, turn = np.clip(share, -1.0, 1.0)
    return {"left_y": forward, "left_x": -left, "right_x": -turn}


class Keyboard:
    """Keys of a terminal, or bytes of a pipe; at the end of a pipe every key is released."""

    help = KEYBOARD_HELP

    def __init__(self, ranges, stream=None):
        self._least, self._most = ranges.T
        self._file = (stream or sys.stdin).fileno()
        self._before = None
        self._last = -np.inf
        self._command = np.clip(np.zeros(3), self._least, self._most)

    def __enter__(self):
        if os.isatty(self._file):
            self._before = termios.tcgetattr(self._file)
            # Ctrl-C still ends the program.
            tty.setcbreak(self._file)
        return self

    def __exit__(self, *_):
        if self._before is not None:
            termios.tcsetattr(self._file, termios.TCSADRAIN, self._before)

    def wish(self, state, now):
        """Of the keys that were pressed since the last call."""
        pressed = self._read()
        if pressed:
            self._last = now
        for key, change in STEPS.items():
            moved = self._command + STEP * pressed.lower().count(key.lower()) * np.array(change)
            # No remainders of tenths.
            self._command = np.clip(np.round(moved, 6), self._least, self._most)
        if b"0" in pressed:
            self._command = np.clip(np.zeros(3), self._least, self._most)
        return Wish(now - self._last < REPEAT, b"\n" in pressed or b"\r" in pressed, self._command)

    def _read(self):
        ready, _, _ = select.select([self._file], [], [], 0)
        return os.read(self._file, 1024) if ready else b""


def operator(kind, ranges):
    """`remote` or `keyboard`."""
    if kind == "remote":
        return Remote(ranges)
    if not os.isatty(sys.stdin.fileno()):
        raise RobotError("--operator keyboard reads a terminal, and standard input is none: run it in one")
    return Keyboard(ranges)
