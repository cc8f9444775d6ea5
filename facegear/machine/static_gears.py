"""Face gears that bend, at rest: the whole influence between flanks, in as few coordinates as it needs.

At rest nothing but the flanks loads a body, so that forces F on the flanks of a gear move all of them by A F
against their forces, with A the static compliance of all orders. A = R R^T, with two columns in R for each
mesh of the gear, is the answer of as many coordinates with unit stiffness and rows R. Which modes are kept
for motion does not matter. Where meshes stand in their poses, the slopes of the rim below each count as well,
and with two more columns in R for each mesh the moments that are conjugate to them.
"""

from dataclasses import dataclass, replace

import numpy as np

from facegear.arrays import Array
from facegear.machine.elastic_coordinates import flank_rows, gear_forces, rim_slopes
from facegear.machine.elastic_gears import ElasticGears, append_block
from facegear.machine.layout import Layout
from facegear.machine.linear_model import LinearModel
from facegear.machine.machine import Machine
from facegear.parts.reduced_body import ReducedBody

RANK_TOLERANCE = 1e-10
"""Part of the largest singular value below which a direction of the flanks follows from the other ones."""


def at_rest(machine: Machine) -> Machine:
    """Return the machine for static questions alone, with the full static compliance between any two meshes.

    The masses of its coordinates beyond the lumped ones only scale them.

    Parameters
    ----------
    machine : Machine
        The machine.

    Returns
    -------
    Machine
        Its gears are StaticGears if they were ElasticGears.
    """
    machine = machine.static_machine
    if machine.casing is not None:
        machine = replace(machine, casing=machine.casing.without_modes())
    if not isinstance(machine.bodies, ElasticGears):
        return machine
    with_slopes = machine.directions is not None
    return replace(machine, bodies=StaticGears(machine.bodies, with_slopes), softening=None)


@dataclass(frozen=True, eq=False)
class StaticGears:
    """Gears of `elastic` by their whole static compliance, in place of their modes; called with a linear
    model it adds their coordinates.

    Attributes
    ----------
    elastic : ElasticGears
        The gears with their modes.
    with_slopes : bool
        Whether the slopes of the rims have coordinates, too.
    """

    elastic: ElasticGears
    with_slopes: bool = False

    def __call__(self, base_model: LinearModel) -> LinearModel:
        """Return the model with coordinates of every gear behind its own, with unit stiffness and no
        damping.
        """
        model, layout = base_model, self.elastic.layout
        for gear, body in self.elastic.bodies.items():
            meshes = np.array([g == gear for _, g in layout.meshes])
            if self.with_slopes:
                gear_rows, slopes = posed_rows(body, layout, gear)
                motions = [gear_rows, layout.gear_radius * slopes[0], *slopes[1:]]
                lengths = np.abs(np.concatenate(motions)).max(axis=0)
            else:
                gear_rows, slopes = static_rows(body, layout, gear), None
                lengths = np.abs(gear_rows).max(axis=0)
            rows = np.zeros((len(model.rows), gear_rows.shape[1]))
            rows[np.tile(meshes, 2)] = gear_rows
            mass = append_block(model.mass, np.diag(lengths**2))
            zeros = np.zeros(lengths.size)
            model = replace(
                model,
                labels=(
                    *model.labels,
                    *(f"{layout.gears[gear].name}:bent {n + 1}" for n in range(zeros.size)),
                ),
                mass=mass,
                stiffness=append_block(model.stiffness, np.eye(zeros.size)),
                rows=np.hstack([model.rows, rows]),
                torques=np.append(model.torques, zeros),
                forces=np.append(model.forces, zeros),
                lengths=np.append(model.lengths, lengths),
                dampers=append_block(model.dampers, np.diag(zeros)),
                slopes=None if slopes is None else model.with_slopes(meshes, slopes),
            )
        return model


def static_rows(body: ReducedBody, layout: Layout, gear: int) -> Array:
    """Return R of A = R R^T, the static compliance between the flanks of a gear.

    Every order counts as three modes with unit stiffness that have its compliance.

    Parameters
    ----------
    body : ReducedBody
        The gear's reduced body.
    layout : Layout
        Bodies and mesh geometry.
    gear : int
        Number of the gear.

    Returns
    -------
    (2 meshes of the gear, p) array
        Drive flanks first; A is in m/N.
    """
    return _condense_columns(_waves(_shapes(body.static), layout, gear)[0])


def posed_rows(body: ReducedBody, layout: Layout, gear: int) -> tuple[Array, Array]:
    """Return R of the flanks as `static_rows`, and of the slopes below all meshes of the gear.

    The product of two rows of R is the static compliance between the two quantities; slopes along the
    radius count times the gear radius.

    Parameters
    ----------
    body : ReducedBody
        The gear's reduced body.
    layout : Layout
        Bodies and mesh geometry.
    gear : int
        Number of the gear.

    Returns
    -------
    pair of arrays
        R of the flanks (2 meshes of the gear, p), drive flanks first, and of the slopes (2 or 4, meshes, p):
        those of `rim_slopes` for a unit of each of p coordinates with unit stiffness. R R^T of the flanks
        is in m/N.
    """
    shapes = _shapes(body.compliance_with_slope(layout.gear_radius))
    flanks, slopes = _waves(shapes, layout, gear)
    columns = _condense_columns(np.concatenate([flanks, *slopes]))
    radial, *slopes_and_motions = np.split(columns[len(flanks) :], len(slopes))
    return columns[: len(flanks)], np.stack([radial / layout.gear_radius, *slopes_and_motions])


ROUND = 1
"""Place of the motion round the axis among W_p, V_p, U_p and the slope, and of its wave in order 0."""


def _shapes(compliances: Array) -> Array:
    """Return W_p, V_p, U_p and any slope by waves of unit stiffness that have the compliances (orders, i, i).

    The shapes are (orders, i, i), the wave last. In order 0 wave ROUND alone goes round the axis.
    """
    sizes, vectors = np.linalg.eigh(compliances)
    shapes = vectors * np.sqrt(np.maximum(sizes, 0.0))[:, None, :]
    not_round = np.delete(np.arange(compliances.shape[1]), ROUND)
    at = np.ix_(np.zeros(1, dtype=int), not_round, not_round)
    sizes, vectors = np.linalg.eigh(compliances[at])
    shapes[0] = 0.0
    shapes[at] = vectors * np.sqrt(np.maximum(sizes, 0.0))[:, None, :]
    shapes[0, ROUND, ROUND] = np.sqrt(compliances[0, ROUND, ROUND])
    return shapes


def _waves(shapes: Array, layout: Layout, gear: int) -> tuple[Array, Array]:
    """Return motions of the flanks (2 meshes, c), and slopes (2 or 4, meshes, c), by waves of all orders.

    A wave is a coordinate with unit stiffness; order 0 has k of them, every other order k cosines and k
    sines. shapes (orders, i, k): `_shapes`. The slopes are empty where `shapes` has none.
    """
    count = shapes.shape[2]
    orders = np.repeat(np.arange(len(shapes)), count)
    motions, slope = np.split(shapes.transpose(1, 0, 2).reshape(-1, orders.size), [3])
    round_axis = np.where(orders == 0, np.tile(np.arange(count) == ROUND, len(shapes)), 0.0)
    forces = gear_forces(layout, gear)
    flanks, slopes = [], []
    for part in (0, 1):
        has_wave, parts = orders >= part, np.full(orders.size, part)  # order 0 has no sine
        rows = flank_rows(orders, parts, motions, round_axis, forces, layout.angles)
        flanks.append(rows[:, has_wave])
        slopes += [
            rim_slopes(orders, parts, motions, radial, round_axis, forces, layout.angles)[..., has_wave]
            for radial in slope
        ]
    return np.concatenate(flanks, axis=1), np.concatenate(slopes, axis=2) if slopes else np.zeros((0, 0, 0))


def _condense_columns(rows: Array) -> Array:
    """Return rows (r, p) with as few columns as keep rows rows^T, from the singular values above
    RANK_TOLERANCE of the largest.
    """
    left, values, _ = np.linalg.svd(rows, full_matrices=False)
    is_significant = values > RANK_TOLERANCE * values.max()
    return np.asarray(left[:, is_significant] * values[is_significant])
