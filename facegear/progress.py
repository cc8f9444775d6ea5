"""Progress of long stages, with an estimate of the time left."""

import sys
import time
from typing import TextIO


class Progress:
    """Print `label: done/total, about N s left` every `interval` seconds.

    The stream is standard error, which a workflow stage also copies to its log.
    """

    def __init__(self, label: str, total: int, interval: float = 5.0, stream: TextIO | None = None) -> None:
        self.label, self.total, self.interval = label, max(total, 1), interval
        self.stream = stream
        self.done = 0
        self.start = self.last = time.monotonic()

    def step(self, count: int = 1) -> None:
        """Count work as done; prints at most once an interval."""
        self.done += count
        now = time.monotonic()
        if now - self.last < self.interval and self.done < self.total:
            return
        self.last = now
        if now - self.start < self.interval:
            return
        left = (now - self.start) / self.done * (self.total - self.done)
        line = f"{self.label}: {self.done}/{self.total}, about {left:.0f} s left"
        print(line, file=self.stream or sys.stderr, flush=True)
