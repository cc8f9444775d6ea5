"""Coordinates of a casing among those of a machine: where they stand, and which unknowns statics has."""

from dataclasses import dataclass, replace

import numpy as np

from facegear.arrays import AnyArray, Array, Integers
from facegear.casing.reduction import own_modes
from facegear.machine.linear_model import CondensedCasing, LinearModel, Spin

CASING = "casing"
"""Body of the casing's coordinates, before the colon in their labels."""
CASING_MODE = 0.5
"""Part of the kinetic energy in the casing from which a mode is one of the casing: a free choice."""
RANK = 1e-10
"""Part of the largest singular value up to which a direction of the casing is one that no flank feels."""


@dataclass(frozen=True, eq=False)
class SeatMotion:
    """Change from motions of bodies to their motions against their seats, v = q - H u.

    Attributes
    ----------
    motion : (b, c)
        H: motions of the first b coordinates by the c of the casing.
    at : slice
        Coordinates of the casing among all of the model.
    stiffness : (c, c)
        Of the casing and of shafts between its seats, SI units.
    modes : (k,)
        Coordinates of the model that are modes of the casing.
    """

    motion: Array
    at: slice
    stiffness: Array
    modes: Integers

    def absolute(self, displacements: Array) -> Array:
        """Return the motions of bodies from those against their seats.

        Parameters
        ----------
        displacements : (K, n) array
            Unknowns v and all other coordinates, m and rad.

        Returns
        -------
        (K, n) array
            q and all other coordinates.
        """
        absolute = displacements.copy()
        absolute[:, : len(self.motion)] += displacements[:, self.at] @ self.motion.T
        return absolute

    def along_relative(self, rows: Array) -> Array:
        """Return loads or flank rows by the unknowns v and u from those by q and u.

        Parameters
        ----------
        rows : (..., n) array
            Any unit.

        Returns
        -------
        (..., n) array
            In the same unit.
        """
        relative = rows.copy()
        relative[..., self.at] += rows[..., : len(self.motion)] @ self.motion
        return relative

    def relative_stiffness(self, stiffness: Array) -> Array:
        """Return the stiffness by v and u, in which no bearing joins a body with its seat.

        Parameters
        ----------
        stiffness : (n, n) array
            By q and u, SI units.

        Returns
        -------
        (n, n) array
            SI units.
        """
        relative = stiffness.copy()
        bodies = slice(0, len(self.motion))
        relative[bodies, self.at] = relative[self.at, bodies] = 0.0
        relative[self.at, self.at] = self.stiffness
        return relative


def casing_motion(linear: LinearModel, displacements: AnyArray) -> AnyArray:
    """Return the motions of the casing among the displacements of a machine on it.

    Parameters
    ----------
    linear : LinearModel
        Linear model of the machine.
    displacements : (..., n) array
        Displacements of all coordinates, real or complex, m and rad.

    Returns
    -------
    (..., c) array
        Motions of seats, feet and modes, m and rad.
    """
    if linear.condensed_casing is not None:
        motion: AnyArray = (
            displacements @ linear.over_all(linear.condensed_casing.casing).T + linear.condensed_casing.rest
        )
        return motion
    return displacements[..., np.array([label.startswith(f"{CASING}:") for label in linear.labels])]


def casing_start(linear: LinearModel) -> int:
    """Return the index of the first coordinate of the casing.

    Parameters
    ----------
    linear : LinearModel
        Linear model of a machine on a casing.

    Returns
    -------
    int
        Index among all coordinates.
    """
    return next(n for n, label in enumerate(linear.labels) if label.startswith(f"{CASING}:"))


def keep_slow_motions(model: LinearModel, limit: float) -> LinearModel:
    """Return a model whose casing has slow motions as coordinates, while the others follow statically.

    All bodies held, the motions of the casing part into two kinds (Craig and Bampton 1968). The first answer
    the flanks, which move the casing beside the bodies where gears tilt with their seats: these are all kept.
    The others are modes with the first kind held, kept up to the limit. Whatever flanks and bodies load, the
    casing rests where all of its coordinates have it.

    Parameters
    ----------
    model : LinearModel
        Linear model with a casing behind all other coordinates, the tangents of rolling bearings included.
    limit : float
        Highest frequency of the modes, Hz.

    Returns
    -------
    LinearModel
        Coordinates of bodies stay.
    """
    first = casing_start(model)
    stiffness = model.stiffness[first:, first:]
    slow = _slow_motions(model, limit)
    motions = np.zeros((model.size, first + slow.shape[1]))
    motions[:first, :first] = np.eye(first)
    # The casing follows the bodies statically; its slow motions are what it does beside that.
    motions[first:, :first] = -np.linalg.solve(stiffness, model.stiffness[first:, :first])
    motions[first:, first:] = slow
    spin = model.spin
    if spin is not None:
        parts = (spin.gyroscopic, spin.circulatory, spin.centrifugal)
        spin = Spin(*(motions.T @ part @ motions for part in parts))
    loads, tangent_loads = model.loads[first:], model.tangent_loads
    static_motion = slow @ np.linalg.solve(slow.T @ stiffness @ slow, slow.T @ loads)
    rest = np.asarray(np.linalg.solve(stiffness, loads) - static_motion)
    if tangent_loads is not None:
        tangent_loads = tangent_loads[:first] - model.stiffness[:first, first:] @ rest
    labels = [f"{CASING}:motion {number}" for number in range(1, slow.shape[1] + 1)]
    assert model.seat_tilts is not None
    return replace(
        model,
        labels=(*model.labels[:first], *labels),
        mass=motions.T @ model.mass @ motions,
        stiffness=motions.T @ model.stiffness @ motions,
        rows=model.rows @ motions,
        torques=model.torques @ motions,
        forces=model.forces @ motions,
        lengths=np.append(
            model.lengths[:first], np.abs(model.lengths[:, None] * motions)[:, first:].max(axis=0)
        ),
        dampers=motions.T @ model.dampers @ motions,
        spin=spin,
        tangent_loads=tangent_loads,
        seat_tilts=model.seat_tilts @ motions,
        condensed_casing=CondensedCasing(
            model.stiffness[:first] @ motions, model.dampers[:first] @ motions, motions[first:], rest
        ),
    )


def _slow_motions(model: LinearModel, limit: float) -> Array:
    """Return the motions (c, k) of a casing below bodies that stand still: those that answer the flanks, then
    modes up to a limit in Hz with these held.
    """
    first = casing_start(model)
    stiffness, mass = model.stiffness[first:, first:], model.mass[first:, first:]
    lengths = model.lengths[first:]
    _, sizes, directions = np.linalg.svd(model.rows[:, first:] / lengths)
    count = int((sizes > RANK * sizes.max(initial=0.0)).sum())
    flank_motions, unfelt = directions[:count] * lengths, directions[count:].T / lengths[:, None]
    answers = np.linalg.solve(stiffness, flank_motions.T)
    # Answers without mass have no motion of their own.
    slow_parts = []
    for basis, highest in ((answers, np.inf), (unfelt, limit)):
        if basis.size:
            frequencies, shapes = own_modes(basis.T @ stiffness @ basis, basis.T @ mass @ basis)
            slow_parts.append(basis @ shapes[:, frequencies <= highest])
    return np.hstack(slow_parts)
