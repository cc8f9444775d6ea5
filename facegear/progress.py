"""Progress of long stages, with an estimate of the time left that does not jump."""

import sys
import time
from typing import TextIO

SLOWER = 1.25
"""The printed time left rises only when the estimate has grown by more than this factor."""


class Progress:
    """Print `label: done/total, about N s left` every `interval` seconds.

    `total` is the number of pieces of work. The pace leaves out the first step, in which code is
    compiled; until a second one nothing is estimated. The printed end follows the pace half way from
    line to line. The stream is standard error unless given, which a workflow stage also copies to its
    log.
    """

    def __init__(self, label: str, total: int, interval: float = 5.0, stream: TextIO | None = None) -> None:
        self.label, self.total, self.interval = label, max(total, 1), interval
        self.stream = stream
        self.steps_done = 0
        self.start = self.last = time.monotonic()
        self.first: tuple[float, int] | None = None
        self.estimate: tuple[float, float] | None = None

    def step(self, count: int = 1) -> None:
        """Count work as done and print a line, at most one an interval, and one at the end of a long run.

        Parameters
        ----------
        count : int
            Number of finished pieces of work.
        """
        self.steps_done += count
        now = time.monotonic()
        if self.first is None:
            self.first = now, self.steps_done
        if (
            now - self.last < self.interval and self.steps_done < self.total
        ) or now - self.start < self.interval:
            return
        self.last = now
        is_estimable = self.first[1] < self.steps_done < self.total
        left = f", about {self._left(now, self.first):.0f} s left" if is_estimable else ""
        print(
            f"{self.label}: {self.steps_done}/{self.total}{left}", file=self.stream or sys.stderr, flush=True
        )

    def _left(self, now: float, first: tuple[float, int]) -> float:
        """Return the time left, s: the mean of remaining work over the pace since the first step and of
        the estimate printed last less the time since then. It rises only if it exceeds that estimate by
        the factor SLOWER.

        now: present time, s; first: time, s, and count of work at the end of the first step.
        """
        left = (now - first[0]) / (self.steps_done - first[1]) * (self.total - self.steps_done)
        if self.estimate is not None:
            then, estimate = self.estimate
            left = 0.5 * (left + max(estimate - (now - then), 0.0))
            left = left if left > SLOWER * estimate else min(left, estimate)
        self.estimate = now, left
        return left
