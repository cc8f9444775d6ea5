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
from facegear.gear_body.reduced import ReducedBody
from facegear.transmission.elastic_gears import ElasticGears, bordered, flank_rows, rim_slopes
from facegear.transmission.layout import Layout
from facegear.transmission.linear_model import LinearModel
from facegear.transmission.machine import Machine

NOTHING = 1e-10
"""Part of the largest singular value below which a direction of the flanks is that of others."""


def at_rest(machine: Machine) -> Machine:
    """The machine for static questions alone, with all that its bodies give between any two meshes.

    Masses of its coordinates beyond the lumped ones are of no use but to scale them.
    """
    machine = machine.resting
    if not isinstance(machine.bodies, ElasticGears):
        return machine
    posed = machine.directions is not None
    return replace(machine, bodies=StaticGears(machine.bodies, posed), softening=None)


@dataclass(frozen=True, eq=False)
class StaticGears:
    """The gears of `elastic` by their static compliance alone; `posed`: with the slopes of their rims."""

    elastic: ElasticGears
    posed: bool = False

    def __call__(self, lumped: LinearModel) -> LinearModel:
        """The lumped model with the coordinates of every gear behind its own."""
        model, layout = lumped, self.elastic.layout
        for gear, body in self.elastic.bodies.items():
            meshes = np.array([g == gear for _, g in layout.meshes])
            if self.posed:
                own, slopes = posed_rows(body, layout, gear)
                lengths = np.abs(np.concatenate([own, layout.gear_radius * slopes[0], slopes[1]])).max(axis=0)
            else:
                own, slopes = static_rows(body, layout, gear), None
                lengths = np.abs(own).max(axis=0)
            rows = np.zeros((len(model.rows), own.shape[1]))
            rows[np.tile(meshes, 2)] = own
            mass = bordered(model.mass, np.diag(lengths**2))
            none = np.zeros(lengths.size)
            model = replace(
                model,
                labels=(
                    *model.labels,
                    *(f"{layout.gears[gear].name}:bent {n + 1}" for n in range(none.size)),
                ),
                mass=mass,
                stiffness=bordered(model.stiffness, np.eye(none.size)),
                rows=np.hstack([model.rows, rows]),
                torques=np.append(model.torques, none),
                forces=np.append(model.forces, none),
                lengths=np.append(model.lengths, lengths),
                dampers=bordered(model.dampers, np.diag(none)),
                slopes=None if slopes is None else model.with_slopes(meshes, slopes),
            )
        return model


def static_rows(body: ReducedBody, layout: Layout, gear: int) -> Array:
    """R (2 meshes of the gear, p) of A = R R^T, drive flanks first; A in m/N.

    Every order counts as two modes with unit stiffness that have its compliance.
    """
    sizes, vectors = np.linalg.eigh(body.static)
    shapes = vectors * np.sqrt(np.maximum(sizes, 0.0))[:, None, :]
    shapes[0] = np.diag(np.sqrt(np.diagonal(body.static[0])))  # along the axis or round it, never both
    return _condensed(_waves(shapes, np.array([0.0, 1.0]), layout, gear)[0])


def posed_rows(body: ReducedBody, layout: Layout, gear: int) -> tuple[Array, Array]:
    """R of the flanks as `static_rows`, and of the slopes below all meshes of the gear, (2, meshes, p)."""
    whole = body.joined(layout.gear_radius)
    whole[0, 1, [0, 2]] = whole[0, [0, 2], 1] = 0.0  # along the axis or round it, never both
    sizes, vectors = np.linalg.eigh(whole)
    shapes = vectors * np.sqrt(np.maximum(sizes, 0.0))[:, None, :]
    flanks, slopes = _waves(shapes, np.abs(vectors[0, 1]).round(), layout, gear)
    own = _condensed(np.concatenate([flanks, *slopes]))
    radial, around = np.split(own[len(flanks) :], 2)
    return own[: len(flanks)], np.stack([radial / layout.gear_radius, around])


def _waves(shapes: Array, turning: Array, layout: Layout, gear: int) -> tuple[Array, Array]:
    """Motions of the flanks, and slopes below the meshes, by waves of all orders with unit stiffness.

    shapes (orders, i, k): W_p, V_p and what else they have of slope, each by k waves of every order; turning
    (k,): which of those of order 0 go round the axis. Slopes of none where `shapes` has none.
    """
    count = shapes.shape[2]
    orders = np.repeat(np.arange(len(shapes)), count)
    axial, around, *slope = shapes.transpose(1, 0, 2).reshape(-1, orders.size)
    round_axis = np.where(orders == 0, np.tile(turning, len(shapes)), 0.0)
    flanks, slopes = [], []
    for part in (0, 1):
        kept, parts = orders >= part, np.full(orders.size, part)  # order 0 has no sine
        sign, angles = layout.gears[gear].sign, layout.angles
        rows = flank_rows(orders, parts, axial, around, round_axis, sign, angles, layout.pressure_angle)
        flanks.append(rows[:, kept])
        slopes += [rim_slopes(orders, parts, axial, own, round_axis, angles)[..., kept] for own in slope]
    return np.concatenate(flanks, axis=1), np.concatenate(slopes, axis=2) if slopes else np.zeros((0, 0, 0))


def _condensed(rows: Array) -> Array:
    """As many columns R as R R^T of the rows needs."""
    left, values, _ = np.linalg.svd(rows, full_matrices=False)
    kept = values > NOTHING * values.max()
    return np.asarray(left[:, kept] * values[kept])
