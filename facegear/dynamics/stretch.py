"""A run over whole mesh periods that is requested of a machine."""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.integrator.integrator import Integrator, RunResult


@dataclass(frozen=True, eq=False)
class RunRequest:
    """Whole mesh periods from a state (2, n) by phase, with the options of `Integrator.run`.

    Without batches, samples or tangents there are no fractions of time in contact.
    """

    integrator: Integrator
    state: Array
    periods: int
    tangents: Array | None = None
    samples: int = 0
    batches: int = 0
    growth: bool = False

    def run(self) -> RunResult:
        """Run the request by itself.

        Returns
        -------
        RunResult
            Result of the run.

        Raises
        ------
        NotConverged
            If a step fails.
        """
        return self.integrator.run(
            self.state,
            self.periods,
            self.tangents,
            samples=self.samples,
            batches=self.batches,
            growth=self.growth,
        )

    @property
    def disturbances(self) -> Array:
        """Tangents (columns, 2, n); there may be none."""
        return np.zeros((0, *self.state.shape)) if self.tangents is None else self.tangents

    @property
    def kind(self) -> tuple[object, ...]:
        """Options that must be the same for machines that run side by side."""
        return len(self.disturbances), self.samples, self.batches, self.growth
