"""A gear body solved in all orders: modes with the hub held, compliance below the teeth, reduction."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.linalg
from scipy.interpolate import CubicSpline

from facegear.arrays import Array
from facegear.parts.body_mesh import BodyMesh, body_mesh
from facegear.parts.elements import Elements
from facegear.parts.matrices import BodyMatrices, body_matrices
from facegear.parts.modes import FIRST_TRY, OrderModes, held_solver, order_modes
from facegear.parts.reduced_body import ReducedBody, flank_influence
from facegear.parts.section import Section, section_properties
from facegear.parts.wheel import Patch
from facegear.sparse.matrices import Solve


def mean_compliance(body: BodyMatrices, solve: Solve) -> Array:
    """Return MEANS of `matrices` below the teeth (rows) by unit loads on them (columns), hub held.

    Parameters
    ----------
    body : BodyMatrices
        Matrices of the body.
    solve : Solve
        Function of `held_solver` for an order.

    Returns
    -------
    (5, 5) array
        m/N for <W>, <V> and <U>; each W / r and each slope divides by m.
    """
    means = body.on_teeth
    return np.asarray(means @ solve(means.T))


def modal_compliance(modes: OrderModes) -> Array:
    """Return the part of `mean_compliance` that modes hold: sum of teeth teeth^T / w^2.

    Parameters
    ----------
    modes : OrderModes
        The modes of one order.

    Returns
    -------
    (5, 5) array
        m/N for <W>, <V> and <U>; each W / r and each slope divides by m.
    """
    return np.asarray((modes.teeth / (2.0 * np.pi * modes.frequencies) ** 2) @ modes.teeth.T)


def over_orders(computed_orders: Sequence[int], values: Array, last: int) -> Array:
    """Interpolate the compliances of all orders from those of some orders.

    They change smoothly with the order beyond the first few: cubic splines of n times the compliance.

    Parameters
    ----------
    computed_orders : Sequence of int
        The n orders, ascending from 0.
    values : (n, i, j) array
        Their compliances, m/N or any unit.
    last : int
        Last order.

    Returns
    -------
    (last + 1, i, j) array
        In the same unit.
    """
    orders = np.array(computed_orders)
    result = np.empty((last + 1, *values.shape[1:]))
    all_orders = np.arange(last + 1)
    scale = np.maximum(orders, 1)[:, None, None]
    smooth = CubicSpline(orders[1:], (scale * values)[1:])
    result[1:] = smooth(all_orders[1:]) / all_orders[1:, None, None]
    result[0] = values[0]
    return result


def influence(compliances: Array, angle: float, first: Array, second: Array) -> float:
    """Return the motion against its own force at one flank by a unit force at another, hub held.

    A = sum_n Re[e^(-i n psi) a1* H_n a2], a = (P_axial, -i P_round, P_radial).

    Parameters
    ----------
    compliances : (orders, 3, 3) array
        H_n from order 0, m/N.
    angle : float
        Angle of the first flank past the second, rad.
    first : (3,) array
        Axial, tangential and radial part of a unit force on the first flank, dimensionless.
    second : (3,) array
        The parts of a unit force on the second flank, dimensionless.

    Returns
    -------
    float
        m/N.
    """
    return float(flank_influence(compliances, np.stack([first, second]), np.array([angle, 0.0]))[0, 1])


STATIC_ORDERS = 60
"""Largest order in a local load; those above add 2e-4 of a mesh's own compliance."""
SMOOTH = 8
"""Order up to which every compliance is computed; beyond, every order that is GROWTH times the one before."""
GROWTH = 1.2
"""Ratio of the orders beyond SMOOTH at which compliances are computed."""
COARSE = (1, 25.0)
"""Elements across the thinnest wall and refinement at corners of the mesh by which errors are estimated."""


@dataclass(frozen=True, eq=False)
class SolvedBody:
    """Modes and compliances of a body with its hub held.

    Attributes
    ----------
    section, mesh, elements
        Section, mesh and elements from which it was computed.
    orders
        Modes of the orders 0, 1, 2, ...
    compliances : (orders, 5, 5)
        `mean_compliance` below the teeth, from order 0 up to the last that a load needs.
    changes
        Relative change (m,) of the frequencies of every order from a coarser mesh.
    """

    section: Section
    mesh: BodyMesh
    elements: Elements
    orders: tuple[OrderModes, ...]
    compliances: Array
    changes: tuple[Array, ...]

    def static(self, patch: Patch) -> Array:
        """Return the static compliances H_n at a mesh by circumferential order, with the hub held.

        H_n maps unit forces along the axis, round it and along the radius to W_p, V_p and U_p of the pitch
        point.

        Parameters
        ----------
        patch : Patch
            Area on which a mesh presses.

        Returns
        -------
        (orders, 3, 3) array
            m/N, from order 0 to the last that a load needs.
        """
        return np.stack([patch.compliance(order, below) for order, below in enumerate(self.compliances)])

    def leaning(self, patch: Patch) -> Array:
        """Return W_p, V_p, U_p and the slope dW/dr at a mesh by a unit moment on the slope, by order, hub
        held.

        Parameters
        ----------
        patch : Patch
            Area on which a mesh presses.

        Returns
        -------
        (orders, 4) array
            1/N and rad/(N m).
        """
        return np.stack([patch.leaning(order, below[-1]) for order, below in enumerate(self.compliances)])

    def modal(self, patch: Patch) -> Array:
        """Return the part of the static compliances that the computed modes hold.

        Parameters
        ----------
        patch : Patch
            Area on which a mesh presses.

        Returns
        -------
        (orders, 3, 3) array
            m/N.
        """
        result = np.zeros((len(self.compliances), 3, 3))
        for modes in self.orders[: len(result)]:
            result[modes.order] = patch.compliance(modes.order, modal_compliance(modes))
        return result


def solve_body(section: Section, max_frequency: float, last_order: int, teeth: int) -> SolvedBody:
    """Compute modes and static compliances of a body with its hub held.

    Compliances are computed at `sampled_orders` and interpolated between them.

    Parameters
    ----------
    section : Section
        The section.
    max_frequency : float
        Highest frequency of the modes, Hz.
    last_order : int
        Last order of the modes, lowered to the last order of the compliances where it is above.
    teeth : int
        Number of teeth N: compliances go up to order (N - 1) // 2, at most STATIC_ORDERS, as a ring of N
        teeth cannot tell higher waves apart.

    Returns
    -------
    SolvedBody
        SI units.

    Raises
    ------
    InvalidInput
        If the section cannot be meshed.
    NotConverged
        If the modes are not found.
    """
    last_static = min(STATIC_ORDERS, (teeth - 1) // 2)
    last_order = min(last_order, last_static)
    mesh = body_mesh(section)
    body = body_matrices(section, mesh)
    modes: list[OrderModes] = []
    compliances = {}
    for order in sorted({*range(last_order + 1), *sampled_orders(last_static)}):
        solve = held_solver(body, order)
        if order <= last_order:
            expected_count = modes[-1].frequencies.size if modes else FIRST_TRY
            modes.append(order_modes(body, order, max_frequency, solve, expected_count))
        if order <= last_static:
            compliances[order] = mean_compliance(body, solve)
    return SolvedBody(
        section=section,
        mesh=mesh,
        elements=body.elements,
        orders=tuple(modes),
        compliances=over_orders(tuple(compliances), np.stack(list(compliances.values())), last_static),
        changes=_changes(section, modes),
    )


def sampled_orders(last: int) -> list[int]:
    """Return the orders at which compliances are computed: all up to SMOOTH, then each about GROWTH times
    the last.

    Parameters
    ----------
    last : int
        Last order.

    Returns
    -------
    list of int
        Ascending from 0 to `last`, both included.
    """
    orders = list(range(min(SMOOTH, last) + 1))
    while orders[-1] < last:
        orders.append(min(max(orders[-1] + 1, round(GROWTH * orders[-1])), last))
    return orders


def _changes(section: Section, fine: list[OrderModes]) -> tuple[Array, ...]:
    """Return the change of each mode's frequency on a coarser mesh (COARSE), relative to `fine`: one
    array (m,) for each order of `fine`.
    """
    coarse = body_matrices(section, body_mesh(section, *COARSE))
    changes = []
    for modes in fine:
        count = modes.frequencies.size
        if not count:
            changes.append(np.zeros(0))
            continue
        coarse_frequencies = order_modes(coarse, modes.order, np.inf, expected_count=count - 1).frequencies
        changes.append(np.abs(coarse_frequencies - modes.frequencies) / modes.frequencies)
    return tuple(changes)


def reduced_body(
    body: SolvedBody, patch: Patch, damping_ratio: float, stiffness_damping: float = 0.0
) -> ReducedBody:
    """Return the modes of a body and its static compliance below a mesh, as a machine uses them.

    All modes of all orders are stacked; motions below the teeth are converted to the pitch point by the
    patch.

    Parameters
    ----------
    body : SolvedBody
        The solved body.
    patch : Patch
        Area on which a mesh presses.
    damping_ratio : float
        Damping ratio of every mode.
    stiffness_damping : float
        beta of D = beta K, s.

    Returns
    -------
    ReducedBody
        SI units.
    """
    orders = body.orders
    order = np.concatenate([np.full(modes.frequencies.size, modes.order) for modes in orders])
    zero = orders[0]
    mass, _, _, moment = section_properties(body.section)
    return ReducedBody(
        order=order,
        frequency=np.concatenate([modes.frequencies for modes in orders]),
        coriolis=_blocks([modes.coriolis for modes in orders]),
        stiffening=_blocks([modes.stress - modes.centrifugal for modes in orders]),
        mesh=np.concatenate([patch.rows(modes.order, modes.teeth) for modes in orders], axis=1),
        hub=np.concatenate([modes.hub for modes in orders], axis=1),
        hub_spin=np.concatenate([modes.hub_spin for modes in orders]),
        round=np.concatenate([np.round(zero.torsional), np.zeros(order.size - zero.frequencies.size)]),
        static=body.static(patch),
        damping_ratio=np.array(damping_ratio),
        pitch_height=np.array(patch.height),
        slope=np.concatenate([patch.factor(modes.order) * modes.teeth[-1] for modes in orders]),
        leaning=body.leaning(patch),
        mass=np.array(mass),
        moment=np.array(moment),
        stiffness_damping=np.array(stiffness_damping),
    )


def _blocks(matrices: list[Array]) -> Array:
    """Return matrices (m_i, m_i) along the diagonal of one matrix, zero elsewhere; empty matrices take no
    place.
    """
    size = sum(len(matrix) for matrix in matrices)
    return np.asarray(scipy.linalg.block_diag(*(m for m in matrices if m.size), np.zeros((0, 0)))).reshape(
        size, size
    )
