"""Face gears that bend, at rest: as few elastic coordinates as the forces of the meshes can move.

At rest nothing but the flanks loads the elastic coordinates q, so that `K q = -R^T F` with K their diagonal
stiffness, R the rows of the flanks and F their forces: q lies in the span of K^-1 R^T, which holds two
vectors for each mesh of a gear, however many modes the gear has. Statics in these coordinates are exact.
"""

from dataclasses import dataclass, replace

import numpy as np

from facegear.arrays import Array
from facegear.transmission.elastic_gears import ElasticGears
from facegear.transmission.linear_model import LinearModel, Spin
from facegear.transmission.machine import Machine

NOTHING = 1e-10
"""Part of the largest singular value below which a direction of the flanks is that of others."""


def at_rest(machine: Machine) -> Machine:
    """The machine for static questions alone: the same answers from fewer coordinates."""
    if not isinstance(machine.bodies, ElasticGears):
        return machine
    return replace(machine, bodies=StaticGears(machine.bodies))


@dataclass(frozen=True, eq=False)
class StaticGears:
    """The gears of `elastic` in coordinates p, q = X p, with unit stiffness."""

    elastic: ElasticGears

    def __call__(self, lumped: LinearModel) -> LinearModel:
        """The lumped model with these coordinates behind its own."""
        model, first = self.elastic(lumped), lumped.size
        owners = np.array([label.rpartition(":")[0] for label in model.labels])
        kept, labels = [np.eye(model.size)[:, :first]], list(lumped.labels)
        for gear in dict.fromkeys(owners[first:].tolist()):
            own = first + np.flatnonzero(owners[first:] == gear)
            inside = static_vectors(model.rows[:, own], model.stiffness.diagonal()[own])
            vectors = np.zeros((model.size, inside.shape[1]))
            vectors[own] = inside
            kept.append(vectors)
            labels += [f"{gear}:bent {number + 1}" for number in range(inside.shape[1])]
        return transformed(model, np.concatenate(kept, axis=1), tuple(labels), lumped.lengths)


def static_vectors(rows: Array, stiffness: Array) -> Array:
    """Vectors X (k, p) that span K^-1 R^T with X^T K X = 1; rows R (m, k), stiffness K (k,)."""
    root = np.sqrt(stiffness)
    left, sizes, _ = np.linalg.svd(rows.T / root[:, None], full_matrices=False)
    return np.asarray(left[:, sizes > NOTHING * sizes.max()] / root[:, None])


def transformed(model: LinearModel, vectors: Array, labels: tuple[str, ...], lengths: Array) -> LinearModel:
    """A model in coordinates p, q = vectors p (n, m); lengths: of the first of them, others from the rows."""

    def within(matrix: Array) -> Array:
        return np.asarray(vectors.T @ matrix @ vectors)

    rows = model.rows @ vectors
    spin = model.spin
    if spin is not None:
        spin = Spin(within(spin.gyroscopic), within(spin.circulatory), within(spin.centrifugal))
    return replace(
        model,
        labels=labels,
        mass=within(model.mass),
        stiffness=within(model.stiffness),
        rows=rows,
        torques=vectors.T @ model.torques,
        forces=vectors.T @ model.forces,
        lengths=np.append(lengths, np.abs(rows[:, lengths.size :]).max(axis=0)),
        dampers=within(model.dampers),
        spin=spin,
    )
