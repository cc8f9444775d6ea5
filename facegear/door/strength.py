"""Answers about strength and friction: stress, safety, life, loss and heat."""

from facegear.door.case import Case, drop_none
from facegear.pipeline.results.bearings import BearingLifeResult
from facegear.pipeline.results.strength import (
    DynamicStressResult,
    FrictionResult,
    MachineLossResult,
    RatingResult,
    RootStressResult,
    StressOverSpeedResult,
)


def root_stress(self: Case) -> "RootStressResult":
    """Compute the stress at the fillets of both gears while a tooth passes through the mesh, at the
    contact analysis' torques.

    `contact.root_stress` counts as true, whatever the config says.

    Returns
    -------
    RootStressResult
        Tension over torque, passage and gauges, MPa, with peaks. Raises what `contact` raises.

    Examples
    --------
    >>> import facegear
    >>> table = facegear.example().root_stress().table()
    >>> table["body"].unique().tolist()
    ['pinion', 'face_gear']
    """
    return self._with_changes("root_stress", {"contact.root_stress": True})._chain.result(RootStressResult)


def dynamic_stress(self: Case, speed_rpm: float | None = None) -> "DynamicStressResult":
    """Compute the root stress of every mesh while the machine runs at a pinion speed.

    Parameters
    ----------
    speed_rpm : float or None
        Speed of the pinions, rpm; None for that of the config.

    Returns
    -------
    DynamicStressResult
        Largest stress of each mesh with its mean force, running, and a bound, MPa. Raises what
        `root_stress` and `response` raise.

    Examples
    --------
    >>> import facegear
    >>> table = facegear.example().dynamic_stress(1000).table()
    >>> bool((table["pinion_bound_mpa"] >= table["pinion_running_mpa"]).all())
    True
    """
    changes = {"contact.root_stress": True, **drop_none({"dynamics.speed_rpm": speed_rpm})}
    return self._with_changes("dynamic_stress", changes)._chain.result(DynamicStressResult)


def stress_over_speed(self: Case) -> "StressOverSpeedResult":
    """Compute the largest root stress and pressure over the speed range, of every motion known at a
    speed.

    Motions are those of the sweep and, with section `branches`, all stable ones that were followed.

    Returns
    -------
    StressOverSpeedResult
        The stress. Raises what `root_stress` and `sweep` raise.

    Examples
    --------
    >>> import facegear
    >>> gearbox = facegear.example().with_values({"dynamics.sweep.points": 2})
    >>> table = gearbox.stress_over_speed().table()
    >>> bool((table.loc[table["worst"], "dynamic_factor"] > 1).all())
    True
    """
    changes = {"contact.root_stress": True}
    return self._with_changes("stress_over_speed", changes)._chain.result(StressOverSpeedResult)


def rating(self: Case) -> "RatingResult":
    """Compute safety and life of the pair under the duty cycle of section `strength`.

    Returns
    -------
    RatingResult
        The rating. Raises ConfigError without that section, and what `contact` raises.

    Examples
    --------
    >>> import facegear
    >>> facegear.example().rating().table()["failure"].unique().tolist()
    ['bending', 'pitting']
    """
    return self._chain.result(RatingResult)


def bearing_life(self: Case) -> "BearingLifeResult":
    """Compute loads, stiffness and life of the rolling bearings of the shafts.

    Returns
    -------
    BearingLifeResult
        The results. Raises ConfigError for a machine without rolling bearings or with overloaded ones,
        NotConverged.
    """
    return self._chain.result(BearingLifeResult)


def friction(self: Case, speed_rpm: float | None = None) -> "FrictionResult":
    """Compute sliding, friction loss, temperatures and film of one mesh at a pinion speed.

    Parameters
    ----------
    speed_rpm : float or None
        Speed of the pinions, rpm; None for that of the config.

    Returns
    -------
    FrictionResult
        The results. Raises ConfigError without section `lubrication`, and what `contact` raises.

    Examples
    --------
    >>> import facegear
    >>> oil = {"oil": "polyol_ester_5_cst", "supply_temperature_c": 80, "pinion": {"ra_um": 0.3}}
    >>> oil |= {"face_gear": {"ra_um": 0.3}, "bulk": {"source": "given", "temperature_c": 100}}
    >>> table = facegear.example().with_values({"lubrication": oil}).friction().table()
    >>> bool(table["efficiency"].between(0.99, 1).all())
    True
    """
    gearbox = self._with_changes("friction", drop_none({"dynamics.speed_rpm": speed_rpm}))
    return gearbox._chain.result(FrictionResult)


def losses(self: Case, speed_rpm: float | None = None) -> "MachineLossResult":
    """Compute the friction loss of every mesh and the heat of every body at rest under the mean
    torques, at a pinion speed.

    Over the duty cycle as well, where `strength.load_factors` is `machine`.

    Parameters
    ----------
    speed_rpm : float or None
        Speed of the pinions, rpm; None for that of the config.

    Returns
    -------
    MachineLossResult
        The losses. Raises what `friction` and `modes` raise.
    """
    gearbox = self._with_changes("losses", drop_none({"dynamics.speed_rpm": speed_rpm}))
    return gearbox._chain.result(MachineLossResult)
