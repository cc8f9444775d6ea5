"""States that a run has passed through."""

import numpy as np

from facegear.arrays import Array


class Passed:
    """The last `kept` states (periods, 2, n) that a run passed through at the end of a period."""

    def __init__(self, kept: int, shape: tuple[int, ...]) -> None:
        self.kept, self.filled = kept, 0
        self.room = np.empty((2 * kept, *shape))

    @property
    def states(self) -> Array:
        """All that are kept, oldest first."""
        return self.room[max(self.filled - self.kept, 0) : self.filled]

    def room_for(self, periods: int) -> Array:
        """Places (periods, 2, n) behind those kept, which now count as filled."""
        if self.filled + periods > len(self.room):
            held = self.states.copy()
            if len(held) + periods > len(self.room):
                self.room = np.empty((len(held) + periods, *self.room.shape[1:]))
            self.room[: len(held)] = held
            self.filled = len(held)
        self.filled += periods
        return self.room[self.filled - periods : self.filled]

    def forget(self) -> None:
        """Keep none."""
        self.filled = 0
