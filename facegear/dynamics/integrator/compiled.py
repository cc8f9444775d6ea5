"""A system at one speed, packed for the compiled kernels, with time counted as mesh phase s in rad."""

from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from facegear.arrays import Array, Integers
from facegear.by_content import kept_by_content
from facegear.dynamics.integrator.blocks import Blocks, Coupled, blocks_of, coupled_of, nonzero
from facegear.dynamics.integrator.coupling import Coupling
from facegear.dynamics.integrator.system import System
from facegear.machine_code.memory import aligned, divided, padded, whole_lanes
from facegear.machine_code.records import Record
from facegear.mesh_law.linear import fourier_columns

TAU = 2.0 * np.pi
MIN_CLEARANCE = 1e-12


@Record.register
class Rings(NamedTuple):
    """Bearings with clearance.

    Attributes
    ----------
    number
        Their number R.
    first
        The first of their 3 R rows among the meshes.
    stiffness
        Over w^2, padded.
    clearance
        Padded.
    lag
        w times damping over stiffness.
    """

    number: int
    first: int
    stiffness: Array
    clearance: Array
    lag: float


@Record.register
class Rubbing(NamedTuple):
    """Forces of friction: their number K, the flank (K,) of each, its ratio as Fourier columns, and the
    direction (K, n) in which it acts.
    """

    number: int
    flank: Integers
    ratios: Array
    directions: Array


@Record.register
class Sparse(NamedTuple):
    """A matrix row by row: the entries of row i are those from starts[i] to starts[i + 1], which are left out
    where they are zero but for rounding.
    """

    starts: Integers
    columns: Integers
    values: Array


@Record.register
class Packed(NamedTuple):
    """Arrays padded to whole SIMD lanes; padded meshes and coordinates are zero and stay at rest.

    Derivatives are by s = w t. Fourier series are (harmonics + 1, 2, width), sine part first. Without any,
    `rings`, `rubbing` and `coupled` are None, and the kernels are compiled without them: another type, of
    these or of the law, is another machine code.

    Attributes
    ----------
    n, m
        Count the real coordinates and meshes.
    mesh_jacobian, transposed
        (n, m) and (m, n).
    touched, touching
        The same without zeros and padding, by mesh and by coordinate.
    omega_squared, load
        Over w^2.
    damping, mesh_damping
        Over w.
    lower, upper : (m,)
        Edges of the clearance.
    law
        The contacts' law as facegear.mesh_law.terms takes it, over w^2, smooth in s from one of `breaks`
        (rad) to the next.
    error
        One column for each of the kinds of mesh that differ in phase.
    error_kind : (m,)
        Which of them a mesh has.
    drift : (terms, m)
        Polynomial in s added to the error of this period, or none.
    breaks
        Phases at which the law is not smooth, rad.
    weights : (n,)
        Largest motion along a mesh that one unit of each coordinate makes.
    leverage : (m,)
        Sum of squares of a row of mesh_jacobian.
    fastest
        Bound of the angular frequency over w.
    damping_when_open, push_only
        As of System; push_only where it makes a difference.
    pairs
        Meshes whose two flanks stand at j and j + pairs; 0 where every mesh stands for itself.
    scale
        The length that tolerances mean.
    contacts
        Rows of the m that are meshes or flanks; the others belong to the rings of bearings with clearance.
    rings, rubbing
        Bearings with clearance, and friction.
    coupled
        What couples coordinates beside the meshes.
    """

    n: int
    m: int
    mesh_jacobian: Array
    transposed: Array
    touched: Sparse
    touching: Sparse
    omega_squared: Array
    damping: Array
    mesh_damping: Array
    lower: Array
    upper: Array
    law: Any
    error: Array
    error_kind: Integers
    drift: Array
    load: Array
    breaks: Array
    weights: Array
    leverage: Array
    fastest: float
    damping_when_open: bool
    push_only: bool
    pairs: int
    scale: float
    contacts: int
    rings: Rings | None
    rubbing: Rubbing | None
    coupled: Coupled | None


def pack(system: System, frequency: float) -> Packed:
    """Pack a system at an angular mesh frequency w in rad/s."""
    at_unit_speed, square = _packed(system), frequency**2
    natural, harmonics = _fastest(system)
    coupling = system.coupling
    return at_unit_speed._replace(
        omega_squared=divided(at_unit_speed.omega_squared, square),
        damping=divided(at_unit_speed.damping, frequency),
        mesh_damping=divided(at_unit_speed.mesh_damping, frequency),
        law=system.law.terms(frequency, len(at_unit_speed.mesh_damping)),
        load=divided(at_unit_speed.load, square),
        fastest=natural / frequency + harmonics + (coupling.fastest(frequency) if coupling else 0.0),
        rings=_rings(system, frequency),
        coupled=_coupled(coupling, frequency, _blocks(system)) if coupling else None,
    )


@lru_cache(maxsize=16)
def _packed(system: System) -> Packed:
    """What pack() gives at 1 rad/s, without law and rings; its arrays are shared and only read."""
    m, n = system.mesh_jacobian.shape
    width_n, width_m = whole_lanes(n), whole_lanes(m)
    jacobian = _jacobian(system.mesh_jacobian)
    # A clearance within rounding of the deflections is none: its edges could not be distinguished.
    closed = system.upper - system.lower <= MIN_CLEARANCE * system.scale
    lower = np.where(closed, system.upper, system.lower)
    return Packed(
        n=n,
        m=m,
        mesh_jacobian=jacobian.by_coordinate,
        transposed=jacobian.by_mesh,
        touched=jacobian.touched,
        touching=jacobian.touching,
        omega_squared=padded(system.omega_squared, width_n),
        damping=padded(system.damping, width_n),
        mesh_damping=padded(system.mesh_damping, width_m),
        lower=padded(lower, width_m),
        upper=padded(system.upper, width_m),
        law=None,
        error=fourier_columns(system.error),
        error_kind=system.error_kind,
        drift=np.zeros((0, width_m)),
        load=fourier_columns(system.load),
        breaks=system.law.breaks * TAU,
        weights=padded(_weights(system), width_n),
        leverage=jacobian.leverage,
        fastest=sum(_fastest(system)),
        damping_when_open=system.damping_when_open,
        push_only=system.push_only and not system.damping_when_open and bool(system.mesh_damping.any()),
        pairs=system.pairs,
        scale=system.scale,
        contacts=system.contacts,
        rings=None,
        rubbing=_rubbing(system),
        coupled=None,
    )


class _Jacobian(NamedTuple):
    """A mesh Jacobian as Packed has it."""

    by_coordinate: Array
    by_mesh: Array
    touched: Sparse
    touching: Sparse
    leverage: Array


@kept_by_content(4)
def _jacobian(rows: Array) -> _Jacobian:
    """Of rows (m, n); many systems share it."""
    m, n = rows.shape
    by_mesh = aligned(whole_lanes(m), whole_lanes(n))
    by_mesh[:m, :n] = rows
    by_coordinate = aligned(*by_mesh.shape[::-1])
    by_coordinate[:] = by_mesh.T
    return _Jacobian(by_coordinate, by_mesh, _sparse(rows), _sparse(rows.T), (by_mesh**2).sum(axis=1))


def _weights(system: System) -> Array:
    """Largest motion along a mesh or a force of friction that one unit of each coordinate makes, (n,)."""
    rows = [system.mesh_jacobian]
    if system.rubbing is not None:
        rows.append(system.rubbing.directions)
    return np.asarray(np.abs(np.concatenate(rows)).max(axis=0))


def _rubbing(system: System) -> Rubbing | None:
    if system.rubbing is None:
        return None
    count, n = system.rubbing.directions.shape
    directions = aligned(count, whole_lanes(n))
    directions[:, :n] = system.rubbing.directions
    return Rubbing(count, system.rubbing.flank, fourier_columns(system.rubbing.ratios), directions)


def _sparse(matrix: Array) -> Sparse:
    kept = nonzero(matrix)
    starts = np.append(0, np.cumsum(kept.sum(axis=1)))
    return Sparse(starts, np.ascontiguousarray(np.nonzero(kept)[1]), matrix[kept])


def _rings(system: System, frequency: float) -> Rings | None:
    count = system.ring_clearance.size
    if count == 0:
        return None
    return Rings(
        number=count,
        first=system.contacts,
        stiffness=divided(padded(system.ring_stiffness, whole_lanes(count)), frequency**2),
        clearance=padded(system.ring_clearance, whole_lanes(count)),
        lag=system.ring_lag * frequency,
    )


def _coupled(coupling: Coupling, frequency: float, blocks: Blocks) -> Coupled:
    velocity, displacement = coupling.velocity_terms(frequency), coupling.displacement_terms(frequency)
    more = whole_lanes(len(velocity)) - len(velocity)
    return coupled_of(blocks, np.pad(velocity, (0, more)), np.pad(displacement, (0, more)))


@lru_cache(maxsize=16)
def _blocks(system: System) -> Blocks:
    """Those of the mesh Jacobian; its arrays are shared and only read."""
    return blocks_of(_packed(system).transposed)


@lru_cache(maxsize=16)
def _fastest(system: System) -> tuple[float, float]:
    """Largest natural frequency with all meshes in contact plus damping, 1/s, and the harmonics of the law
    that matter, in multiples of the mesh frequency.
    """
    contacts = system.contacts
    mesh = np.zeros(len(system.mesh_jacobian))
    mesh[:contacts] = system.law.steepest
    mesh[contacts::3] = mesh[contacts + 1 :: 3] = system.ring_stiffness
    dampers = system.mesh_damping.copy()
    dampers[contacts::3] = dampers[contacts + 1 :: 3] = system.ring_lag * system.ring_stiffness
    stiffest = _largest_root(system.omega_squared, system.mesh_jacobian, mesh)
    natural = np.sqrt(max(stiffest, 0.0)) + _largest_root(system.damping, system.mesh_jacobian, dampers)
    fractions = system.law.harmonic_fractions
    harmonics = (np.arange(fractions.size) * fractions ** (1.0 / 8.0)).max()
    return float(natural), float(harmonics)


@kept_by_content(8)
def _largest_root(own: Array, rows: Array, factors: Array) -> float:
    """Largest eigenvalue of diag(own (n,)) + rows^T diag(factors (m,)) rows, rows (m, n)."""
    return float(np.linalg.eigvalsh(np.diag(own) + (rows.T * factors) @ rows)[-1])
