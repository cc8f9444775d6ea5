"""Answers about the machine in motion: response, sweep, branches of periodic motions."""

from collections.abc import Sequence

from facegear.door.case import Case, drop_none
from facegear.errors import FacegearError
from facegear.pipeline.results.motion import BranchesResult, BranchLociResult, ResponseResult, SweepResult


def response(self: Case, speed_rpm: float | None = None) -> "ResponseResult":
    """Integrate the motion to its steady state at a pinion speed.

    Parameters
    ----------
    speed_rpm : float or None
        Speed of the pinions, rpm; None for that of the config.

    Returns
    -------
    ResponseResult
        Deflections and forces of meshes over time, spectrum, class of motion, bearing forces. Raises
        ConfigErrors for a speed that the config would refuse, NotConverged naming the speed.

    Examples
    --------
    >>> import facegear
    >>> facegear.example().response(1000).table()["class"].iloc[0]
    'period-1'
    """
    gearbox = self._with_changes("response", drop_none({"dynamics.speed_rpm": speed_rpm}))
    return gearbox._chain.result(ResponseResult)


def sweep(
    self: Case,
    from_rpm: float | None = None,
    to_rpm: float | None = None,
    points: int | None = None,
    directions: Sequence[str] | None = None,
    threads: int = 1,
) -> "SweepResult":
    """Compute steady states over speed, up and down, each from the state at the speed before it, with
    jumps and resonances.

    Arguments that are None are as in section `dynamics.sweep` of the config.

    Parameters
    ----------
    from_rpm : float or None
        Lowest speed of the pinions, rpm; `down` ends there.
    to_rpm : float or None
        Highest speed of the pinions, rpm.
    points : int or None
        Number of evenly spaced speeds.
    directions : Sequence[str] | None
        `up`, `down` or both.
    threads : int
        Number of threads that compute; results do not depend on it.

    Returns
    -------
    SweepResult
        The sweep. Raises ConfigErrors for values that the config would refuse, NotConverged naming the
        speed.

    Examples
    --------
    >>> import facegear
    >>> found = facegear.example().sweep(1000, 1200, points=3, directions=["up"])
    >>> found.dataset()["deflection_ac_rms_um"].dims
    ('direction', 'speed_rpm', 'mesh')
    """
    sweep_changes = {"from_rpm": from_rpm, "to_rpm": to_rpm, "points": points, "directions": directions}
    changes = drop_none({f"dynamics.sweep.{key}": value for key, value in sweep_changes.items()})
    if isinstance(points, int) and points < self._values["dynamics"]["sweep"]["chunks"]:
        changes["dynamics.sweep.chunks"] = 1
    if not isinstance(threads, int) or threads < 1:
        raise FacegearError(f"sweep: threads = {threads!r}: must be a whole number of at least 1")
    return self._with_changes("sweep", changes)._chain.result(SweepResult, threads=threads)


def branches(
    self: Case,
    from_rpm: float | None = None,
    to_rpm: float | None = None,
    longest_period: int | None = None,
    starts: int | None = None,
) -> "BranchesResult":
    """Follow periodic motions over speed, stable or not, beside the sweep: folds, margins, coexistence.

    These are all motions that branches join to the first one, to those of the sweep or to those of the
    random starts, up to the longest period, with their images under the machine's symmetries. A motion
    that no branch leads to is missing if no start has found it; docs/explanation/branches.md lists all
    bounds. What is None is as in section `branches` of the config, or its default where there is no such
    section.

    Parameters
    ----------
    from_rpm : float or None
        First speed of the pinions, rpm.
    to_rpm : float or None
        Last speed of the pinions, rpm.
    longest_period : int or None
        Longest period followed through doublings, in mesh periods.
    starts : int or None
        Number of random starts.

    Returns
    -------
    BranchesResult
        The branches. Raises ConfigErrors for values that the config would refuse, NotConverged without a
        motion of period one.

    Examples
    --------
    >>> import facegear
    >>> quick = {"mesh_stiffness.mesh_law": "constant_load", "dynamics.sweep.points": 2}
    >>> found = facegear.example().with_values(quick).branches(7450, 7550, starts=1)
    >>> found.table()["period"].unique().tolist()
    [1]
    """
    explore = drop_none({"starts": starts})
    changes = drop_none({"from_rpm": from_rpm, "to_rpm": to_rpm, "longest_period": longest_period})
    gearbox = self._with_branches({**changes, **({"explore": explore} if explore else {})})
    return gearbox._chain.result(BranchesResult)


def branch_loci(
    self: Case, parameters: Sequence[str] | None = None, nearest: int | None = None
) -> "BranchLociResult":
    """Follow folds and period doublings, with cusps, in the plane of speed and a second parameter.

    Parameters
    ----------
    parameters : Sequence[str] | None
        Some of torque, backlash, mesh_damping and bearing_stiffness; None for those of section
        `branches.loci`.
    nearest : int or None
        Number of special points nearest to the nominal speed that are followed; None for that of the
        section.

    Returns
    -------
    BranchLociResult
        One curve for each special point and parameter. Raises ConfigErrors for values that the config
        would refuse.
    """
    loci = drop_none({"parameters": parameters, "nearest": nearest})
    return self._with_branches({"loci": loci} if loci else {})._chain.result(BranchLociResult)
