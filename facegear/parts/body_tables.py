"""Tables and arrays of gear bodies with their hubs held."""

from itertools import combinations_with_replacement

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.parts.gear_body import SolvedBody, influence
from facegear.parts.modes import HARMONICS, OrderModes, phase_factors, resonant_speeds, wave_frequencies
from facegear.parts.reduced_body import RimForces, flank_influence
from facegear.parts.section import section_properties
from facegear.parts.wheel import Patch
from facegear.teeth.placement import FLANKS

RPM = 30.0 / np.pi
"""rpm for 1 rad/s."""
DRAWN_MODES = 2
"""Modes of each order whose shapes are stored."""
DRAWN_ORDERS = 7
"""Number of orders, from 0, whose shapes are stored."""
COUPLINGS = ("hub_axial_sqrt_kg", "hub_spin_sqrt_kg_m", "hub_sideways_sqrt_kg", "hub_tilt_sqrt_kg_m")
"""Columns of Q with the hub's motion along the axis, round it, sideways, and tilting about a diameter at
height 0."""


def body_table(gear: str, body: SolvedBody, patch: Patch, forces: RimForces, angles: Array) -> pd.DataFrame:
    """Return mass, inertia and compliance of a body.

    Parameters
    ----------
    gear : str
        Name of the gear.
    body : SolvedBody
        The solved body.
    patch : Patch
        Area on which a mesh presses.
    forces : RimForces
        Unit forces of the flanks of a mesh.
    angles : (n,) array
        Angles of the meshes, rad.

    Returns
    -------
    pd.DataFrame
        One row: mass (kg) and inertia (kg m2) of the section, number of coordinates of its modes, own
        compliance along the drive flank's line of action (m/N), the fraction of it that the modes hold,
        compliances that they leave out (m/N, magnitudes): between the drive and the back flank of one mesh,
        and the largest one between flanks of two meshes, NaN for a single mesh; and the largest relative
        change of a frequency from a coarser mesh.
    """
    mass, polar, diametral, _ = section_properties(body.section)
    drive, back = forces.directions
    residual = body.static(patch) - body.modal(patch)
    whole = influence(body.static(patch), 0.0, drive, drive)
    between_flanks = influence(residual, forces.turns[0] - forces.turns[1], drive, back)
    changes = np.concatenate([*body.changes, np.zeros(1)])
    waves = sum(modes.frequencies.size * (2 if modes.order else 1) for modes in body.orders)
    return pd.DataFrame(
        {
            "gear": [gear],
            "mass_kg": [mass],
            "inertia_kg_m2": [polar],
            "diametral_inertia_kg_m2": [diametral],
            "elements": [len(body.mesh.quads)],
            "coordinates": [waves],
            "own_compliance_m_per_n": [whole],
            "modal_fraction": [influence(body.modal(patch), 0.0, drive, drive) / whole],
            "left_out_between_flanks_m_per_n": [abs(between_flanks)],
            "left_out_between_meshes_m_per_n": [_left_out(residual, forces, angles)],
            "frequency_change": [float(changes.max())],
        }
    )


def _left_out(residual: Array, forces: RimForces, angles: Array) -> float:
    """Return the largest influence (m/N, magnitude) between flanks of two different meshes by given
    compliances.

    residual (orders, 3, 3), m/N; forces: unit forces of the flanks; angles (n,) of the meshes, rad. It is
    nan for a single mesh.
    """
    at = (angles[:, None] + forces.turns).ravel()
    mesh = np.repeat(np.arange(angles.size), forces.turns.size)
    between = flank_influence(residual, np.tile(forces.directions, (angles.size, 1)), at)
    return float(np.abs(between[mesh[:, None] != mesh]).max(initial=-1.0)) if angles.size > 1 else np.nan


def mode_table(
    gear: str,
    body: SolvedBody,
    speed: float,
    teeth: int,
    ratio: float,
    damping: tuple[float, float] = (0.0, 0.0),
) -> pd.DataFrame:
    """Return frequencies, coefficients and resonant speeds of all modes, hub held.

    Parameters
    ----------
    gear : str
        Name of the gear.
    body : SolvedBody
        The solved body.
    speed : float
        Speed of the body, rad/s.
    teeth : int
        Number of its teeth.
    ratio : float
        Speed of the pinions over that of the body, a ratio.
    damping : tuple[float, float]
        Damping ratio of every mode, and beta (s) of D = beta K.

    Returns
    -------
    pd.DataFrame
        One row a mode: gear, nodal_diameters, mode (from 1), frequency_hz at rest, round_fraction (of its
        mass, moving round the axis), gyroscopic_factor c, stiffening_factor B, damping_ratio, the four Q
        (COUPLINGS), speed_rpm of the pinions, forward_hz and backward_hz of waves in space at that speed,
        forward_met_rpm and backward_met_rpm, pinion speeds at which the mesh frequency meets each wave,
        and frequency_change from a coarser mesh. Coefficients are those of unit modal mass.
    """
    parts = []
    for modes, changes in zip(body.orders, body.changes, strict=True):
        forward, backward = wave_frequencies(modes, speed)
        resonances_rpm = [ratio * RPM * speeds for speeds in resonant_speeds(modes, teeth, 1)]
        parts.append(
            pd.DataFrame(
                {
                    "gear": gear,
                    "nodal_diameters": modes.order,
                    "mode": np.arange(1, modes.frequencies.size + 1),
                    "frequency_hz": modes.frequencies,
                    "round_fraction": modes.torsional,
                    "gyroscopic_factor": modes.gyroscopic_factors,
                    "stiffening_factor": modes.stiffening_factors,
                    "damping_ratio": damping[0] + np.pi * damping[1] * modes.frequencies,
                    **hub_couplings(modes),
                    "speed_rpm": ratio * RPM * speed,
                    "forward_hz": forward,
                    "backward_hz": backward,
                    "forward_met_rpm": resonances_rpm[0],
                    "backward_met_rpm": resonances_rpm[1],
                    "frequency_change": changes,
                }
            )
        )
    return pd.concat(parts, ignore_index=True)


def hub_couplings(modes: OrderModes) -> dict[str, Array]:
    """Return Q of every mode: mass between the mode and a motion of the hub.

    Q = int rho X . R over the body, X the shape for unit modal mass and R the body moved as a rigid whole by
    1 m or 1 rad. Modes of two nodal diameters and more have none.

    Parameters
    ----------
    modes : OrderModes
        The m modes of one order.

    Returns
    -------
    dict of str to (m,) array
        By COUPLINGS, in the units of their names (sqrt(kg), m).
    """
    couplings = np.zeros((4, modes.frequencies.size))
    if modes.order == 0:
        couplings[:2] = modes.hub
    elif modes.order == 1:
        couplings[2:] = modes.hub
    return dict(zip(COUPLINGS, couplings, strict=True))


def crossing_table(
    gear: str, body: SolvedBody, teeth: int, ratio: float, last_rpm: float, angles: Array
) -> pd.DataFrame:
    """Return the crossings of mesh harmonics with waves, hub held, up to a pinion speed.

    Parameters
    ----------
    gear : str
        Name of the gear.
    body : SolvedBody
        The solved body.
    teeth : int
        Number of its teeth.
    ratio : float
        Speed of the pinions over that of the body, a ratio.
    last_rpm : float
        Highest speed of the pinions, rpm.
    angles : (n,) array
        Angles of the meshes, rad.

    Returns
    -------
    pd.DataFrame
        One row a crossing: gear, nodal_diameters, mode, wave (forward, backward or standing), harmonic,
        speed_rpm of the pinions, frequency_hz and phase_factor: how many times the force of one mesh
        drives the wave where all meshes of the gear carry the same force; their number where all add up,
        0 where they cancel.
    """
    rows = []
    for modes in body.orders:
        waves = ("forward", "backward") if modes.order else ("standing",)
        for harmonic in HARMONICS:
            speeds = resonant_speeds(modes, teeth, harmonic)
            factors = phase_factors(modes.order, harmonic, teeth, angles)
            for wave, wave_speeds, factor in zip(waves, speeds, factors, strict=False):
                for number, speed in enumerate(wave_speeds):
                    frequency = harmonic * teeth * speed / (2.0 * np.pi)
                    rpm = ratio * RPM * speed
                    if rpm <= last_rpm:
                        rows.append((gear, modes.order, number + 1, wave, harmonic, rpm, frequency, factor))
    columns = ("gear", "nodal_diameters", "mode", "wave", "harmonic", "speed_rpm", "frequency_hz")
    return pd.DataFrame(rows, columns=[*columns, "phase_factor"])


def compliance_table(gear: str, body: SolvedBody, patch: Patch) -> pd.DataFrame:
    """Return the static motions along the axis, round it and along the radius below a mesh by unit forces,
    order by order, hub held.

    Parameters
    ----------
    gear : str
        Name of the gear.
    body : SolvedBody
        The solved body.
    patch : Patch
        Area on which a mesh presses.

    Returns
    -------
    pd.DataFrame
        One row an order: gear, order, axial_m_per_n (axial motion by an axial force), round_m_per_n
        (tangential by tangential), axial_round_m_per_n (axial by tangential), radial_m_per_n (radial by
        radial), axial_radial_m_per_n and round_radial_m_per_n (axial and tangential by radial).
    """
    static = body.static(patch)
    return pd.DataFrame(
        {
            "gear": gear,
            "order": np.arange(len(static)),
            "axial_m_per_n": static[:, 0, 0],
            "round_m_per_n": static[:, 1, 1],
            "axial_round_m_per_n": static[:, 0, 1],
            "radial_m_per_n": static[:, 2, 2],
            "axial_radial_m_per_n": static[:, 0, 2],
            "round_radial_m_per_n": static[:, 1, 2],
        }
    )


def influence_table(
    gear: str, body: SolvedBody, patch: Patch, forces: RimForces, meshes: dict[str, float]
) -> pd.DataFrame:
    """Return the static motion of one flank against its force by a unit force on another, hub held.

    Parameters
    ----------
    gear : str
        Name of the gear.
    body : SolvedBody
        The solved body.
    patch : Patch
        Area on which a mesh presses.
    forces : RimForces
        Unit forces of the flanks of a mesh.
    meshes : dict[str, float]
        Angle of each pinion as the upper gear turns, rad, by its name.

    Returns
    -------
    pd.DataFrame
        One row for two flanks of two meshes or of one mesh: gear, first, first_flank, second,
        second_flank, compliance_m_per_n; for each two pinions, and each by itself, drive and drive, drive
        and back, back and drive, and back and back where flanks are no mirror images of each other.
    """
    static = body.static(patch)
    (drive, back), rows = forces.directions, []
    are_mirror_images = not forces.turns.any() and np.array_equal(back, drive * np.array([1.0, -1.0, 1.0]))
    pairs = ((0, 0), (0, 1), (1, 0)) if are_mirror_images else ((0, 0), (0, 1), (1, 0), (1, 1))
    for first, second in combinations_with_replacement(meshes, 2):
        for i, j in pairs:
            angle = meshes[first] + forces.turns[i] - meshes[second] - forces.turns[j]
            value = influence(static, angle, forces.directions[i], forces.directions[j])
            rows.append((gear, first, FLANKS[i], second, FLANKS[j], value))
    columns = ["gear", "first", "first_flank", "second", "second_flank", "compliance_m_per_n"]
    return pd.DataFrame(rows, columns=columns)


def shape_arrays(gear: str, body: SolvedBody) -> dict[str, Array]:
    """Return nodes, quadrilaterals and displacements (U, V, W) at the nodes of the first modes, for pictures.

    Parameters
    ----------
    gear : str
        Name of the gear, with which the names of the arrays begin.
    body : SolvedBody
        The solved body.

    Returns
    -------
    dict of str to array
        nodes (n, 2) in m, quads (e, 4) as an index of nodes, shapes (k, n, 3) for unit modal mass, labels (k,
        2): order and number of the mode.
    """
    node_shapes = body.elements.basis.dofs.nodal_dofs[0]
    shapes, labels = [], []
    for modes in body.orders[:DRAWN_ORDERS]:
        for number in range(min(DRAWN_MODES, modes.frequencies.size)):
            shapes.append(modes.shapes[:, number].reshape(-1, 3)[node_shapes])
            labels.append((modes.order, number + 1))
    return {
        f"{gear}_nodes": body.mesh.nodes,
        f"{gear}_quads": body.mesh.quads,
        f"{gear}_shapes": np.array(shapes).reshape(-1, len(body.mesh.nodes), 3),
        f"{gear}_labels": np.array(labels, np.int64).reshape(-1, 2),
    }
