"""Plan of a machine's branches; plain numbers, so that a config can be read without the solvers."""

from dataclasses import dataclass


@dataclass(frozen=True)
class BranchPlan:
    """Settings of the branches stage.

    Speeds are in rpm, lengths in m. `spread` is the half width of the box of random starts: displacements,
    and rotations at the mesh radius.
    """

    from_rpm: float
    to_rpm: float
    nominal_rpm: float
    tolerance: float
    longest_period: int
    longest_start_period: int
    max_branches: int
    speeds_rpm: tuple[float, ...]
    starts: int
    spread: float
    seed: int
    parameters: tuple[str, ...]
    factors: tuple[float, float]
    nearest: int
