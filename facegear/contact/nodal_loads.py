"""Forces of all contacts on the nodes of both surfaces, and their resultants on the bodies.

Forces and moment of a mesh on its bodies, from the touching loads, averaged over the mesh cycle. They are the
sum of f . gap_p over all loads, gap_p the derivative of their gaps by a motion p of the pinion: each load
acts along the normal of the pinion where it is. The derivative of the whole energy of the contact has f . C_p
f / 2 as well, as other parts of the teeth give way differently.
"""

from collections.abc import Sequence

import numpy as np
import pandas as pd
import scipy.sparse as sp

from facegear.arrays import AnyArray, Array, Arrays, Integers
from facegear.contact.flanks import PinionSurface
from facegear.contact.position import LoadedPosition, Spot
from facegear.quantities import BODIES
from facegear.teeth.placement import body_rotation, pinion_angle, rotation


def load_arrays(variants: Sequence[Sequence[LoadedPosition]], flank_variant: Integers) -> dict[str, AnyArray]:
    """Collect contact forces as LOAD_ARRAYS: cases by variant, torque and position, loaded nodes by case and
    tooth.

    Nodes count along each row of the contact surface's lattice before refinement; the force (N) acts
    against the surface's outward normal.

    Parameters
    ----------
    variants : Sequence[Sequence[LoadedPosition]]
        Results under each of the assembly errors.
    flank_variant : (gears, flanks) array of int
        Number of each flank's variant.

    Returns
    -------
    dict of arrays
        Arrays with the (...) shapes of LOAD_ARRAYS.
    """
    sorted_results = [
        sorted(results, key=lambda result: (result.torque, result.position)) for results in variants
    ]
    cases = [case for results in sorted_results for case in results]
    arrays = {
        "variant": np.repeat(np.arange(len(sorted_results)), [len(results) for results in sorted_results]),
        "flank_variant": np.asarray(flank_variant),
        "torque_n_m": np.array([case.torque for case in cases]),
        "position": np.array([case.position for case in cases]),
    }
    spots = [(number, spot) for number, case in enumerate(cases) for spot in case.spots]
    for body, part in zip(BODIES, ("on_pinion", "on_gear"), strict=True):
        forces = np.array([getattr(spot, part) for _, spot in spots])
        row, node = np.nonzero(forces)
        arrays[f"{body}_case"] = np.array([number for number, _ in spots])[row]
        arrays[f"{body}_tooth"] = np.array([spot.tooth for _, spot in spots])[row]
        arrays[f"{body}_node"] = node
        arrays[f"{body}_force_n"] = forces[row, node]
    arrays["nodes"] = np.array([spots[0][1].on_pinion.size, spots[0][1].on_gear.size])
    return arrays


def loads_by_tooth(
    arrays: Arrays, body: str, flank_nodes: int | None = None, variant: int = 0
) -> dict[int, sp.csr_matrix]:
    """Return the forces on each loaded tooth of one variant, torque by torque and position by position.

    Parameters
    ----------
    arrays : Arrays
        Arrays as LOAD_ARRAYS.
    body : str
        `pinion` or `face_gear`.
    flank_nodes : int, optional
        Number of nodes on the flank, beyond which loads in the body's own fillet are left out; None keeps
        them.
    variant : int
        Number of the variant.

    Returns
    -------
    dict of sparse matrices
        Forces (cases, nodes) by tooth, N.
    """
    cases = np.flatnonzero(arrays["variant"] == variant)
    shape = cases.size, int(arrays["nodes"][BODIES.index(body)])
    case, tooth, node, force = (arrays[f"{body}_{name}"] for name in ("case", "tooth", "node", "force_n"))
    in_variant = arrays["variant"][case] == variant
    case, tooth, node, force = (
        case[in_variant] - cases[0],
        tooth[in_variant],
        node[in_variant],
        force[in_variant],
    )
    force = force if flank_nodes is None else np.where(node < flank_nodes, force, 0.0)
    return {
        int(number): sp.csr_matrix((force[on], (case[on], node[on])), shape=shape)
        for number in np.unique(tooth)
        for on in [tooth == number]
    }


REACTION_COLUMNS = ("torque_n_m", "tangential_n", "axial_n", "overturning_n_m")
"""Columns of the table of contact reactions on the pinion; units stand in the names."""


def touching_reactions(surface: PinionSurface, results: Sequence[LoadedPosition]) -> pd.DataFrame:
    """Tabulate the mean reactions over the mesh cycle, one row a torque.

    Sums of f . n over all loads, n the pinion's outward normal in the mesh frame. `tangential_n`: force
    on the gear along x, the pinion's tangent. `axial_n`: force along the gear's axis that pushes pinion
    and gear apart. `overturning_n_m`: moment of the forces on the pinion about x through the crossing of
    the nominal axes.

    Parameters
    ----------
    surface : PinionSurface
        Contact surface of the pinion.
    results : Sequence[LoadedPosition]
        Contact by position and torque.

    Returns
    -------
    pd.DataFrame
        Columns REACTION_COLUMNS.
    """
    rows = [(result.torque, *_reactions(surface, result)) for result in results]
    table = pd.DataFrame(rows, columns=list(REACTION_COLUMNS))
    return table.groupby("torque_n_m", as_index=False).mean()


def _reactions(surface: PinionSurface, result: LoadedPosition) -> Array:
    """Return tangential force, axial force and overturning moment (3,), N, N and N m, at one position and
    torque.

    Their signs are those of `touching_reactions`; they are sums over all pairs of teeth, 0 without load.
    """
    parts = [_of_spot(surface, result.position, spot) for spot in result.spots]
    return np.sum(parts, axis=0) if parts else np.zeros(3)


def _of_spot(surface: PinionSurface, position: float, spot: Spot) -> Array:
    """Return tangential force, axial force and overturning moment (3,), N, N and N m, of one pair of
    teeth.

    `position` is the mesh position in pitches. Forces are turned from the pinion's body frame to the mesh
    frame and tilted by the shaft angle error.
    """
    design = surface.design
    points = surface.exact(np.stack(np.divmod(spot.hats, surface.shape[1]), axis=-1).astype(float))
    angle = pinion_angle(design, position) + (spot.tooth - 0.5) * 2.0 * np.pi / design.pinion.teeth
    matrix = body_rotation("pinion", angle)
    tilt = rotation(np.array([1.0, 0.0, 0.0]), design.assembly.shaft_angle_error)
    middle = np.array([0.0, design.mean_radius, 0.0])
    force = (spot.force[:, None] * points.normal) @ (tilt @ matrix).T
    from_middle = (points.position @ matrix.T - middle) @ tilt.T
    about = from_middle[:, 1] * force[:, 2] - from_middle[:, 2] * force[:, 1]
    axial = -force[:, 2].sum()
    return np.array([force[:, 0].sum(), axial, design.mean_radius * axial - about.sum()])
