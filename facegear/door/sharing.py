"""Answers about load sharing: at one speed, over the hunting cycle, and its map."""

from facegear.door.case import Case, drop_none
from facegear.pipeline.results.sharing import (
    HuntingResult,
    LoadSharingResult,
    SensitivityResult,
    SharingMapResult,
)


def load_sharing(self: Case, speed_rpm: float | None = None) -> "LoadSharingResult":
    """Compute load-sharing coefficients of the running machine at a pinion speed, averaged as section
    `load_sharing` asks.

    A coefficient is the largest mesh force of a group that shares a load over the mean of the group.

    Parameters
    ----------
    speed_rpm : float or None
        Speed of the pinions, rpm; None for that of the config.

    Returns
    -------
    LoadSharingResult
        The coefficients. Raises ConfigErrors for a speed that the config would refuse, NotConverged
        naming the speed.

    Examples
    --------
    >>> import facegear
    >>> facegear.example().load_sharing().table()["group"].to_list()
    ['right input', 'left input', 'idlers']
    """
    gearbox = self._with_changes("load_sharing", drop_none({"dynamics.speed_rpm": speed_rpm}))
    return gearbox._chain.result(LoadSharingResult)


def hunting(self: Case, positions: int | None = None) -> "HuntingResult":
    """Compute the load sharing at rest over the hunting cycle, in which every tooth meets every other.

    It is a sequence of static equilibria, without damping and inertia. Without errors that turn, one
    mesh cycle is all.

    Parameters
    ----------
    positions : int or None
        Number of positions in a mesh cycle; None for that of section `load_sharing`.

    Returns
    -------
    HuntingResult
        Loads, coefficients and K_gamma of groups and meshes. Raises NotConverged.

    Examples
    --------
    >>> import facegear
    >>> facegear.example().hunting(positions=4).table()["k_gamma"].round(2).to_list()
    [1.41, 1.41, 0.65]
    """
    changes = drop_none({"load_sharing.hunting_positions": positions})
    return self._with_changes("hunting", changes)._chain.result(HuntingResult)


def sensitivity(self: Case, positions: int | None = None) -> "SensitivityResult":
    """Compute by how much each error of the machine, alone, changes its load sharing at rest: K_gamma
    per um.

    Parameters
    ----------
    positions : int or None
        Number of positions in a mesh cycle; None for that of section `load_sharing`.

    Returns
    -------
    SensitivityResult
        The sensitivities. Raises NotConverged.
    """
    changes = drop_none({"load_sharing.hunting_positions": positions})
    return self._with_changes("sensitivity", changes)._chain.result(SensitivityResult)


def sharing_map(self: Case) -> "SharingMapResult":
    """Map load sharing at rest over the numbers that decide it, and compute what changes of the machine
    would gain.

    Returns
    -------
    SharingMapResult
        For the deviations of section `sharing_map`, or its defaults. Raises ConfigErrors for a machine
        without geometric meshes or with one face gear, NotConverged.
    """
    section = self._values["sharing_map"] or {}
    return self._with_changes("sharing_map", {"sharing_map": section})._chain.result(SharingMapResult)
