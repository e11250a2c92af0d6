"""Lines for people, written by a thread of their own: a terminal that stalls must not stall a robot."""

import os
import queue
import sys
import threading


class Teller:
    """`tell(line)` returns at once. At the end what is left is written, as far as `PATIENCE` s allow."""

    PATIENCE = 2.0

    def __init__(self, stream=None):
        self._stream = stream or sys.stdout
        self._lines = queue.SimpleQueue()
        self._thread = threading.Thread(target=self._write, daemon=True)

    def __enter__(self):
        self._thread.start()
        return self._lines.put

    def __exit__(self, *_):
        self._lines.put(None)
        self._thread.join(self.PATIENCE)

    def _write(self):
        while (line := self._lines.get()) is not None:
            try:
                # Past the stream's buffer, which a write that waits would hold when the program ends.
                os.write(self._stream.fileno(), f"{line}\n".encode())
            except OSError:
                # Nobody reads any more; the robot goes on.
                return
