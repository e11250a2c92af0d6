"""Deadlines: when the next control step is due, and how often one came late."""

import time


class Pace:
    """Steps of `period` s. One that ends after the next was due is a missed deadline."""

    def __init__(self, period, clock=time.monotonic, sleep=time.sleep):
        self._period, self._clock, self._sleep = period, clock, sleep
        self._due = None
        self.steps, self.missed, self.worst = 0, 0, 0.0

    def wait(self):
        """Until the next step is due; says how late it is, s."""
        now = self._clock()
        if self._due is None:
            self._due = now
            return 0.0
        self._due += self._period
        self.steps += 1
        late = now - self._due
        if late <= 0:
            self._sleep(-late)
            return 0.0
        self.missed += 1
        self.worst = max(self.worst, late)
        # What is lost is not made up for: commands in a row would say what is over.
        self._due = now
        return late

    def said(self):
        """In words."""
        if self.missed == 0:
            return f"{self.steps} steps, no deadline missed"
        return f"{self.steps} steps, {self.missed} deadlines missed, the worst by {1000 * self.worst:.1f} ms"
