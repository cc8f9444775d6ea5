"""The forces of all contacts on the nodes of both contact surfaces before refinement."""

from collections.abc import Mapping, Sequence

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from facegear.contact.position import LoadedPosition

BODIES = ("pinion", "face_gear")


def load_arrays(results: Sequence[LoadedPosition]) -> dict[str, NDArray]:
    """Contact forces as LOAD_ARRAYS: cases by torque and position, and loaded nodes by case and tooth.

    Nodes count along each row of the contact surface's lattice before refinement; the force (N) acts against
    the surface's outward normal.
    """
    cases = sorted(results, key=lambda result: (result.torque, result.position))
    arrays = {
        "torque_n_m": np.array([case.torque for case in cases]),
        "position": np.array([case.position for case in cases]),
    }
    spots = [(number, spot) for number, case in enumerate(cases) for spot in case.spots]
    for body, part in zip(BODIES, ("on_pinion", "on_gear"), strict=True):
        forces = [getattr(spot, part) for _, spot in spots]
        nodes = [np.flatnonzero(force) for force in forces]
        counts = [node.size for node in nodes]
        arrays[f"{body}_case"] = np.repeat([number for number, _ in spots], counts)
        arrays[f"{body}_tooth"] = np.repeat([spot.tooth for _, spot in spots], counts)
        arrays[f"{body}_node"] = np.concatenate(nodes)
        arrays[f"{body}_force_n"] = np.concatenate([f[n] for f, n in zip(forces, nodes, strict=True)])
    arrays["nodes"] = np.array([spots[0][1].on_pinion.size, spots[0][1].on_gear.size])
    return arrays


def loads_by_tooth(
    arrays: Mapping[str, NDArray], body: str, flank_nodes: int | None = None
) -> dict[int, sp.csr_matrix]:
    """Forces (cases, nodes), N, on each loaded tooth of `pinion` or `face_gear`, from LOAD_ARRAYS.

    With `flank_nodes` those on later nodes, which lie in the body's own fillet, are left out.
    """
    shape = arrays["torque_n_m"].size, int(arrays["nodes"][BODIES.index(body)])
    case, tooth, node, force = (arrays[f"{body}_{name}"] for name in ("case", "tooth", "node", "force_n"))
    force = force if flank_nodes is None else np.where(node < flank_nodes, force, 0.0)
    return {
        int(number): sp.csr_matrix((force[on], (case[on], node[on])), shape=shape)
        for number in np.unique(tooth)
        for on in [tooth == number]
    }
