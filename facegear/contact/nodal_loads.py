"""The forces of all contacts on the nodes of both contact surfaces before refinement."""

from collections.abc import Sequence

import numpy as np
import scipy.sparse as sp

from facegear.arrays import AnyArray, Arrays, Integers
from facegear.contact.position import LoadedPosition
from facegear.geometry.bodies import BODIES


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
