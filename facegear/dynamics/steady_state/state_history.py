"""History of the states through which a run has passed."""

import numpy as np

from facegear.arrays import Array


class StateHistory:
    """The last `capacity` states (periods, 2, n) of a run at the ends of periods."""

    def __init__(self, capacity: int, shape: tuple[int, ...]) -> None:
        self.capacity, self.count = capacity, 0
        self.buffer = np.empty((2 * capacity, *shape))

    @property
    def states(self) -> Array:
        """Stored states, oldest first."""
        return self.buffer[max(self.count - self.capacity, 0) : self.count]

    def reserve(self, periods: int) -> Array:
        """Reserve space behind the stored states; it counts as filled from now on.

        Parameters
        ----------
        periods : int
            Number of states.

        Returns
        -------
        (periods, 2, n) array
            View to write the states to, m and m/rad.
        """
        if self.count + periods > len(self.buffer):
            last_states = self.states.copy()
            if len(last_states) + periods > len(self.buffer):
                self.buffer = np.empty((len(last_states) + periods, *self.buffer.shape[1:]))
            self.buffer[: len(last_states)] = last_states
            self.count = len(last_states)
        self.count += periods
        return self.buffer[self.count - periods : self.count]

    def forget(self) -> None:
        """Remove all states."""
        self.count = 0
