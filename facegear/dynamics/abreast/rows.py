"""A machine as one row of numbers, and what machines that run side by side have in common."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from facegear.arrays import Array, Integers
from facegear.dynamics.integrator.compiled import Packed, Sparse
from facegear.mesh_law.linear_terms import LinearTerms


class Structure(NamedTuple):
    """What machines must share to run side by side.

    n, m: coordinates and contacts. touched, touching: where the mesh Jacobian has entries, by contact and by
    coordinate; entry: which of the former each of the latter is. law_kind, error_kind (m,): the series of
    stiffness and of transmission error that a contact has. harmonics of the law, the error and the load, and
    kinds of law and error. offsets: where each of FIELDS begins in a machine's row, and where the last ends.
    damping_when_open: whether dampers act on open contacts. opens: whether a contact may open.
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


FIELDS = (
    "omega_squared",
    "damping",
    "weights",
    "jacobian",
    "mesh_damping",
    "lower",
    "upper",
    "law",
    "error",
    "load",
    "scale",
)
OMEGA, DAMPING, WEIGHTS, JACOBIAN, MESH_DAMPING, LOWER, UPPER, LAW, ERROR, LOAD, SCALE = range(len(FIELDS))


def may_run_abreast(packed: Packed) -> bool:
    """Whether the lanes have the physics of a machine: linear laws without breaks, all but rings and friction
    of flanks, contacts that only push, coupling beside the meshes.
    """
    others = (packed.rings, packed.rubbing, packed.coupled)
    plain = isinstance(packed.law, LinearTerms) and not packed.breaks.size and not packed.push_only
    return plain and others == (None, None, None)


@dataclass(frozen=True)
class Row:
    """The numbers (P,) of a machine, their structure, and a key that is the same for the same structure."""

    values: Array
    structure: Structure
    key: tuple[object, ...]


def row_of(packed: Packed) -> Row:
    """The row of a machine that may run abreast."""
    n, m = packed.n, packed.m
    law, error = packed.law.fourier, packed.error
    law_kinds, error_kinds = int(packed.law.kind.max()) + 1, int(packed.error_kind.max()) + 1
    parts = (
        packed.omega_squared[:n],
        packed.damping[:n],
        packed.weights[:n],
        packed.touched.values,
        packed.mesh_damping[:m],
        packed.lower[:m],
        packed.upper[:m],
        law[:, :, :law_kinds].ravel(),
        error[:, :, :error_kinds].ravel(),
        packed.load[:, :, :n].ravel(),
        np.array([packed.scale]),
    )
    back, entry = _by_coordinate(packed.touched, n)
    opens = bool((packed.lower[:m] < packed.upper[:m]).any())
    structure = Structure(
        n=n,
        m=m,
        starts=packed.touched.starts,
        columns=packed.touched.columns,
        back_starts=back.starts,
        back_rows=back.columns,
        entry=entry,
        law_kind=packed.law.kind,
        error_kind=packed.error_kind,
        law_terms=len(law),
        error_terms=len(error),
        load_terms=len(packed.load),
        law_kinds=law_kinds,
        error_kinds=error_kinds,
        damping_when_open=packed.damping_when_open,
        opens=opens,
        offsets=np.append(0, np.cumsum([part.size for part in parts])),
    )
    key = tuple(part.tobytes() if isinstance(part, np.ndarray) else part for part in structure)
    return Row(np.concatenate(parts), structure, key)


def _by_coordinate(touched: Sparse, n: int) -> tuple[Sparse, Integers]:
    """The rows of each coordinate, and the numbers of their entries among those by row."""
    rows = np.repeat(np.arange(touched.starts.size - 1), np.diff(touched.starts))
    entry = np.argsort(touched.columns, kind="stable")
    starts = np.append(0, np.cumsum(np.bincount(touched.columns, minlength=n)))
    return Sparse(starts, rows[entry], touched.values[entry]), entry
