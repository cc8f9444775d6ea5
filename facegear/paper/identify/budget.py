"""How much a search may cost."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Budget:
    """Evaluations of a branch: points of the first scan, points and generations of the refinement."""

    scan: int
    population: int
    generations: int
    seed: int = 0
