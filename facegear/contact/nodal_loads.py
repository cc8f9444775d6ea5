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
from facegear.contact.position import LoadedPosition
from facegear.quantities import BODIES
from facegear.teeth.design import PairDesign
from facegear.teeth.placement import RigidMotion, pinion_angle, pinion_to_gear


def load_arrays(variants: Sequence[Sequence[LoadedPosition]], flank_variant: Integers) -> dict[str, AnyArray]:
    """Collect contact forces as LOAD_ARRAYS: cases by variant, torque and position, loaded nodes by case and
    tooth.

    Nodes count along each row of the contact surface's lattice before refinement; the force (N) acts
    against the surface's outward normal. `nodes` are the numbers of the variant that has the most.

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
    nodes: list[int] = []
    for body, part in zip(BODIES, ("on_pinion", "on_gear"), strict=True):
        of_spots = [getattr(spot, part) for _, spot in spots]
        # flanks of different bodies may differ in their numbers of nodes; matrices of forces have the most
        forces = np.zeros((len(of_spots), max(values.size for values in of_spots)))
        for number, values in enumerate(of_spots):
            forces[number, : values.size] = values
        nodes.append(forces.shape[1])
        row, node = np.nonzero(forces)
        arrays[f"{body}_case"] = np.array([number for number, _ in spots])[row]
        arrays[f"{body}_tooth"] = np.array([spot.tooth for _, spot in spots])[row]
        arrays[f"{body}_node"] = node
        arrays[f"{body}_force_n"] = forces[row, node]
    arrays["nodes"] = np.array(nodes)
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
    torque, in the signs of `touching_reactions`; 0 without load.
    """
    errors = surface.design.assembly
    force, moment = np.split(contact_wrenches(surface, [result])[0], 2)
    return np.array([force[0], -force[2], -(moment[0] + errors.gear_axial * force[1])])


WRENCH_COLUMNS = (
    *("torque_n_m", "position", "force_x_n", "force_y_n", "force_z_n"),
    *("moment_x_n_m", "moment_y_n_m", "moment_z_n_m", "pinion_axial_n"),
)
"""Columns of the table of contact wrenches; units stand in the names."""


def wrench_table(surface: PinionSurface, results: Sequence[LoadedPosition]) -> pd.DataFrame:
    """Tabulate the wrench of the pinion on the gear at each torque and position.

    Parameters
    ----------
    surface : PinionSurface
        Contact surface of the pinion.
    results : Sequence[LoadedPosition]
        Contact by position and torque.

    Returns
    -------
    pd.DataFrame
        Columns WRENCH_COLUMNS: `contact_wrenches`, and the force on the pinion outwards along its own axis.
    """
    outwards = _pinion_motion(surface.design, np.zeros(1), np.zeros(1)).directions(
        np.array([[0.0, 1.0, 0.0]])
    )[0, 0]
    wrenches = contact_wrenches(surface, results)
    loads = np.array([(result.torque, result.position) for result in results]).reshape(-1, 2)
    columns = np.column_stack([loads, wrenches, -wrenches[:, :3] @ outwards])
    return pd.DataFrame(columns, columns=list(WRENCH_COLUMNS))


def contact_wrenches(surface: PinionSurface, results: Sequence[LoadedPosition]) -> Array:
    """Compute force and moment of the pinion on the gear at positions and torques, without friction.

    Parameters
    ----------
    surface : PinionSurface
        Contact surface of the pinion.
    results : Sequence[LoadedPosition]
        Contact by position and torque, r of them.

    Returns
    -------
    (r, 6) array
        Force, N, and moment about the origin, N m, in the mesh frame; 0 without load.
    """
    design, wrenches = surface.design, np.zeros((len(results), 6))
    spots = [(row, result.position, spot) for row, result in enumerate(results) for spot in result.spots]
    if not spots:
        return wrenches
    rows, positions, of_spots = zip(*spots, strict=True)
    count = [spot.hats.size for spot in of_spots]
    hats, force = (np.concatenate([getattr(spot, name) for spot in of_spots]) for name in ("hats", "force"))
    points = surface.exact(np.stack(np.divmod(hats, surface.shape[1]), axis=-1).astype(float))
    teeth = np.array([float(spot.tooth) for spot in of_spots])
    motion = _pinion_motion(design, pinion_angle(design, positions), teeth)
    motion = motion.only(np.repeat(np.arange(len(spots)), count))
    forces = force[:, None] * motion.directions(points.normal[:, None])[:, 0]
    moments = np.cross(motion.points(points.position[:, None])[:, 0], forces)
    np.add.at(wrenches, np.repeat(rows, count), np.concatenate([forces, moments], axis=1))
    return wrenches


def _pinion_motion(design: PairDesign, phi1: Array, tooth: Array) -> RigidMotion:
    """Return the motions (p,) from the body frame of the pinion's tooth 0 to the mesh frame, where the pinion
    stands at angles phi1 (p,) rad and the tooth is number `tooth` (p,).
    """
    return pinion_to_gear(design, phi1, -tooth * 2 * np.pi / design.face_gear.teeth, tooth)
