"""Face gears that bend, at rest: the whole influence between flanks, in as few coordinates as it needs.

At rest nothing but the flanks loads a body, so that forces F on the flanks of a gear move all of them by A F
against their forces, with A the static compliance of all orders. A = R R^T, with two columns in R for each
mesh of the gear, is the answer of as many coordinates with unit stiffness and rows R. Which modes are kept
for motion does not matter.
"""

from dataclasses import dataclass, replace

import numpy as np

from facegear.arrays import Array
from facegear.gear_body.reduced import ReducedBody
from facegear.transmission.elastic_gears import ElasticGears, bordered, flank_rows
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
    return replace(machine, bodies=StaticGears(machine.bodies), softening=None)


@dataclass(frozen=True, eq=False)
class StaticGears:
    """The gears of `elastic` by their static compliance alone."""

    elastic: ElasticGears

    def __call__(self, lumped: LinearModel) -> LinearModel:
        """The lumped model with the coordinates of every gear behind its own."""
        model, layout = lumped, self.elastic.layout
        for gear, body in self.elastic.bodies.items():
            own = static_rows(body, layout, gear)
            rows = np.zeros((len(model.rows), own.shape[1]))
            rows[np.array([g == gear for _, g in layout.meshes] * 2)] = own
            lengths = np.abs(own).max(axis=0)
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
            )
        return model


def static_rows(body: ReducedBody, layout: Layout, gear: int) -> Array:
    """R (2 meshes of the gear, p) of A = R R^T, drive flanks first; A in m/N.

    Every order counts as two modes with unit stiffness that have its compliance.
    """
    sizes, vectors = np.linalg.eigh(body.static)
    shapes = vectors * np.sqrt(np.maximum(sizes, 0.0))[:, None, :]
    shapes[0] = np.diag(np.sqrt(np.diagonal(body.static[0])))  # along the axis or round it, never both
    orders = np.repeat(np.arange(len(shapes)), 2)
    axial, around = shapes.transpose(1, 0, 2).reshape(2, -1)
    turning = np.where(orders == 0, np.arange(orders.size) % 2, 0.0)
    parts = [
        flank_rows(
            orders,
            np.full(orders.size, part),
            axial,
            around,
            turning,
            layout.gears[gear].sign,
            layout.angles,
            layout.pressure_angle,
        )[:, orders >= part]  # order 0 has no sine
        for part in (0, 1)
    ]
    left, values, _ = np.linalg.svd(np.concatenate(parts, axis=1), full_matrices=False)
    kept = values > NOTHING * values.max()
    return np.asarray(left[:, kept] * values[kept])
