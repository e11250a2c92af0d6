"""Tests of messages, checksums and the remote: `AMPCO_EXPORT=DIR python -m unittest robot.test_messages` in deploy/."""

import struct
import unittest

from . import crc
from .messages import low_cmd, low_state
from .state import KEYS, State, remote, remote_bytes


class Checksum(unittest.TestCase):
    def test_by_hand(self):
        # All ones against all ones leave nothing to divide.
        self.assertEqual(crc.crc32(b"\xff\xff\xff\xff"), 0)
        # One bit is left, the lowest of the word: after 32 shifts it is the polynomial.
        self.assertEqual(crc.crc32(b"\xfe\xff\xff\xff"), 0x04C11DB7)
        # The second lowest: the polynomial shifted once, whose highest bit is 0.
        self.assertEqual(crc.crc32(b"\xfd\xff\xff\xff"), 0x09823B6E)

    def test_the_published_check_value(self):
        # By long division, which the value that catalogues give for "123456789" vouches for.
        def divided(data):
            rest = 0xFFFFFFFF
            for byte in data:
                rest ^= byte << 24
                for _ in range(8):
                    rest = (rest << 1 ^ (0x04C11DB7 if rest >> 31 else 0)) & 0xFFFFFFFF
            return rest

        self.assertEqual(divided(b"123456789"), 0x0376E6E7)
        # In memory a word's lowest byte comes first.
        self.assertEqual(crc.crc32(b"43218765"), divided(b"12345678"))

    def test_structs_are_as_long_as_in_c(self):
        # 35 motors of 28 bytes, four of head, 20 of tail; 35 of 56 bytes, 16 and 56 before them, 60 behind.
        self.assertEqual(struct.calcsize(crc.LOW_CMD), 4 + 35 * 28 + 20)
        self.assertEqual(struct.calcsize(crc.LOW_STATE), 16 + 56 + 35 * 56 + 60)

    def test_any_change_is_noticed_after_a_journey_too(self):
        for message, layout in ((low_cmd(4), crc.LOW_CMD), (low_state(4), crc.LOW_STATE)):
            kind = type(message)
            arrived = kind.deserialize(crc.sealed(message, layout).serialize())
            self.assertTrue(crc.is_intact(arrived, layout))
            arrived.mode_machine = 5
            self.assertFalse(crc.is_intact(arrived, layout))
        arrived.mode_machine = 4
        self.assertTrue(crc.is_intact(arrived, layout))
        arrived.motor_state[28].temperature[1] += 1
        self.assertFalse(crc.is_intact(arrived, layout))


class Names(unittest.TestCase):
    def test_types_are_called_as_on_the_robot(self):
        self.assertEqual(type(low_cmd(4)).__idl_typename__, "unitree_hg.msg.dds_.LowCmd_")
        self.assertEqual(type(low_state(4)).__idl_typename__, "unitree_hg.msg.dds_.LowState_")

    def test_a_state_is_as_long_on_the_wire_as_it_has_to_be(self):
        # As in C, but the first motor follows the IMU's last two bytes; four bytes of encoding are before.
        self.assertEqual(len(low_state(4).serialize()), 4 + 2092 - 4)


class Told(unittest.TestCase):
    def test_the_remote(self):
        # Two bytes of head, keys, then lx, rx, ry, L2, ly.
        data = bytes(2) + struct.pack("<H5f", 1 << 1 | 1 << 2, 0.5, -0.25, 0.75, 9.0, 1.0) + bytes(16)
        told = remote(data)
        self.assertEqual(told, (KEYS["L1"] | KEYS["start"], 0.5, -0.25, 0.75, 1.0))
        self.assertEqual(remote(remote_bytes(["L1", "start"], 0.5, -0.25, 0.75, 1.0)), told)
        # What is no stick's position is none.
        self.assertEqual(remote(struct.pack("<2xH5f16x", 0, float("nan"), 2.0, 0.0, 0.0, -7.0))[1:], (0, 0, 0, 0))

    def test_of_two_temperatures_the_hotter_counts(self):
        message = low_state(4)
        message.motor_state[3].temperature = [50, 120]
        self.assertEqual(State(message, 0.0).temperature[3], 120)

    def test_gravity_and_tilt(self):
        message = low_state(4)
        # 90° about x brings the left, +y, up: down is −y.
        message.imu_state.quaternion = [0.5**0.5, 0.5**0.5, 0.0, 0.0]
        state = State(message, 0.0)
        for told, expected in zip(state.gravity(), (0.0, -1.0, 0.0), strict=True):
            self.assertAlmostEqual(told, expected)
        self.assertAlmostEqual(state.tilt(), 1.5707963)


if __name__ == "__main__":
    unittest.main()
