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


def imperfections(section: Transmission, shape: Layout, unloaded: Harmonics | None = None) -> Imperfections:
    """Errors of single meshes and bodies, in m."""
    meshes = [section.single_meshes.get(name, LIKE_ALL_MESHES) for name in shape.mesh_names]
    pinions, gears = single_parts(section, shape)
    clearances = [
        section.pinion.bearing_clearance_um if own.bearing_clearance_um is None else own.bearing_clearance_um
        for own in pinions
    ]
    return Imperfections(
        error=1e-6 * np.array([own.error_um for own in meshes]),
        stiffness=np.array([own.stiffness_factor for own in meshes]),
        series={
            mesh: error_series(own.transmission_error, unloaded)
            for mesh, own in enumerate(meshes)
            if own.transmission_error is not None
        },
        position=1e-6 * np.array([(own.position_um.x, own.position_um.y) for own in pinions]),
        bearing_clearance=1e-6 * np.array(clearances),
        clocking=np.array([own.clocking_deg for own in pinions]) / 360.0 * shape.pinion_teeth,
        pinion_runout=tuple(_runout(own.runout or section.pinion.runout) for own in pinions),
        gear_runout=tuple(_runout(own.runout or section.face_gear.runout) for own in gears),
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
            "transmission.backlash_um", None, "a number, as facegear.config.model.resolved gives"
        )
    meshes = [section.single_meshes.get(name, LIKE_ALL_MESHES).backlash_um for name in shape.mesh_names]
    return 0.5e-6 * np.array([section.backlash_um if single is None else single for single in meshes])


def error_lags(section: Transmission, shape: Layout) -> Array | None:
    """Lag of e(t) at each mesh in mesh periods, shape (meshes,); None where it is that of the stiffness.

    A mesh named itself keeps its own lag, then that of its pinion's role; one not named has none.
    """
    phasing = section.transmission_error.phasing
    if phasing == "mesh":
        return None
    named: Mapping[str, float] = {} if phasing == "in_step" else phasing
    roles = [f"{shape.pinions[i].role}/{shape.gears[g].side}" for i, g in shape.meshes]
    pairs = zip(shape.mesh_names, roles, strict=True)
    return np.array([named.get(mesh, named.get(role, 0.0)) for mesh, role in pairs])


def _runout(section: RunoutSection | None) -> Runout:
    if section is None:
        return Runout()
    return Runout(1e-6 * section.eccentricity_um, float(np.radians(section.phase_deg)))


def _pitch_curves(bodies: Sequence[SinglePinion | SingleGear]) -> dict[int, Array]:
    return {
        body: 1e-6 * np.array(own.cumulative_pitch_um)
        for body, own in enumerate(bodies)
        if own.cumulative_pitch_um
    }
