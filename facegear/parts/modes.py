"""Modes of a gear body whose hub is held, and the effect of rotation on them."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigsh

from facegear.arrays import Array
from facegear.errors import NotConverged
from facegear.number_format import count_noun
from facegear.parts.elements import V
from facegear.parts.matrices import BodyMatrices, around, rigid_motions
from facegear.sparse.matrices import Solve, solver

FIRST_TRY = 6
"""Number of modes of an order that are computed at first, and by which the number grows."""


@dataclass(frozen=True, eq=False)
class OrderModes:
    """Modes of one order n with unit modal mass, m of them by frequency; SI units.

    Attributes
    ----------
    order
        Nodal diameters n.
    frequencies : (m,)
        At rest, Hz.
    shapes : (dofs, m)
        U, V, W of every shape of the elements.
    coriolis, stress, centrifugal : (m, m)
        g, S and P over the modes.
    teeth : (5, m)
        MEANS of `matrices` on height 0 below the teeth.
    hub : (2, m)
        Coupling of masses Q with the rigid motions of `rigid_motions`; none above order 1, where it is zero.
    hub_spin : (m,)
        Coupling g with a rotation of the hub about its axis in order 0, with its tilt in order 1; none above.
    """

    order: int
    frequencies: Array
    shapes: Array
    coriolis: Array
    stress: Array
    centrifugal: Array
    teeth: Array
    hub: Array
    hub_spin: Array

    @property
    def gyroscopic_factors(self) -> Array:
        """c = g / M of each mode by itself, (m,), dimensionless: the diagonal of `coriolis`."""
        return np.diagonal(self.coriolis)

    @property
    def stiffening_factors(self) -> Array:
        """B = (S - P) / M of each mode by itself, (m,), dimensionless: B W^2 is added to the squared
        frequency.
        """
        return np.diagonal(self.stress - self.centrifugal)

    @property
    def torsional(self) -> Array:
        """Fraction (m,) of the sum of squares of each shape's entries that lies in motion round the axis,
        0 to 1.
        """
        return (self.shapes[V::3] ** 2).sum(axis=0) / (self.shapes**2).sum(axis=0)


def held_solver(body: BodyMatrices, order: int) -> Solve:
    """Return a function that solves K u = f in an order with the section's held edges fixed.

    K is factorised once.

    Parameters
    ----------
    body : BodyMatrices
        Matrices of the body.
    order : int
        The order n.

    Returns
    -------
    Solve
        Function from loads (dofs, ...) to displacements (dofs, ...), SI units; displacements of held
        degrees of freedom are 0.
    """
    free = body.free
    solve = solver(body.stiffness.at(order)[free][:, free])

    def displacements(loads: Array) -> Array:
        """Return displacements (dofs, ...) by loads of the same shape; 0 on held degrees of freedom."""
        result = np.zeros(loads.shape)
        result[free] = solve(loads[free])
        return result

    return displacements


def order_modes(
    body: BodyMatrices,
    order: int,
    max_frequency: float,
    solve: Solve | None = None,
    expected_count: int = FIRST_TRY,
) -> OrderModes:
    """Compute all modes of an order up to a frequency; where it is infinite, the first `expected_count` +
    1.

    Eigenvalues of K - w^2 M by shift and invert at 0. More modes are computed until one lies beyond the
    frequency.

    Parameters
    ----------
    body : BodyMatrices
        Matrices of the body.
    order : int
        The order n.
    max_frequency : float
        Highest frequency, Hz.
    solve : Solve or None
        Function of `held_solver` for this order, where it was made already.
    expected_count : int
        Number of modes expected; the first attempt computes one more.

    Returns
    -------
    OrderModes
        SI units.

    Raises
    ------
    NotConverged
        If the eigenvalue solver does not converge.
    """
    free = body.free
    solve = solve or held_solver(body, order)
    mass = (around(order) * body.mass)[free][:, free].tocsr()
    stiffness = body.stiffness.at(order)[free][:, free].tocsr()

    def inverse(loads: Array) -> Array:
        """Return the displacements (f,) of the free degrees of freedom by loads (f,) on them."""
        whole = np.zeros(body.elements.size)
        whole[free] = loads
        return solve(whole)[free]

    count = expected_count + 1
    while True:
        squared, vectors = _smallest(stiffness, mass, inverse, min(count, free.size - 2), order)
        if (
            squared[-1] > (2.0 * np.pi * max_frequency) ** 2
            or squared.size < count
            or np.isinf(max_frequency)
        ):
            break
        count += FIRST_TRY
    is_in_range = squared <= (2.0 * np.pi * max_frequency) ** 2
    shapes = np.zeros((body.elements.size, int(is_in_range.sum())))
    shapes[free] = vectors[:, is_in_range]
    return _reduce_matrices(body, order, np.sqrt(squared[is_in_range]) / (2.0 * np.pi), _fix_signs(shapes))


def _smallest(
    stiffness: sp.csr_matrix, mass: sp.csr_matrix, inverse: Solve, count: int, order: int
) -> tuple[Array, Array]:
    """Return the `count` smallest squared angular frequencies, ascending, (count,), 1/s2, and shapes (f,
    count) of unit modal mass.

    stiffness, mass (f, f): over the free degrees of freedom; inverse: function that solves the stiffness;
    order: for the message of NotConverged.
    """
    operator = LinearOperator(stiffness.shape, matvec=inverse, dtype=float)
    start = np.ones(stiffness.shape[0])
    try:
        squared, vectors = eigsh(stiffness, count, mass, sigma=0.0, OPinv=operator, v0=start, tol=1e-11)
    except ArpackNoConvergence as error:
        raise NotConverged(
            "gear body", f"order {order}", f"{len(error.eigenvalues)} of {count_noun(count, 'mode')}"
        ) from None
    ascending = np.argsort(squared)
    return squared[ascending], vectors[:, ascending]


def _fix_signs(shapes: Array) -> Array:
    """Return the shapes (dofs, m) with signs such that the largest entry by magnitude of each is
    positive.
    """
    if not shapes.size:
        return shapes
    largest = np.take_along_axis(shapes, np.abs(shapes).argmax(axis=0)[None], axis=0)
    return shapes * np.sign(largest)


def _reduce_matrices(body: BodyMatrices, order: int, frequencies: Array, shapes: Array) -> OrderModes:
    """Return the modes of one order with the body's matrices and means projected on them.

    frequencies (m,), Hz; shapes (dofs, m) of unit modal mass.
    """
    factor = around(order)
    rigid = rigid_motions(body.elements, order) if order < 2 else np.zeros((body.elements.size, 2))
    return OrderModes(
        order=order,
        frequencies=frequencies,
        shapes=shapes,
        coriolis=factor * shapes.T @ (body.coriolis @ shapes),
        stress=shapes.T @ (body.stress.at(order) @ shapes),
        centrifugal=factor * shapes.T @ (body.centrifugal @ shapes),
        teeth=body.on_teeth @ shapes,
        hub=factor * rigid.T @ (body.mass @ shapes),
        hub_spin=factor * rigid[:, 1] @ (body.coriolis @ shapes),
    )


def wave_frequencies(modes: OrderModes, speed: float) -> tuple[Array, Array]:
    """Return the frequencies at which the waves of each mode pass a point in space.

    Forward waves travel as the body turns. Modes of an order n are taken one by one: with w the angular
    frequency at rest, c and B its `gyroscopic_factors` and `stiffening_factors` and W the speed, they are
    f +- (n + c) W / 2 pi with f = sqrt(w^2 + (B + c^2) W^2) / 2 pi. Order 0 has no waves, so both are f
    with c = 0.

    Parameters
    ----------
    modes : OrderModes
        The m modes of one order.
    speed : float
        Speed of the body, rad/s; its sign does not matter.

    Returns
    -------
    pair of (m,) arrays
        Forward and backward wave, Hz.
    """
    w = 2.0 * np.pi * modes.frequencies
    c = modes.gyroscopic_factors if modes.order else np.zeros(w.size)
    middle = np.sqrt(w**2 + (modes.stiffening_factors + c**2) * speed**2) / (2.0 * np.pi)
    shift = (modes.order + c) * abs(speed) / (2.0 * np.pi) if modes.order else np.zeros(w.size)
    return middle + shift, middle - shift


def resonant_speeds(modes: OrderModes, teeth: int, harmonic: int) -> tuple[Array, Array]:
    """Return the speeds of the body at which a harmonic of the mesh frequency meets each wave.

    k N W / 2 pi = f(W) +- (n + c) W / 2 pi with f^2 = (w^2 + (B + c^2) W^2) / 4 pi^2, solved for the
    speed W; w, B, c and n are those of `wave_frequencies`.

    Parameters
    ----------
    modes : OrderModes
        The m modes of one order.
    teeth : int
        Number of teeth N.
    harmonic : int
        Number k of the harmonic.

    Returns
    -------
    pair of (m,) arrays
        Forward and backward wave, rad/s; NaN where the harmonic never meets the wave.
    """
    w = 2.0 * np.pi * modes.frequencies
    c = modes.gyroscopic_factors if modes.order else np.zeros(w.size)
    stiffening = modes.stiffening_factors + c**2
    speeds = []
    for sign in (1.0, -1.0):
        slope = harmonic * teeth - sign * ((modes.order + c) if modes.order else 0.0 * c)
        below = slope**2 - stiffening
        speeds.append(np.where((below > 0.0) & (slope > 0.0), w / np.sqrt(np.maximum(below, 1e-300)), np.nan))
    return speeds[0], speeds[1]


HARMONICS = (1, 2, 3)
"""Multiples of the mesh frequency whose crossings are listed."""


def phase_factors(order: int, harmonic: int, teeth: int, angles: Array) -> tuple[float, float]:
    """Return how many times the force of one mesh drives the forward and the backward wave of an order.

    Force k of the mesh harmonics at the pinion at angle psi is Re[F e^(i k (w t - N psi))], the same at all
    pinions: the results are the sizes of sum e^(i (k N - n) psi) and sum e^(i (k N + n) psi).

    Parameters
    ----------
    order : int
        Number n of nodal diameters.
    harmonic : int
        Number k of the mesh harmonic.
    teeth : int
        Number of teeth N of the gear.
    angles : (n,) array
        Angles of the pinions, rad.

    Returns
    -------
    pair of float
        Forward and backward wave, relative to one mesh.
    """
    turns = harmonic * teeth * angles
    return (
        float(abs(np.exp(1j * (turns - order * angles)).sum())),
        float(abs(np.exp(1j * (turns + order * angles)).sum())),
    )
