"""Tests of which state counts as new: `python -m unittest robot.test_bus` in deploy/. No network."""

import time
import unittest

from . import crc
from .bus import STALE, Bus
from .messages import low_state, odometry


class Reader:
    """Gives what lies in `waiting`, once."""

    def __init__(self):
        self.waiting = []

    def take(self, N):
        taken, self.waiting = self.waiting, []
        return taken


def state(tick, intact=True):
    message = low_state(4)
    message.tick = tick
    crc.sealed(message, crc.LOW_STATE)
    message.crc ^= not intact
    return message


class States(unittest.TestCase):
    def bus(self, any_checksum=False, simulator=False):
        bus = Bus.__new__(Bus)
        bus._states, bus._odometry = Reader(), Reader() if simulator else None
        bus._any_checksum, bus._pelvis, bus._told, bus._tick, bus.damaged = any_checksum, None, -STALE, None, 0
        return bus

    def ticks(self, bus, *groups):
        """Of the state that is found after each group of messages."""
        found = []
        for group in groups:
            bus._states.waiting = list(group)
            new = bus.state()
            found.append(new and new.tick)
        return found

    def test_the_newest_intact_one_counts(self):
        bus = self.bus()
        groups = [state(1), state(2)], [state(3), state(4, intact=False)], [state(5, intact=False)], []
        self.assertEqual(self.ticks(bus, *groups), [2, 3, None, None])
        self.assertEqual(bus.damaged, 2)

    def test_a_tick_that_stands_still_is_not_new_unless_nobody_counts(self):
        self.assertEqual(self.ticks(self.bus(), [state(7)], [state(7)], [state(8)]), [7, None, 8])
        self.assertEqual(self.ticks(self.bus(), [state(0)], [state(0)]), [0, 0])

    def test_checksums_can_be_left_out(self):
        bus = self.bus(any_checksum=True)
        self.assertEqual(self.ticks(bus, [state(1, intact=False)]), [1])
        self.assertEqual(bus.damaged, 0)

    def test_with_a_simulator_there_is_no_state_without_fresh_odometry(self):
        bus = self.bus(simulator=True)
        self.assertEqual(self.ticks(bus, [state(1)]), [None])
        bus._odometry.waiting = [odometry([1.0, 2.0, 0.75], [0.5, 0.0, 0.0])]
        bus._states.waiting = [state(2)]
        position, velocity = bus.state().pelvis
        self.assertEqual((position.tolist(), velocity.tolist()), ([1.0, 2.0, 0.75], [0.5, 0.0, 0.0]))
        # It has said nothing since.
        bus._told = time.monotonic() - 2 * STALE
        self.assertEqual(self.ticks(bus, [state(3)]), [None])


if __name__ == "__main__":
    unittest.main()
