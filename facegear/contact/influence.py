"""Compliance between candidate hats of a position: both bodies, own teeth and neighbours."""

from collections.abc import Sequence

import numpy as np
import scipy.sparse as sp

from facegear.arrays import AnyArray, Array, Integers
from facegear.contact.bodies.compliance import FlankCompliance
from facegear.contact.candidates import Candidates
from facegear.machine_code.compiler import compiler

compiled = compiler()

Sparse = tuple[AnyArray, AnyArray, AnyArray]
"""Row ends, columns and values of a sparse matrix in rows."""


def influence_matrix(
    pairs: list[Candidates],
    pinion: FlankCompliance,
    gear: FlankCompliance,
    coupled: bool = True,
) -> Array:
    """Approach (m, m) of hat i by a unit force on hat j, m/N, hats of all pairs in order; symmetric.

    `coupled` False leaves out the coupling between neighbouring teeth, for comparison.
    """
    ends = np.cumsum([0] + [len(pair.hats) for pair in pairs])
    matrix = np.zeros((ends[-1], ends[-1]))
    for i, first in enumerate(pairs):
        own = slice(ends[i], ends[i + 1])
        block = product(first.pinion, pinion.own, first.pinion) + product(first.gear, gear.own, first.gear)
        matrix[own, own] = 0.5 * (block + block.T)
        for j in range(i) if coupled else ():
            second = pairs[j]
            other = slice(ends[j], ends[j + 1])
            teeth_apart = first.tooth - second.tooth
            block = product(first.pinion_coarse, pinion.block(teeth_apart), second.pinion_coarse)
            block += product(first.gear_coarse, gear.block(teeth_apart), second.gear_coarse)
            matrix[own, other] = block
            matrix[other, own] = block.T
    return matrix


def displacement(
    seen: list[Candidates],
    pairs: list[Candidates],
    forces: Array,
    pinion: FlankCompliance,
    gear: FlankCompliance,
    coupled: bool = True,
) -> Array:
    """Approach (k, t) m at the hats of `seen` by forces (m, t) N on those of `pairs`, t load cases."""
    ends = np.cumsum([len(pair.hats) for pair in pairs])[:-1]
    loads = list(zip(pairs, np.split(forces, ends), strict=True))
    return np.concatenate([_approach(here, loads, pinion, gear, coupled) for here in seen])


def _approach(
    here: Candidates,
    loads: Sequence[tuple[Candidates, Array]],
    pinion: FlankCompliance,
    gear: FlankCompliance,
    coupled: bool,
) -> Array:
    total = np.zeros((len(here.hats), loads[0][1].shape[1]))
    for pair, force in loads:
        teeth_apart = here.tooth - pair.tooth
        if teeth_apart == 0:
            total += _response(here.pinion, pinion.own, pair.pinion, force)
            total += _response(here.gear, gear.own, pair.gear, force)
        elif coupled:
            total += _response(here.pinion_coarse, pinion.block(teeth_apart), pair.pinion_coarse, force)
            total += _response(here.gear_coarse, gear.block(teeth_apart), pair.gear_coarse, force)
    return total


def _response(
    seen: sp.csr_matrix,
    compliance: Array | None,
    loads: sp.csr_matrix,
    forces: Array,
) -> Array:
    if compliance is None:
        return np.zeros((seen.shape[0], forces.shape[1]))
    touching = (seen.indptr, seen.indices, seen.data), (loads.indptr, loads.indices, loads.data)
    return _sparse_response(touching[0], compliance, touching[1], np.ascontiguousarray(forces))


@compiled
def _sparse_response(seen: Sparse, compliance: Array, loads: Sparse, forces: Array) -> Array:
    loaded, slot = _used(loads[1], compliance.shape[1])
    nodal = np.zeros((loaded.size, forces.shape[1]))
    for i in range(forces.shape[0]):
        for k in range(loads[0][i], loads[0][i + 1]):
            for t in range(forces.shape[1]):
                nodal[slot[loads[1][k]], t] += loads[2][k] * forces[i, t]
    used, slot = _used(seen[1], compliance.shape[0])
    return _averaged(seen[0], slot[seen[1]], seen[2], _gathered(compliance, used, loaded) @ nodal)


def product(first: sp.csr_matrix, compliance: Array | None, second: sp.csr_matrix) -> Array:
    """first @ compliance @ second.T, touching only what the two have entries for."""
    if compliance is None:
        return np.zeros((first.shape[0], second.shape[0]))
    return _sparse_product(
        (first.indptr, first.indices, first.data),
        compliance,
        (second.indptr, second.indices, second.data),
    )


@compiled
def _sparse_product(first: Sparse, compliance: Array, second: Sparse) -> Array:
    rows, row_slot = _used(first[1], compliance.shape[0])
    columns, column_slot = _used(second[1], compliance.shape[1])
    part = _gathered(compliance, rows, columns)
    half = _averaged(first[0], row_slot[first[1]], first[2], part)
    return _averaged(second[0], column_slot[second[1]], second[2], np.ascontiguousarray(half.T)).T


@compiled
def _gathered(dense: Array, rows: Integers, columns: Integers) -> Array:
    """dense[np.ix_(rows, columns)], contiguous."""
    part = np.empty((rows.size, columns.size))
    for a in range(rows.size):
        line = dense[rows[a]]
        for b in range(columns.size):
            part[a, b] = line[columns[b]]
    return part


@compiled
def _used(indices: Integers, count: int) -> tuple[Integers, Integers]:
    """The distinct indices, rising, and the index of each among them."""
    mark = np.zeros(count, np.bool_)
    for index in indices:
        mark[index] = True
    used = np.flatnonzero(mark)
    slot = np.full(count, -1)
    slot[used] = np.arange(used.size)
    return used, slot


@compiled
def _averaged(pointer: Integers, index: Integers, weight: Array, dense: Array) -> Array:
    """Sparse rows times a dense matrix."""
    result = np.zeros((pointer.size - 1, dense.shape[1]))
    for i in range(pointer.size - 1):
        row = result[i]
        for k in range(pointer[i], pointer[i + 1]):
            line, w = dense[index[k]], weight[k]
            for c in range(dense.shape[1]):
                row[c] += w * line[c]
    return result
