"""Convert a system for the kernels (facegear/_kernels/src/motion/system.hpp), also at one mesh frequency."""

from functools import cache, lru_cache, partial
from typing import Any

import numpy as np

from facegear._kernels import motion
from facegear.arrays import Array
from facegear.by_content import kept_by_content
from facegear.motion.integrator.reduction import Coupling
from facegear.motion.integrator.system import System

TAU = 2.0 * np.pi
"""Length of a mesh period in phase, rad."""
MIN_CLEARANCE = 1e-12
"""Clearance, over the length scale, up to which it is rounding."""
_contiguous = partial(np.ascontiguousarray, dtype=float)


def pack(system: System, frequency: float, tolerance: float) -> motion.Machine:
    """Convert a system at one mesh frequency for the kernels.

    Parameters
    ----------
    system : System
        Equations of motion.
    frequency : float
        Angular mesh frequency, rad/s.
    tolerance : float
        Local error of a step over the length scale, dimensionless.

    Returns
    -------
    motion.Machine
        The system at this frequency, with the bound fastest() that limits its steps.
    """
    return motion.machine(packed_system(system), frequency, tolerance, fastest(system, frequency))


def fastest(system: System, frequency: float) -> float:
    """Return a bound of the angular frequencies in the response of a system, over the mesh frequency.

    It is the sum of three: the largest natural frequency plus damping with all meshes in contact at their
    steepest, the largest harmonic of the mesh law that matters, and the bound of the coupling.

    Parameters
    ----------
    system : System
        The system.
    frequency : float
        Angular mesh frequency, rad/s.

    Returns
    -------
    float
        Bound over the mesh frequency, dimensionless.
    """
    natural, harmonics = _fastest(system)
    coupling = system.coupling
    return natural / frequency + harmonics + (coupling.fastest(frequency) if coupling else 0.0)


@lru_cache(maxsize=16)
def packed_system(system: System) -> motion.System:
    """Pack a system for the kernels; the result is cached by identity.

    Parameters
    ----------
    system : System
        The system.

    Returns
    -------
    motion.System
        The system at an angular mesh frequency of 1 rad/s.
    """
    return motion.system(law=system.law.kernel_law, **system_numbers(system))


def system_numbers(system: System) -> dict[str, Any]:
    """Return the numbers of a system at 1 rad/s without its law, by the names of facegear::motion::System.

    Parameters
    ----------
    system : System
        The system.

    Returns
    -------
    dict
        Arrays, numbers and flags in SI units; what `_kernels.motion.system` takes.
    """
    n, rubbing, phase_shifts = system.size, system.rubbing, shift_count(system)
    jacobian = system.mesh_jacobian
    if system.phase_shifts is not None:
        jacobian = np.concatenate([jacobian, system.phase_shifts])
    still = np.zeros(phase_shifts)
    return {
        "jacobian": _contiguous(jacobian),
        "omega_squared": _contiguous(system.omega_squared),
        "damping": _contiguous(system.damping),
        "weights": weights_of(system),
        "mesh_damping": np.append(_contiguous(system.mesh_damping), still),
        # Equal edges: a place is never open.
        "lower": np.append(lower_edges(system), still),
        "upper": np.append(_contiguous(system.upper), still),
        "leverage": (jacobian**2).sum(axis=1),
        "error": _contiguous(_errors(system)),
        "error_kind": np.append(system.error_kind, np.full(phase_shifts, len(system.error))).astype(np.int64),
        "load": _contiguous(system.load),
        "damping_when_open": bool(system.damping_when_open),
        # Without dampers that could pull nothing is cut.
        "push_only": bool(system.push_only and not system.damping_when_open and system.mesh_damping.any()),
        "pairs": system.pairs,
        "scale": float(system.scale),
        "ring_stiffness": _contiguous(system.ring_stiffness),
        "ring_clearance": _contiguous(system.ring_clearance),
        "ring_lag": float(system.ring_lag),
        "rubbing_flank": np.ascontiguousarray([] if rubbing is None else rubbing.flank, np.int64),
        "rubbing_ratios": np.zeros((0, 2, 1)) if rubbing is None else _contiguous(rubbing.ratios),
        "rubbing_directions": np.zeros((0, n)) if rubbing is None else _contiguous(rubbing.directions),
        "coupling": _coupling(system.coupling, n),
    }


def shift_count(system: System) -> int:
    """Return the number of rows that a system has for the places of its contacts in the mesh cycle.

    Parameters
    ----------
    system : System
        The system.

    Returns
    -------
    int
        Its contacts, or 0 where they do not move.
    """
    return 0 if system.phase_shifts is None else len(system.phase_shifts)


def _errors(system: System) -> Array:
    """Return the series (kinds, 2, harmonics + 1) of the errors, m; with places one of zeros for them."""
    if system.phase_shifts is None:
        return system.error
    return np.concatenate([system.error, np.zeros((1, *system.error.shape[1:]))])


@lru_cache(maxsize=16)
def lower_edges(system: System) -> Array:
    """Return the deflection below which each row of a system comes into contact on its lower side.

    A clearance within rounding of the deflections is set to zero: its edges could not be distinguished.

    Parameters
    ----------
    system : System
        The system with m rows.

    Returns
    -------
    (m,) array
        m; the upper edge where a row has no clearance. The array is cached and must not be changed.
    """
    without_clearance = system.upper - system.lower <= MIN_CLEARANCE * system.scale
    return np.where(without_clearance, system.upper, system.lower)


@lru_cache(maxsize=16)
def weights_of(system: System) -> Array:
    """Return the largest motion that one unit of each coordinate makes along a mesh or a friction force.

    Parameters
    ----------
    system : System
        The system with n coordinates.

    Returns
    -------
    Array
        Weights (n,), dimensionless. The array is cached and must not be changed.
    """
    rows = [system.mesh_jacobian]
    if system.rubbing is not None:
        rows.append(system.rubbing.directions)
    return np.asarray(np.abs(np.concatenate(rows)).max(axis=0))


def make_runner(system: System, order: int, in_lanes: bool = False) -> motion.Runner:
    """Allocate the scratch space for runs of machines of one structure.

    Parameters
    ----------
    system : System
        A system of the structure: one with the same sizes and kind of law.
    order : int
        Order of the Taylor steps.
    in_lanes : bool
        Whether machines run side by side, one in each lane of a vector; otherwise one machine runs alone.

    Returns
    -------
    motion.Runner
        The scratch space. Only one run may use it at a time.
    """
    return motion.runner(packed_system(system), order, in_lanes, *_gauss(order // 4 + 1))


@cache
def _gauss(count: int) -> tuple[Array, Array]:
    """Return nodes and weights (count,) of Gauss-Legendre quadrature on [0, 1], exact up to degree 2
    count - 1.
    """
    nodes, weights = np.polynomial.legendre.leggauss(count)
    return 0.5 + 0.5 * nodes, 0.5 * weights


def _coupling(coupling: Coupling | None, n: int) -> Array:
    """Return the matrices of dampers, gyroscopic, circulatory and centrifugal terms as (4, n, n), or (0,
    n, n) without coupling.
    """
    if coupling is None:
        return np.zeros((0, n, n))
    return np.array([coupling.dampers, coupling.gyroscopic, coupling.circulatory, coupling.centrifugal])


@lru_cache(maxsize=16)
def _fastest(system: System) -> tuple[float, float]:
    """Return the largest natural angular frequency, 1/s, and the largest harmonic of the mesh law that
    matters.

    The frequency is that with all meshes in contact at their steepest, plus the largest damping. Harmonic
    j of the law counts as j times the eighth root of its fraction of the stiffness, so that weak ones
    count less.
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
def _largest_root(diagonal: Array, rows: Array, factors: Array) -> float:
    """Return the largest eigenvalue of diag(diagonal (n,)) + rows^T diag(factors (m,)) rows, with rows (m,
    n).
    """
    return float(np.linalg.eigvalsh(np.diag(diagonal) + (rows.T * factors) @ rows)[-1])
