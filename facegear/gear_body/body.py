"""A gear body solved in all orders: modes with the hub held, and how the rim gives way below the teeth."""

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
"""Orders that a local load is made of; those above add 2e-4 of a mesh's own compliance."""
SMOOTH = 8
"""Order up to which every compliance is computed; beyond, every order that is GROWTH times the one before."""
GROWTH = 1.2
COARSE = (1, 25.0)
"""Elements across the thinnest wall and refinement at corners of the mesh by which errors are estimated."""


@dataclass(frozen=True, eq=False)
class SolvedBody:
    """What is known of a body with its hub held.

    Attributes
    ----------
    section, mesh, elements
        What it was computed from.
    orders
        Modes of the orders 0, 1, 2, ...
    compliances : (orders, 3, 3)
        Of the means <W>, <V> and <W / r> below the teeth, from order 0 up to the last that a load needs.
    slopes : (orders, 1, 4)
        <W>, <V>, <W / r> and slope dW/dr by a unit moment on that slope, 1/N and rad/(N m).
    changes
        Of every order the relative change (m,) of its frequencies from a coarser mesh.
    """

    section: Section
    mesh: BodyMesh
    elements: Elements
    orders: tuple[OrderModes, ...]
    compliances: Array
    slopes: Array
    changes: tuple[Array, ...]

    def static(self, patch: Patch) -> Array:
        """H_n (orders, 2, 2) with the hub held, m/N."""
        return np.stack([patch.compliance(order, below) for order, below in enumerate(self.compliances)])

    def leaning(self, patch: Patch) -> Array:
        """W_p, V_p (1/N) and slope (rad/(N m)) by a unit moment on the slope, hub held, (orders, 3)."""
        return np.stack([patch.leaning(order, below[0]) for order, below in enumerate(self.slopes)])

    def modal(self, patch: Patch) -> Array:
        """The part of `static` that the modes hold, (orders, 2, 2), m/N."""
        result = np.zeros((len(self.compliances), 2, 2))
        for modes in self.orders[: len(result)]:
            result[modes.order] = patch.compliance(modes.order, modal_compliance(modes))
        return result


def solve_body(section: Section, max_frequency: float, last_order: int, teeth: int) -> SolvedBody:
    """Modes up to the frequency `max_frequency` (Hz) of the orders 0 to `last_order`, and static compliances.

    teeth: their number, of which the waves that a discrete ring can tell apart follow. Raises InvalidInput
    for a section that cannot be meshed, NotConverged.
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
    """Orders from 0 to `last` at which compliances are computed."""
    orders = list(range(min(SMOOTH, last) + 1))
    while orders[-1] < last:
        orders.append(min(max(orders[-1] + 1, round(GROWTH * orders[-1])), last))
    return orders


def _changes(section: Section, fine: list[OrderModes]) -> tuple[Array, ...]:
    """Relative change of the frequencies of each order from a coarser mesh."""
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
