"""The checksum that closes a LowCmd and a LowState, as unitree_sdk2 computes it over the struct in memory.

CRC-32 with the polynomial 0x04C11DB7, begun with all ones, neither reflected nor inverted (known as CRC-32/MPEG-2), over
32-bit words, the highest bit of each first; the last word, which is the checksum itself, is left out. Fill bytes of
the struct are 0.
"""

import struct
import zlib
from dataclasses import is_dataclass

import numpy as np

# The structs as C lays them out; "0I" aligns to a word.
LOW_CMD = "@2B" + "0IB5fI" * 35 + "5I"
LOW_STATE = "@2I2BI13fh" + "0IB4f2hf7I" * 35 + "40B5I"

_REVERSED = bytes(int(f"{byte:08b}"[::-1], 2) for byte in range(256))


def crc32(words):
    """Of bytes, a multiple of four of them, as the words that a little-endian machine reads there."""
    # zlib's CRC has the same polynomial, begun alike, but is reflected and inverted: so are bits before and after it.
    high_first = np.frombuffer(words, dtype="<u4").astype(">u4").tobytes()
    reflected = zlib.crc32(high_first.translate(_REVERSED)) ^ 0xFFFFFFFF
    return int(f"{reflected:032b}"[::-1], 2)


def checksum(message, layout):
    """Of a message whose struct is laid out so."""
    return crc32(struct.pack(layout, *_numbers(message))[:-4])


def sealed(message, layout):
    """The message, its checksum set."""
    message.crc = checksum(message, layout)
    return message


def is_intact(message, layout):
    """Whether its checksum is right."""
    return message.crc == checksum(message, layout)


def _numbers(message):
    """All numbers of a message in order."""
    numbers = []
    # A message that was received has more attributes than these.
    for name in message.__dataclass_fields__:
        part = getattr(message, name)
        if isinstance(part, (int, float)):
            numbers.append(part)
        elif is_dataclass(part):
            numbers += _numbers(part)
        elif is_dataclass(part[0]):
            for inner in part:
                numbers += _numbers(inner)
        else:
            numbers += part
    return numbers
