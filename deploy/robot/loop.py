"""The loop of a controller: a state in, checks, a command out, on a deadline; and damping at its end, whatever ends it."""

import signal
import time

import numpy as np

from . import safety
from .control import Stop
from .pace import Pace

LISTEN = 0.5  # s, before anything is sent
FIRST = 5.0  # s that the first state may take
DAMPED = 2.0  # s of damping at the end
ENDS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class Loop:
    """One run of `controller` on `bus`. `tell` takes lines and never waits."""

    def __init__(self, bus, controller, motors, operator, limits, period, tell):
        self._bus, self._controller, self._motors, self._operator = bus, controller, motors, operator
        self._limits, self._period, self._tell = limits, period, tell
        self._pace = Pace(period)
        self._signal = None
        self._last = None  # the newest state
        self._sent, self._skipped, self._warned = 0, 0, False

    def run(self):
        """Until somebody or something ends it; gives the exit status."""
        before = {number: signal.signal(number, self._hear) for number in ENDS}
        try:
            self._listen()
            while True:
                late = self._pace.wait()
                if late > self._limits.silence:
                    raise Stop(f"late: no command for {1000 * late:.0f} ms, limit {1000 * self._limits.silence:.0f} ms")
                self._step()
        except Stop as stop:
            self._tell(f"stop: {stop}")
            code = stop.code
        except Exception as problem:
            self._tell(f"stop: {type(problem).__name__}: {problem}")
            code = 1
        try:
            self._damp()
        finally:
            for number, handler in before.items():
                signal.signal(number, handler)
        self._tell(self._pace.said() + self._counted())
        return code

    def _hear(self, number, _):
        self._signal = number

    def _listen(self):
        """Waits for a state, and whether somebody else commands the robot."""
        began = time.monotonic()
        # Whoever commanded before this is of no matter.
        self._bus.has_rival()
        self._tell(f"listening: {self._bus.place}")
        while self._last is None or time.monotonic() < began + LISTEN:
            self._check_ends()
            self._last = self._bus.state() or self._last
            if self._last is None and time.monotonic() > began + FIRST:
                damaged = f"; {self._bus.damaged} came with a wrong checksum" if self._bus.damaged else ""
                raise Stop(
                    f"no {self._bus.awaited} for {FIRST:g} s on {self._bus.place}{damaged}: is the robot on, and is this its network?"
                )
            time.sleep(self._period)
        self._tell(f"robot: mode_machine {self._last.mode_machine}")
        self._tell(self._operator.help)
        self._said(self._controller.phase)

    def _check_ends(self):
        if self._signal is not None:
            raise Stop(f"signal {signal.Signals(self._signal).name}", 128 + self._signal)
        if self._bus.has_rival():
            raise Stop("another program sends rt/lowcmd: end it, or put the robot into its debug mode")

    def _step(self):
        self._check_ends()
        state = self._bus.state()
        now = time.monotonic()
        if state is None:
            self._skipped += 1
            found = safety.silence(now, self._last.time, self._limits, self._bus.awaited)
            if found:
                raise Stop(found)
            # Motors keep what they were told; a policy that sees a state twice sees a robot that stands still.
            return
        self._last = state
        found = safety.fault(state, self._motors, self._limits)
        if found:
            raise Stop(found)
        if state.motor_fault.any() and not self._warned:
            self._warned = True
            at = np.flatnonzero(state.motor_fault)[0]
            self._tell(f"warning: {self._motors.name[at]} reports {state.motor_fault[at]:#x}")
        phase = self._controller.phase
        target, kp, kd = self._controller.act(state, self._operator.wish(state, now))
        self._bus.send(self._motors.command(target, kp, kd, state.mode_machine))
        self._sent += 1
        changed = self._controller.phase != phase
        if changed:
            self._said(self._controller.phase, state)
        if self._bus.is_dry and (changed or self._sent % round(1 / self._period) == 1):
            self._show(state, target, kp, kd)

    def _said(self, phase, state=None):
        words = phase
        if phase == "ready" and state is not None:
            off = np.abs(state.position - self._motors.default)
            words += f": {self._motors.name[off.argmax()]} is {off.max():.2f} rad from the default pose, the others less"
        self._tell(words)

    def _show(self, state, target, kp, kd):
        """What a dry run would have sent."""
        torque = self._motors.torque(target, kp, kd, state)
        at = np.abs(torque).argmax()
        self._tell(f"{self._controller.phase}: command {np.round(self._controller.command, 2).tolist()}, most torque "
                   f"{torque[at]:.1f} N·m at {self._motors.name[at]}")
        for name, *numbers in zip(self._motors.name, target, kp, kd, strict=True):
            self._tell("  {:22} q {:7.3f}  kp {:5.1f}  kd {:4.1f}".format(name, *numbers))

    def _damp(self):
        """The robot sinks down, whatever has happened; where nothing was sent, nothing is."""
        if self._sent == 0:
            return
        self._tell(f"damping for {DAMPED:g} s")
        command = self._motors.damping(self._last.mode_machine)
        for _ in range(round(DAMPED / self._period)):
            try:
                self._bus.send(command)
            except Exception as problem:
                self._tell(f"damping could not be sent: {problem}")
            time.sleep(self._period)

    def _counted(self):
        words = f"; {self._skipped} without a new state" if self._skipped else ""
        return words + (f"; {self._bus.damaged} states with a wrong checksum ignored" if self._bus.damaged else "")
