"""Answers about the machine at rest: modes, statics, shafts, face gears that bend, poses."""

from facegear.door.case import Case, drop_none
from facegear.pipeline.results.casing import CasingLoadsResult, CasingResponseResult
from facegear.pipeline.results.gear_bodies import GearBodiesResult, GearWavesResult
from facegear.pipeline.results.machine import (
    ModesResult,
    OperatingPoseResult,
    ShaftOrdersResult,
    ShaftsResult,
    StaticsResult,
)


def modes(self: Case) -> "ModesResult":
    """Compute natural frequencies, classes and shapes of the undamped modes, with constant mean mesh
    stiffness.

    They need a contact analysis unless `modal.stiffness` is average or the mesh stiffness is given.

    Returns
    -------
    ModesResult
        The modes.

    Examples
    --------
    >>> import facegear
    >>> int((facegear.example().modes().table()["class"] == "rigid body").sum())
    6
    """
    return self._chain.result(ModesResult)


def statics(self: Case) -> "StaticsResult":
    """Compute the force of every mesh at rest under the mean torques, and torque, speed and power of
    every body.

    Returns
    -------
    StaticsResult
        The results. Raises NotConverged.

    Examples
    --------
    >>> import facegear
    >>> facegear.example().statics().table()["flank"].value_counts().to_dict()
    {'drive': 7, 'back': 3}
    """
    return self._chain.result(StaticsResult)


def gear_bodies(self: Case) -> "GearBodiesResult":
    """Compute modes and compliance of the face gears that bend by finite elements, with their hubs
    fixed.

    Returns
    -------
    GearBodiesResult
        The results. Raises ConfigError for a machine whose face gears are rigid.
    """
    return self._chain.result(GearBodiesResult)


def gear_waves(self: Case) -> "GearWavesResult":
    """Compute the damped modes at the nominal speed of a machine whose face gears bend, and their waves.

    Returns
    -------
    GearWavesResult
        The results. Raises ConfigError for a machine whose face gears are rigid, NotConverged.
    """
    return self._chain.result(GearWavesResult)


def shafts(self: Case) -> "ShaftsResult":
    """Compute stiffness, deflection and bearing loads of pinion shafts, and the twist of torsional
    springs, at rest.

    Returns
    -------
    ShaftsResult
        The results. Raises ConfigError for a machine without shafts and torsion, NotConverged.
    """
    return self._chain.result(ShaftsResult)


def casing_loads(self: Case) -> "CasingLoadsResult":
    """Compute what the casing does to the machine: mesh forces with and without it, seats, feet and modes.

    Returns
    -------
    CasingLoadsResult
        The results. Raises ConfigError for a machine without casing, NotConverged.
    """
    return self._chain.result(CasingLoadsResult)


def casing_response(self: Case) -> "CasingResponseResult":
    """Compute the acceleration of the casing's sensors over speed, linear about the mean load.

    Returns
    -------
    CasingResponseResult
        The results. Raises ConfigError for a machine without sensors on a casing, NotConverged.
    """
    return self._chain.result(CasingResponseResult)


def shaft_orders(self: Case, speed_rpm: float | None = None) -> "ShaftOrdersResult":
    """Compute the vibration at the orders of the gears' turns, from runouts, pitch deviations and
    single teeth.

    It is linear about the static load: flanks do not part, and the mesh stiffness is its mean. An order
    counts vibrations in one turn of a gear.

    Parameters
    ----------
    speed_rpm : float or None
        Speed of the pinions, rpm; None for that of the config.

    Returns
    -------
    ShaftOrdersResult
        The orders. Raises ConfigErrors for a machine without geometric meshes, NotConverged.
    """
    changes = drop_none({"dynamics.speed_rpm": speed_rpm})
    return self._with_changes("shaft_orders", changes)._chain.result(ShaftOrdersResult)


def operating_pose(self: Case) -> "OperatingPoseResult":
    """Compute the pose of the teeth of every mesh under the machine's own mean forces, and their
    contact there.

    `transmission.operating_pose` counts as `static`, whatever the config says.

    Returns
    -------
    OperatingPoseResult
        The poses. Raises ConfigErrors for a machine without contact analysis, InvalidInput for a pose
        outside those that are solved, NotConverged.
    """
    gearbox = self._with_changes("operating_pose", {"transmission.operating_pose": "static"})
    return gearbox._chain.result(OperatingPoseResult)
