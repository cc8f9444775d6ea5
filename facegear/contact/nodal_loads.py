"""The forces of all contacts on the nodes of both contact surfaces before refinement."""

from collections.abc import Sequence

import numpy as np
import scipy.sparse as sp

from facegear.arrays import AnyArray, Arrays, Integers
from facegear.contact.position import LoadedPosition
from facegear.geometry.bodies import BODIES


def load_arrays(variants: Sequence[Sequence[LoadedPosition]], flank_variant: Integers) -> dict[str, AnyArray]:
    """Contact forces as LOAD_ARRAYS: cases by variant, torque and position, loaded nodes by case and tooth.

    `variants`: results under each of the assembly errors; `flank_variant` (gears, flanks) numbers them.
    Nodes count along each row of the contact surface's lattice before refinement; the force (N) acts against
    the surface's outward normal.
    """
    ordered = [sorted(results, key=lambda result: (result.torque, result.position)) for results in variants]
    cases = [case for results in ordered for case in results]
    arrays = {
        "variant": np.repeat(np.arange(len(ordered)), [len(results) for results in ordered]),
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
    """Forces (cases, nodes), N, on each loaded tooth of `pinion` or `face_gear`, from LOAD_ARRAYS.

    The cases are those of one variant, torque by torque and position by position.
    With `flank_nodes` those on later nodes, which lie in the body's own fillet, are left out.
    """
    cases = np.flatnonzero(arrays["variant"] == variant)
    shape = cases.size, int(arrays["nodes"][BODIES.index(body)])
    case, tooth, node, force = (arrays[f"{body}_{name}"] for name in ("case", "tooth", "node", "force_n"))
    own = arrays["variant"][case] == variant
    case, tooth, node, force = case[own] - cases[0], tooth[own], node[own], force[own]
    force = force if flank_nodes is None else np.where(node < flank_nodes, force, 0.0)
    return {
        int(number): sp.csr_matrix((force[on], (case[on], node[on])), shape=shape)
        for number in np.unique(tooth)
        for on in [tooth == number]
    }
