"""Forces and penetrations of contacts and bearings at the instants of a motion, in one pass over arrays."""

from facegear._kernels import samples
from facegear.arrays import Array, Integers


def add_ring_forces(
    displacement: Array,
    speed: Array,
    stiffness: Array,
    clearance: Array,
    lag: float,
    body: Integers,
    forces: Array,
) -> None:
    """Write forces along x and y of R bearings with clearance, whose springs act beyond it.

    Parameters
    ----------
    displacement, speed : (R, 2, K)
        Along x and y at K instants, m and m/s.
    stiffness, clearance : (R,)
        N/m and m.
    lag
        Damping over stiffness, s.
    body : (R,)
        Whose bearings they are.
    forces : (bodies, 3, K)
        Written for these bodies, N.
    """
    samples.write_ring_forces(displacement, speed, stiffness, clearance, lag, body, forces)


def press_in(deflections: Array, errors: Array, lower: Array, upper: Array) -> None:
    """Turn deflections of contacts into how far they are pressed in.

    Parameters
    ----------
    deflections : (M, B, K)
        Of M contacts over B mesh periods of K instants, m. Written: the amount above `upper`, or below
        `lower` as a negative amount.
    errors : (K, M)
        Errors of the period, which are left out, m.
    lower, upper : (M,)
        Edges, m. A contact with lower >= upper is never open: both directions count from `upper`.
    """
    samples.press_in(deflections, errors, lower, upper)


def split_loads(forces: Array, rounding: float, loads: Array) -> None:
    """Write the loads of both flanks of meshes.

    Parameters
    ----------
    forces : (M, K)
        Force that each mesh transmits, N.
    rounding
        Part of the largest force up to which a force counts as none, dimensionless.
    loads : (2 M, K)
        Written: loads of the drive flanks, then of the back flanks, N.
    """
    samples.split_loads(forces, rounding, loads)
