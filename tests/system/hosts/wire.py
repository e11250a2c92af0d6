"""A wire between two network interfaces that has a rate, a delay and losses: wire.py MBIT MILLISECONDS LOSS

Makes the interfaces `near` and `wire` and carries packets between them, in both directions alike, until it is killed. Of a
kernel it needs /dev/net/tun, where netem would be a module that few have. What is over 400 ms of the rate is dropped, as by
any router.
"""

import fcntl
import heapq
import os
import random
import select
import struct
import sys
import time

TUNSETIFF, IFF_TUN, IFF_NO_PI = 0x400454CA, 1, 0x1000
QUEUE = 0.4  # s of the rate


def interface(name):
    file = os.open("/dev/net/tun", os.O_RDWR | os.O_NONBLOCK)
    fcntl.ioctl(file, TUNSETIFF, struct.pack("16sH", name, IFF_TUN | IFF_NO_PI))
    return file


def main(rate, delay, loss):
    ends = [interface(b"near"), interface(b"wire")]
    free = [0.0, 0.0]  # when the last packet of a direction has been sent
    due = []  # (when, number, to, packet)
    chance, number = random.Random(1), 0
    while True:
        wait = max(0.0, due[0][0] - time.monotonic()) if due else None
        ready, _, _ = select.select(ends, [], [], wait)
        now = time.monotonic()
        for end in ready:
            way = ends.index(end)
            for _ in range(64):
                try:
                    packet = os.read(end, 65536)
                except BlockingIOError:
                    break
                begins = max(now, free[way])
                if begins - now > QUEUE or chance.random() < loss:
                    continue
                free[way] = begins + len(packet) / rate
                number += 1
                heapq.heappush(due, (free[way] + delay, number, ends[1 - way], packet))
        while due and due[0][0] <= now:
            _, _, to, packet = heapq.heappop(due)
            try:
                os.write(to, packet)
            except OSError:
                pass  # the interface is down: it is lost


if __name__ == "__main__":
    megabits, milliseconds, share = map(float, sys.argv[1:])
    main(megabits * 1e6 / 8, milliseconds / 1e3, share)
