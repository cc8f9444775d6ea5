"""A sector of teeth meshed whole and condensed at once: the model that other solvers are given too.

Costs as much as general finite elements do and is used to compare with them; the chain uses `ring` instead.
"""

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from facegear.contact.bodies.layer import TiedSystem, tied_system
from facegear.contact.bodies.substructure import loaded_compliance
from facegear.contact.candidates import Candidates
from facegear.contact.influence import product
from facegear.contact.ltca import ContactModel, LoadedPosition, Place, solve_position
from facegear.contact.options import ContactOptions, Refinement
from facegear.contact.search import find_candidates
from facegear.contact.teeth import LOADED_SIDE, piece_of
from facegear.geometry.design import Material, PairDesign
from facegear.mesh.sector import sector
from facegear.mesh.tooth import ToothMesh

Blocks = dict[tuple[int, int], NDArray[np.float64]]


def sector_blocks(
    design: PairDesign, tooth: ToothMesh, material: Material, teeth: int, loaded: Sequence[int]
) -> Blocks:
    """Flank compliance (n, n), m/N, for each pair of `loaded` teeth (seen, loaded) of a sector, cut faces
    free.
    """
    merged = sector(tooth, teeth, -(teeth // 2))
    single, side = piece_of(design, tooth, material, LOADED_SIDE[tooth.body])
    held = np.zeros(merged.nodes.shape, dtype=bool)
    flanks, normals = [], []
    for j, nodes in enumerate(merged.tooth_nodes):
        held[nodes[single.held.all(axis=1)]] = True
        if merged.first + j in loaded:
            flanks.append(nodes[single.flank])
            normals.append(tooth.rotated(single.normals, (merged.first + j) * tooth.pitch))
    size = side.nodes.size
    piece = replace(
        single,
        points=merged.nodes,
        hexes=merged.hexes,
        held=held,
        left=side.nodes[:0, 0],
        right=side.nodes[:0, 0],
    )
    system, place = _system(piece, flanks, normals)
    whole = loaded_compliance(piece, system)[np.ix_(place, place)]
    return {
        (seen, load): whole[i * size : (i + 1) * size, j * size : (j + 1) * size]
        for i, seen in enumerate(sorted(loaded))
        for j, load in enumerate(sorted(loaded))
    }


def _system(piece, flanks, normals) -> tuple[TiedSystem, NDArray[np.int64]]:  # type: ignore[no-untyped-def]
    """The unrefined system with the flanks of several teeth loaded, and each flank node's place in it."""
    plain = tied_system(replace(piece, flank=flanks[0], normals=normals[0]), Refinement())
    nodes = np.concatenate([flank.ravel() for flank in flanks])
    _, loaded = cKDTree(plain.points).query(piece.points[nodes])
    order = np.argsort(loaded)
    outward = np.concatenate([normal.reshape(-1, 3) for normal in normals])
    return replace(plain, loaded=loaded[order], loaded_normals=outward[order]), np.argsort(order)


def analyse_sector(
    model: ContactModel,
    pinion: Blocks,
    gear: Blocks,
    place: Place,
    angles: tuple[float, float],
    torques: Sequence[float],
) -> list[LoadedPosition]:
    """Solve one position with sector compliances; surface and lattice of `model` must be unrefined."""
    loaded = np.array(sorted({seen for seen, _ in pinion}))
    options = ContactOptions()

    def find(limit: float) -> list[Candidates]:
        return find_candidates(model.surface, model.lattice, *angles, loaded, limit, options)

    combine = partial(_influence, pinion=pinion, gear=gear)
    results, _ = solve_position(find, combine, place, torques, 40e-6 / place.base_radius)
    return results


def _influence(pairs: list[Candidates], pinion: Blocks, gear: Blocks) -> NDArray[np.float64]:
    matrix = np.block(
        [
            [
                product(first.pinion, pinion[first.tooth, second.tooth], second.pinion)
                + product(first.gear, gear[first.tooth, second.tooth], second.gear)
                for second in pairs
            ]
            for first in pairs
        ]
    )
    return 0.5 * (matrix + matrix.T)
