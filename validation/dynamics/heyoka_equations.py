"""Equations of motion as expressions of heyoka.py, with contact states as parameters.

Time is mesh phase, coordinates are scaled so that deflections are near one, which is what the absolute
tolerance of heyoka.py means. Everything that switches is multiplied by runtime parameters that the callbacks
of terminal events change: between two events the equations are analytic, as a Taylor series must have it.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from facegear.arrays import Array, Mask
from facegear.meshing.linear import LinearLaw
from facegear.motion.integrator.kernel_system import lower_edges, weights_of
from facegear.motion.integrator.system import RING_ROWS, System
from validation.dynamics.heyoka_laws import ForceExpression, force_of, rate_of_series, series
from validation.dynamics.problems import Problem

NEGLIGIBLE = 1e-13
"""Entries of a matrix below this share of its largest count as 0."""


@dataclass(frozen=True, eq=False)
class ScaledSystem:
    """System in deflections over the length scale and derivatives by mesh phase.

    Attributes
    ----------
    unit : (n,)
        Unit of each coordinate, y = unit u.
    jacobian : (m, n)
        Deflections of u by contacts, and x and y of each ring.
    spread : (m, n)
        Minus the accelerations of u by these forces.
    error : (contacts, 2, harmonics + 1)
        Series of the errors over the length scale, sine part first.
    lower, upper : (contacts,)
        Edges over the length scale.
    clearance : (R,)
        Of the rings, over the length scale.
    rubbing : (K, n)
        Accelerations of u by a friction force.
    contacts
        Number of meshes or flanks.
    only_pushes
        Whether spring and damper of a contact are cut where together they would pull.
    """

    unit: Array
    jacobian: Array
    spread: Array
    error: Array
    lower: Array
    upper: Array
    clearance: Array
    rubbing: Array
    contacts: int
    only_pushes: bool

    @property
    def opens(self) -> Mask:
        """Whether each contact (contacts,) can open."""
        return self.lower < self.upper


def scale_system(system: System) -> ScaledSystem:
    """Scale a system.

    Parameters
    ----------
    system : System
        The system.

    Returns
    -------
    ScaledSystem
        The scaled system.

    Raises
    ------
    ValueError
        For a stiffness in pieces of the phase, which only oscillators of tests have, and for coordinates that
        are coupled beside the meshes, as in gears that bend: heyoka.py compiles too long.
    """
    if isinstance(system.law, LinearLaw) and system.law.pieces:
        raise ValueError("not set up here: stiffness in pieces of the phase")
    if system.coupling is not None:
        raise ValueError("not set up here: coupled coordinates")
    contacts, rings = system.contacts, system.ring_stiffness.size
    weights = weights_of(system)
    unit = system.scale / np.where(weights > 0.0, weights, weights.max())
    rows = np.r_[:contacts, [contacts + RING_ROWS * r + axis for r in range(rings) for axis in (0, 1)]]
    jacobian = _without_rounding(system.mesh_jacobian)[rows.astype(int)]
    rubbing = np.zeros((0, system.size)) if system.rubbing is None else system.rubbing.directions
    lower, upper = (edges[:contacts] / system.scale for edges in (lower_edges(system), system.upper))
    return ScaledSystem(
        unit=unit,
        jacobian=jacobian * unit / system.scale,
        spread=jacobian * system.scale / unit,
        error=system.error[system.error_kind[:contacts]] / system.scale,
        lower=lower,
        upper=upper,
        clearance=system.ring_clearance / system.scale,
        rubbing=_without_rounding(rubbing) * system.scale / unit,
        contacts=contacts,
        only_pushes=bool(
            system.push_only and not system.damping_when_open and system.mesh_damping[:contacts].any()
        ),
    )


def _without_rounding(matrix: Array) -> Array:
    sizes = np.abs(matrix)
    return np.where(sizes > NEGLIGIBLE * sizes.max(initial=0.0), matrix, 0.0)


@dataclass(frozen=True, eq=False)
class Expressions:
    """Equations of motion as expressions.

    Attributes
    ----------
    equations
        Pairs of variable and derivative by phase, first all coordinates, then all rates.
    deflections, rates
        Deflection of each contact and its rate by phase.
    pushes
        Spring and damper of each contact together, over the length scale.
    rims, rim_rates
        Amount of each ring beyond its clearance near the rim, (r^2 - c^2) / (2 c), and its rate by phase.
    law
        Force of the contacts, whose parameters come first.
    parameters
        Number of all parameters: those of the law, a flag for each contact that only pushes, and one for
        each ring that is pressed.
    """

    equations: list[tuple[Any, Any]]
    deflections: list[Any]
    rates: list[Any]
    pushes: list[Any]
    rims: list[Any]
    rim_rates: list[Any]
    law: ForceExpression
    parameters: int


def expressions(heyoka: Any, problem: Problem, units: ScaledSystem) -> Expressions:
    """Build the equations of motion.

    Parameters
    ----------
    heyoka : module
        The library.
    problem : Problem
        The problem.
    units : ScaledSystem
        Its scaled system.

    Returns
    -------
    Expressions
        The equations.
    """
    system, w, n = problem.system, problem.frequency, problem.system.size
    u = [heyoka.make_vars(f"u{k}") for k in range(n)]
    v = [heyoka.make_vars(f"v{k}") for k in range(n)]
    law = force_of(heyoka, system, w, units.lower, units.upper)
    first_flag = units.contacts * law.parameters
    first_ring = first_flag + (units.contacts if units.only_pushes else 0)
    deflections, rates, elastic, pushes, forces = [], [], [], [], []
    for m in range(units.contacts):
        error, error_rate = -units.error[m], -rate_of_series(units.error[m])
        deflections.append(_weighted_sum(heyoka, units.jacobian[m], u, series(heyoka, error)))
        rates.append(_weighted_sum(heyoka, units.jacobian[m], v, series(heyoka, error_rate)))
        elastic.append(law.force(m, deflections[m]))
        damper = float(system.mesh_damping[m]) / w * rates[m]
        pushes.append(elastic[m] + damper)
        if units.only_pushes:
            forces.append(heyoka.par[first_flag + m] * pushes[m])
        else:
            is_damped = 1.0 if system.damping_when_open else law.is_touching(m)
            forces.append(elastic[m] + is_damped * damper)
    rims, rim_rates = [], []
    for r, clearance in enumerate(units.clearance):
        rows = units.jacobian[units.contacts + 2 * r : units.contacts + 2 * r + 2]
        position, rate = (
            [_weighted_sum(heyoka, row, q, heyoka.expression(0.0)) for row in rows] for q in (u, v)
        )
        is_pressed = heyoka.par[first_ring + r]
        stiffness = float(system.ring_stiffness[r]) / w**2
        forces += _ring(heyoka, position, rate, float(clearance), stiffness, system.ring_lag * w, is_pressed)
        rims.append((position[0] ** 2.0 + position[1] ** 2.0 - clearance**2) / (2.0 * float(clearance)))
        rim_rates.append((position[0] * rate[0] + position[1] * rate[1]) / float(clearance))
    friction = []
    if system.rubbing is not None:
        ratios = zip(system.rubbing.flank, system.rubbing.ratios, strict=True)
        friction = [series(heyoka, ratio) * elastic[flank] for flank, ratio in ratios]
    equations = list(zip(u, v, strict=True))
    for k in range(n):
        acceleration = series(heyoka, system.load[k] / (w**2 * units.unit[k]))
        acceleration = acceleration - system.damping[k] / w * v[k] - system.omega_squared[k] / w**2 * u[k]
        acceleration = _weighted_sum(heyoka, units.rubbing[:, k], friction, acceleration)
        equations.append((v[k], _weighted_sum(heyoka, -units.spread[:, k], forces, acceleration)))
    parameters = first_ring + len(units.clearance)
    return Expressions(equations, deflections, rates, pushes, rims, rim_rates, law, parameters)


def _ring(
    heyoka: Any,
    position: list[Any],
    rate: list[Any],
    clearance: float,
    stiffness: float,
    lag: float,
    is_pressed: Any,
) -> list[Any]:
    """Forces along x and y of a bearing with clearance c: F = k (1 - c / r) (x, y) and lag times dF/ds.

    Where it is not pressed the square of c is added to that of r, which keeps the expression regular.
    """
    inverse = (position[0] ** 2.0 + position[1] ** 2.0 + (1.0 - is_pressed) * clearance**2) ** -0.5
    growth = (position[0] * rate[0] + position[1] * rate[1]) * inverse * inverse
    spring = 1.0 - clearance * inverse
    return [
        stiffness * is_pressed * (spring * (q + lag * q_rate) + lag * clearance * inverse * growth * q)
        for q, q_rate in zip(position, rate, strict=True)
    ]


def _weighted_sum(heyoka: Any, weights: Array, values: list[Any], constant: Any) -> Any:
    terms = [float(weights[i]) * values[i] for i in np.flatnonzero(weights)]
    return heyoka.sum([*terms, constant])
