"""The errors of single meshes and bodies that section `transmission` describes, in SI."""

from collections.abc import Mapping, Sequence

import numpy as np

from facegear.arrays import Array
from facegear.config.bodies import RunoutSection, SingleGear, SinglePinion
from facegear.config.machine_layout import single_parts
from facegear.config.transmission import LIKE_ALL_MESHES, Transmission
from facegear.config.transmission_error import error_series
from facegear.errors import ConfigError
from facegear.harmonics.series import Harmonics
from facegear.transmission.imperfections import Imperfections, Runout
from facegear.transmission.layout import Layout


def imperfections(
    section: Transmission, shape: Layout, unloaded_error: Harmonics | None = None
) -> Imperfections:
    """Return the errors of single meshes and bodies.

    Parameters
    ----------
    section : Transmission
        Section `transmission` of the config.
    shape : Layout
        Layout of the machine.
    unloaded_error : Harmonics or None
        Transmission error e(t) of the unloaded pair, m, where a mesh takes it.

    Returns
    -------
    Imperfections
        Errors in m and rad.

    Raises
    ------
    ConfigError
        If a mesh takes e(t) from contact and there is none.
    """
    meshes = [section.single_meshes.get(name, LIKE_ALL_MESHES) for name in shape.mesh_names]
    pinions, gears = single_parts(section, shape)
    clearances = [
        section.pinion.bearing_clearance_um
        if single_part.bearing_clearance_um is None
        else single_part.bearing_clearance_um
        for single_part in pinions
    ]
    return Imperfections(
        error=1e-6 * np.array([single_part.error_um for single_part in meshes]),
        stiffness=np.array([single_part.stiffness_factor for single_part in meshes]),
        series={
            mesh: error_series(single_part.transmission_error, unloaded_error)
            for mesh, single_part in enumerate(meshes)
            if single_part.transmission_error is not None
        },
        position=1e-6
        * np.array([(single_part.position_um.x, single_part.position_um.y) for single_part in pinions]),
        bearing_clearance=1e-6 * np.array(clearances),
        clocking=np.array([single_part.clocking_deg for single_part in pinions]) / 360.0 * shape.pinion_teeth,
        pinion_runout=tuple(_runout(single_part.runout or section.pinion.runout) for single_part in pinions),
        gear_runout=tuple(_runout(single_part.runout or section.face_gear.runout) for single_part in gears),
        pinion_pitch=_pitch_curves(pinions),
        gear_pitch=_pitch_curves(gears),
    )


def half_backlash(section: Transmission, shape: Layout) -> Array:
    """Return half the backlash of each mesh: its own, or that of all meshes.

    Parameters
    ----------
    section : Transmission
        Section `transmission` of the config.
    shape : Layout
        Layout of the machine.

    Returns
    -------
    (meshes,) array
        Half the backlash, m.

    Raises
    ------
    ConfigError
        If the backlash of all meshes was not filled in.
    """
    if section.backlash_um is None:
        raise ConfigError(
            "transmission.backlash_um", None, "a number, as facegear.config.model.resolved_values gives"
        )
    meshes = [section.single_meshes.get(name, LIKE_ALL_MESHES).backlash_um for name in shape.mesh_names]
    return 0.5e-6 * np.array([section.backlash_um if single is None else single for single in meshes])


def error_lags(section: Transmission, shape: Layout) -> Array | None:
    """Return the lag of the transmission error at each mesh.

    A mesh that is named itself has its own lag, another one that of its pinion's role, if that is named. A
    mesh that is not named has none.

    Parameters
    ----------
    section : Transmission
        Section `transmission` of the config.
    shape : Layout
        Layout of the machine.

    Returns
    -------
    (meshes,) array or None
        Lags in mesh periods; None where e(t) lags as the stiffness does.
    """
    phasing = section.transmission_error.phasing
    if phasing == "mesh":
        return None
    lags: Mapping[str, float] = {} if phasing == "in_step" else phasing
    roles = [f"{shape.pinions[i].role}/{shape.gears[g].side}" for i, g in shape.meshes]
    pairs = zip(shape.mesh_names, roles, strict=True)
    return np.array([lags.get(mesh, lags.get(role, 0.0)) for mesh, role in pairs])


def _runout(section: RunoutSection | None) -> Runout:
    if section is None:
        return Runout()
    return Runout(1e-6 * section.eccentricity_um, float(np.radians(section.phase_deg)))


def _pitch_curves(bodies: Sequence[SinglePinion | SingleGear]) -> dict[int, Array]:
    return {
        body: 1e-6 * np.array(single_part.cumulative_pitch_um)
        for body, single_part in enumerate(bodies)
        if single_part.cumulative_pitch_um
    }
