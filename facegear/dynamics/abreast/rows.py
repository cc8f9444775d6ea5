"""A machine as one row of numbers, and what machines that run side by side have in common."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from facegear.arrays import Array, Integers
from facegear.dynamics.integrator.compiled import Packed, Sparse
from facegear.machine_code.records import Record
from facegear.mesh_law.linear_terms import LinearTerms


@Record.register
class Structure(NamedTuple):
    """What machines must share to run side by side.

    n, m: coordinates and contacts. starts, columns: where the mesh Jacobian has entries, contact by contact;
    back_starts, back_rows: the same coordinate by coordinate, entry: which of the former each is. law_kind,
    error_kind (m,): the series of stiffness and of transmission error that a contact has. law_terms,
    error_terms, load_terms: harmonics with the mean; law_kinds, error_kinds: numbers of series.
    damping_when_open: whether dampers act on open contacts. opens: whether a contact may open. offsets: where
    each of OMEGA to TOLERANCE begins in a machine's row, and where the last ends.
    """

    n: int
    m: int
    starts: Integers
    columns: Integers
    back_starts: Integers
    back_rows: Integers
    entry: Integers
    law_kind: Integers
    error_kind: Integers
    law_terms: int
    error_terms: int
    load_terms: int
    law_kinds: int
    error_kinds: int
    damping_when_open: bool
    opens: bool
    offsets: Integers


OMEGA, DAMPING, WEIGHTS, JACOBIAN, MESH_DAMPING, LOWER, UPPER, LAW, ERROR, LOAD, SCALE, TOLERANCE = range(12)
"""Numbers of a machine: `Packed`'s, and the tolerance of its steps."""


def may_run_abreast(packed: Packed) -> bool:
    """Whether the lanes have the physics of a machine: linear laws without breaks in the phase, and neither
    bearings with clearance, nor friction, nor contacts that only push, nor coordinates coupled beside the
    meshes.
    """
    others = packed.rings, packed.rubbing, packed.coupled
    smooth = isinstance(packed.law, LinearTerms) and not packed.breaks.size and not len(packed.drift)
    return smooth and not packed.push_only and all(other is None for other in others)


@dataclass(frozen=True, eq=False)
class Row:
    """The numbers (P,) of a machine and their structure; the key is the same for the same structure."""

    values: Array
    structure: Structure
    key: tuple[object, ...]


def row_of(packed: Packed, tolerance: float) -> Row:
    """The row of a machine that may run abreast, with the tolerance of its steps."""
    n, m = packed.n, packed.m
    law_kinds, error_kinds = int(packed.law.kind.max()) + 1, int(packed.error_kind.max()) + 1
    parts = (
        packed.omega_squared[:n],
        packed.damping[:n],
        packed.weights[:n],
        packed.touched.values,
        packed.mesh_damping[:m],
        packed.lower[:m],
        packed.upper[:m],
        packed.law.fourier[:, :, :law_kinds].ravel(),
        packed.error[:, :, :error_kinds].ravel(),
        packed.load[:, :, :n].ravel(),
        [packed.scale],
        [tolerance],
    )
    back_starts, back_rows, entry = _by_coordinate(packed.touched, n)
    structure = Structure(
        n=n,
        m=m,
        starts=packed.touched.starts,
        columns=packed.touched.columns,
        back_starts=back_starts,
        back_rows=back_rows,
        entry=entry,
        law_kind=packed.law.kind,
        error_kind=packed.error_kind,
        law_terms=len(packed.law.fourier),
        error_terms=len(packed.error),
        load_terms=len(packed.load),
        law_kinds=law_kinds,
        error_kinds=error_kinds,
        damping_when_open=packed.damping_when_open,
        opens=bool((packed.lower[:m] < packed.upper[:m]).any()),
        offsets=np.append(0, np.cumsum([len(part) for part in parts])),
    )
    key = tuple(part.tobytes() if isinstance(part, np.ndarray) else part for part in structure)
    return Row(np.concatenate(parts), structure, key)


def _by_coordinate(touched: Sparse, n: int) -> tuple[Integers, Integers, Integers]:
    """Where the entries of each coordinate begin, their rows, and their numbers among those by row."""
    rows = np.repeat(np.arange(touched.starts.size - 1), np.diff(touched.starts))
    entry = np.argsort(touched.columns, kind="stable")
    starts = np.append(0, np.cumsum(np.bincount(touched.columns, minlength=n)))
    return starts, rows[entry], entry
