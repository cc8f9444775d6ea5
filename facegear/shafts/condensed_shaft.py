"""A shaft on its bearings, condensed statically to the middle of the pinion that sits on it."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from facegear.arrays import AnyArray, Array
from facegear.errors import InvalidInput
from facegear.number_format import count_noun
from facegear.rigid_body import MOTIONS, carry_motion, is_held
from facegear.shafts.beam import Elasticity, Segment, clamped_compliance

LENGTH_ROUNDING = 1e-12
"""Part of a shaft's length by which rounding may put a bearing or the pinion beyond its end."""


@dataclass(frozen=True, eq=False)
class Bearing:
    """A bearing at a distance (m) from the beginning of the shaft, with its stiffness (5, 5) in x, y, z,
    tilt_x, tilt_y, SI units.
    """

    position: float
    stiffness: Array


@dataclass(frozen=True, eq=False)
class Shaft:
    """Segments from the end at the smallest z on, what they are made of, bearings, and where the pinion's
    middle is, m from the beginning.
    """

    segments: tuple[Segment, ...]
    material: Elasticity
    bearings: tuple[Bearing, ...]
    pinion: float

    def __post_init__(self) -> None:
        for name, position in (
            ("position of a shaft's pinion", self.pinion),
            *(("position of a shaft's bearing", bearing.position) for bearing in self.bearings),
        ):
            if not 0.0 <= position <= self.length * (1.0 + LENGTH_ROUNDING):
                raise InvalidInput(name, position, f"on the shaft, from 0 to {self.length:g} m")

    @property
    def length(self) -> float:
        """From end to end, m."""
        return sum(segment.length for segment in self.segments)


@dataclass(frozen=True, eq=False)
class CondensedShaft:
    """Support of a pinion: motions and loads are x, y, z, tilt_x, tilt_y at its middle, SI units.

    Attributes
    ----------
    compliance : (5, 5)
        Motions by loads.
    reactions : (bearings, 5, 5)
        Loads of the shaft on its bearings by those of the pinion on the shaft.
    """

    compliance: Array
    reactions: Array

    @cached_property
    def stiffness(self) -> Array:
        """Loads by motions (5, 5)."""
        return _symmetric(np.linalg.inv(self.compliance))

    @cached_property
    def square(self) -> Array:
        """Forces by displacements x, y, z (3, 3) where no moment acts: of a pinion that does not tilt in the
        model.
        """
        return _symmetric(np.linalg.inv(self.compliance[:3, :3]))

    def bearing_loads(self, loads: Array) -> Array:
        """Return the loads on the bearings by the loads of the pinion on the shaft.

        Parameters
        ----------
        loads : (..., 5) array
            N and N m.

        Returns
        -------
        (..., bearings, 5) array
            N and N m.
        """
        return np.einsum("bij,...j->...bi", self.reactions, loads)


def condense_shaft(shaft: Shaft) -> CondensedShaft:
    """Condense a shaft statically to the middle of its pinion.

    The shaft is clamped at its beginning and moved as a rigid one besides: the motions of its bearings and
    the rigid motion follow from what they give way and from the balance of all loads.

    Parameters
    ----------
    shaft : Shaft
        The shaft.

    Returns
    -------
    CondensedShaft
        SI units.

    Raises
    ------
    InvalidInput
        If the bearings do not hold the shaft.
    """
    distances = [bearing.position - shaft.pinion for bearing in shaft.bearings]
    if not is_held(distances, [bearing.stiffness for bearing in shaft.bearings], shaft.length):
        condition = "such that they hold it along its axis and against tilting"
        raise InvalidInput("bearings of a shaft", count_noun(len(shaft.bearings), "bearing"), condition)
    reactions, rigid_motion = _solve_balance(shaft)
    return CondensedShaft(_symmetric(_motion_at(shaft, shaft.pinion, reactions, rigid_motion)), reactions)


def deflections(shaft: Shaft, at: AnyArray) -> Array:
    """Return the motions of a shaft along its length by the loads of its pinion.

    Parameters
    ----------
    shaft : Shaft
        The shaft.
    at : (n,) array
        Distances from its beginning, m.

    Returns
    -------
    (n, 5, 5) array
        m/N, rad/N, m/(N m) and rad/(N m).
    """
    reactions, rigid_motion = _solve_balance(shaft)
    return np.array([_motion_at(shaft, float(position), reactions, rigid_motion) for position in at])


def _solve_balance(shaft: Shaft) -> tuple[Array, Array]:
    """Return the loads on the bearings (bearings, 5, 5) and the rigid motion of the beginning (5, 5) by the
    pinion's loads.
    """
    at = _load_positions(shaft)
    compliance = clamped_compliance(shaft.segments, shaft.material, at)
    count = len(shaft.bearings)
    springs = np.array([bearing.stiffness for bearing in shaft.bearings])
    rigid = np.array([carry_motion(position) for position in at])
    bearings = slice(0, MOTIONS * count)
    size = MOTIONS * (count + 1)
    system, load = np.zeros((size, size)), np.zeros((size, MOTIONS))
    system[bearings, bearings] = _flat(np.einsum("ijkl,jlm->ijkm", compliance[1:, 1:], springs))
    system[bearings, bearings] += np.eye(MOTIONS * count)
    system[bearings, MOTIONS * count :] = -_flat(rigid[1:, None])
    system[MOTIONS * count :, bearings] = _flat((rigid[1:].transpose(0, 2, 1) @ springs)[None])
    load[bearings], load[MOTIONS * count :] = _flat(compliance[1:, :1]), rigid[0].T
    solution = np.linalg.solve(system, load)
    reactions = springs @ solution[bearings].reshape(count, MOTIONS, MOTIONS)
    return np.asarray(reactions), np.asarray(solution[MOTIONS * count :])


def _motion_at(shaft: Shaft, position: float, reactions: Array, rigid_motion: Array) -> Array:
    """Return the motion (5, 5) at a distance from the beginning by the pinion's loads."""
    at = np.array([position, *_load_positions(shaft)])
    clamped_motions = clamped_compliance(shaft.segments, shaft.material, at)[0, 1:]
    bending = clamped_motions[0] - np.einsum("jkl,jlm->km", clamped_motions[1:], reactions)
    return np.asarray(carry_motion(position) @ rigid_motion + bending)


def _load_positions(shaft: Shaft) -> Array:
    """Return the distances from the beginning of pinion and bearings, m."""
    return np.array([shaft.pinion, *(bearing.position for bearing in shaft.bearings)])


def _flat(blocks: Array) -> Array:
    """Arrange blocks (rows, columns, 5, 5) as one matrix."""
    rows, columns = blocks.shape[:2]
    return blocks.transpose(0, 2, 1, 3).reshape(MOTIONS * rows, MOTIONS * columns)


def _symmetric(matrix: AnyArray) -> Array:
    return np.asarray(0.5 * (matrix + matrix.T))
