"""Gear body solved in all orders: modes with the hub held, and the compliance of the rim below the teeth."""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array
from facegear.gear_body.compliance import (
    mean_compliance,
    modal_compliance,
    over_orders,
    slope_compliance,
)
from facegear.gear_body.elements import Elements
from facegear.gear_body.matrices import body_matrices
from facegear.gear_body.mesh import BodyMesh, body_mesh
from facegear.gear_body.modes import FIRST_TRY, OrderModes, held_solver, order_modes
from facegear.gear_body.patch import Patch
from facegear.gear_body.section import Section

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
    compliances : (orders, 3, 3)
        Compliance of the means <W>, <V> and <W / r> below the teeth, from order 0 up to the last that a
        load needs.
    slopes : (orders, 1, 4)
        <W>, <V>, <W / r> and slope dW/dr by a unit moment on that slope, 1/N and rad/(N m).
    changes
        Relative change (m,) of the frequencies of every order from a coarser mesh.
    """

    section: Section
    mesh: BodyMesh
    elements: Elements
    orders: tuple[OrderModes, ...]
    compliances: Array
    slopes: Array
    changes: tuple[Array, ...]

    def static(self, patch: Patch) -> Array:
        """Return the compliances H_n with the hub held.

        Parameters
        ----------
        patch : Patch
            Area on which a mesh presses.

        Returns
        -------
        (orders, 2, 2) array
            m/N.
        """
        return np.stack([patch.compliance(order, below) for order, below in enumerate(self.compliances)])

    def leaning(self, patch: Patch) -> Array:
        """Return W_p, V_p and slope by a unit moment on the slope, hub held.

        Parameters
        ----------
        patch : Patch
            Area on which a mesh presses.

        Returns
        -------
        (orders, 3) array
            1/N and rad/(N m).
        """
        return np.stack([patch.leaning(order, below[0]) for order, below in enumerate(self.slopes)])

    def modal(self, patch: Patch) -> Array:
        """Return the part of `static` that the modes hold.

        Parameters
        ----------
        patch : Patch
            Area on which a mesh presses.

        Returns
        -------
        (orders, 2, 2) array
            m/N.
        """
        result = np.zeros((len(self.compliances), 2, 2))
        for modes in self.orders[: len(result)]:
            result[modes.order] = patch.compliance(modes.order, modal_compliance(modes))
        return result


def solve_body(section: Section, max_frequency: float, last_order: int, teeth: int) -> SolvedBody:
    """Compute modes and static compliances of a body.

    Parameters
    ----------
    section : Section
        The section.
    max_frequency : float
        Highest frequency of the modes, Hz.
    last_order : int
        Last order of the modes.
    teeth : int
        Number of teeth, from which follow the waves that a discrete ring can tell apart.

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
    compliances, slopes = {}, {}
    for order in sorted({*range(last_order + 1), *sampled_orders(last_static)}):
        solve = held_solver(body, order)
        if order <= last_order:
            expected_count = modes[-1].frequencies.size if modes else FIRST_TRY
            modes.append(order_modes(body, order, max_frequency, solve, expected_count))
        if order <= last_static:
            compliances[order] = mean_compliance(body, solve)
            slopes[order] = slope_compliance(body, solve)
    return SolvedBody(
        section=section,
        mesh=mesh,
        elements=body.elements,
        orders=tuple(modes),
        compliances=over_orders(tuple(compliances), np.stack(list(compliances.values())), last_static),
        slopes=over_orders(tuple(slopes), np.stack(list(slopes.values())), last_static),
        changes=_changes(section, modes),
    )


def sampled_orders(last: int) -> list[int]:
    """Return the orders at which compliances are computed.

    Parameters
    ----------
    last : int
        Last order.

    Returns
    -------
    list of int
        From 0 to `last`.
    """
    orders = list(range(min(SMOOTH, last) + 1))
    while orders[-1] < last:
        orders.append(min(max(orders[-1] + 1, round(GROWTH * orders[-1])), last))
    return orders


def _changes(section: Section, fine: list[OrderModes]) -> tuple[Array, ...]:
    """Return the relative change of the frequencies of each order from a coarser mesh."""
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
