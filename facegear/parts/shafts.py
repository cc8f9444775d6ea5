"""Shafts on bearings (Timoshenko beams), condensed statically to the middle of their pinion.

Round shafts that bend, shear and stretch (Timoshenko). Motions of a point are x, y, z, tilt_x, tilt_y, with z
along the shaft: right-handed rotations, so that without shear dx/dz = tilt_y and dy/dz = -tilt_x.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy as np

from facegear.arrays import AnyArray, Array
from facegear.errors import InvalidInput
from facegear.number_format import count_noun
from facegear.rigid_body import MOTIONS, carry_motion, is_held


@dataclass(frozen=True)
class Elasticity:
    """Young's modulus (Pa) and Poisson's ratio."""

    young: float
    poisson: float

    @property
    def shear(self) -> float:
        """Shear modulus, Pa."""
        return self.young / (2.0 * (1.0 + self.poisson))


@dataclass(frozen=True)
class Segment:
    """A piece of shaft between two steps: its length, outer diameter and bore diameter, m."""

    length: float
    diameter: float
    bore: float = 0.0

    def __post_init__(self) -> None:
        for name in ("length", "diameter"):
            if (value := getattr(self, name)) <= 0.0:
                raise InvalidInput(f"{name} of a shaft's segment", value, "above 0 m")
        if not 0.0 <= self.bore < self.diameter:
            requirement = f"from 0 to below the diameter of {self.diameter:g} m"
            raise InvalidInput("bore of a shaft's segment", self.bore, requirement)

    @property
    def area(self) -> float:
        """Area of the cross-section, m2."""
        return 0.25 * np.pi * (self.diameter**2 - self.bore**2)

    @property
    def second_moment(self) -> float:
        """Second moment of the cross-section about a diameter, m4; the polar one is twice that."""
        return np.pi / 64.0 * (self.diameter**4 - self.bore**4)

    def shear_coefficient(self, poisson: float) -> float:
        """Return the shear coefficient of hollow circles (Cowper 1966); 6 (1 + nu) / (7 + 6 nu) for a solid
        one.

        Parameters
        ----------
        poisson : float
            Poisson's ratio nu.

        Returns
        -------
        float
            Shear coefficient, dimensionless.
        """
        hollow = (self.bore / self.diameter) ** 2
        squared = (1.0 + hollow) ** 2
        below = (7.0 + 6.0 * poisson) * squared + (20.0 + 12.0 * poisson) * hollow
        return 6.0 * (1.0 + poisson) * squared / below

    def torsional_stiffness(self, material: Elasticity) -> float:
        """Return the torsional stiffness of the segment, G times polar second moment over length.

        Parameters
        ----------
        material : Elasticity
            Elasticity of the shaft.

        Returns
        -------
        float
            N m/rad.
        """
        return material.shear * 2.0 * self.second_moment / self.length


def section_flexibility(segment: Segment, material: Elasticity) -> Array:
    """Return the strains of a cross-section for each m of length by unit loads: 1 / (kappa G A) for x and
    y, 1 / (E A) for z, 1 / (E I) for the tilts.

    Parameters
    ----------
    segment : Segment
        The segment.
    material : Elasticity
        Its elasticity.

    Returns
    -------
    (5,) array
        Order x, y, z, tilt_x, tilt_y; 1/N and 1/(N m2).
    """
    shear = segment.shear_coefficient(material.poisson) * material.shear * segment.area
    bending = material.young * segment.second_moment
    return 1.0 / np.array([shear, shear, material.young * segment.area, bending, bending])


def clamped_compliance(segments: Sequence[Segment], material: Elasticity, at: Array) -> Array:
    """Return the motion at each distance by a load at each, of a shaft clamped at its beginning.

    Virtual work: the integral of the strains of all sections between the clamp and the nearer of both
    distances, which is a polynomial of second degree between two steps; Simpson's rule is exact.

    Parameters
    ----------
    segments : Sequence of Segment
        Segments from the clamped end on.
    material : Elasticity
        Their elasticity.
    at : (n,) array
        Distances from the clamped end, m.

    Returns
    -------
    (n, n, 5, 5) array
        Entry [i, j, a, b]: motion a at distance i by a unit load b at distance j; m/N, rad/N, m/(N m) and
        rad/(N m).
    """
    compliance = np.zeros((at.size, at.size, MOTIONS, MOTIONS))
    distances: list[float] = at.tolist()
    begin = 0.0
    for segment in segments:
        flexibility = section_flexibility(segment, material)
        for (i, motion_position), (j, load_position) in product(enumerate(distances), enumerate(distances)):
            end = min(begin + segment.length, motion_position, load_position)
            if end > begin:
                for section, weight in ((begin, 1.0), (0.5 * (begin + end), 4.0), (end, 1.0)):
                    strained = flexibility[:, None] * carry_motion(load_position - section).T
                    compliance[i, j] += (
                        weight / 6.0 * (end - begin) * carry_motion(motion_position - section) @ strained
                    )
        begin += segment.length
    return compliance


LENGTH_ROUNDING = 1e-12
"""Part of a shaft's length by which rounding may put a bearing or the pinion beyond its end."""


@dataclass(frozen=True, eq=False)
class Bearing:
    """A bearing of a shaft.

    position: distance (m) from the beginning of the shaft; stiffness (5, 5): loads by motions x, y, z,
    tilt_x, tilt_y of the shaft there, SI units.
    """

    position: float
    stiffness: Array


@dataclass(frozen=True, eq=False)
class Shaft:
    """A stepped shaft on bearings that carries a pinion.

    - segments: from the end at the smallest z on
    - material: elasticity of all segments
    - bearings: at their distances from that end
    - pinion: distance of the pinion's middle from that end, m
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
        """Loads (5,) on the shaft by motions of the pinion's middle: the inverse of `compliance`, (5, 5),
        SI units.
        """
        return _symmetric(np.linalg.inv(self.compliance))

    @cached_property
    def square(self) -> Array:
        """Forces by displacements x, y, z where no moment acts, (3, 3), N/m: the inverse of that block of
        `compliance`.

        It holds a pinion whose tilts are not coordinates of the model.
        """
        return _symmetric(np.linalg.inv(self.compliance[:3, :3]))

    def bearing_loads(self, loads: Array) -> Array:
        """Return the loads of the shaft on its bearings by the loads of the pinion on the shaft.

        Parameters
        ----------
        loads : (..., 5) array
            x, y, z, tilt_x, tilt_y at the pinion's middle, N and N m.

        Returns
        -------
        (..., bearings, 5) array
            In the same order at each bearing, N and N m.
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


@dataclass(frozen=True, eq=False)
class SeatedShaft:
    """Shaft on bearings whose outer rings move, condensed to its pinion; SI units.

    Attributes
    ----------
    motion : (5, 5 bearings)
        Motion of the pinion's middle by the motions of the rings, with no load on it.
    strain : (5 bearings, 5 bearings)
        Loads that hold the rings at their motions, with no load on the pinion. Rigid motions have none.
    """

    motion: Array
    strain: Array


def follow_rings(shaft: Shaft) -> SeatedShaft:
    """Compute how a shaft follows the outer rings of its bearings.

    Parameters
    ----------
    shaft : Shaft
        The shaft.

    Returns
    -------
    SeatedShaft
        SI units.
    """
    count = len(shaft.bearings)
    springs = np.array([bearing.stiffness for bearing in shaft.bearings])
    strained, rigid_motion = _solve_rings(shaft)
    compliance = clamped_compliance(shaft.segments, shaft.material, _load_positions(shaft))[0, 1:]
    reactions = np.einsum("bij,bjk->bik", springs, strained.reshape(count, MOTIONS, -1))
    motion = carry_motion(shaft.pinion) @ rigid_motion - np.einsum("bij,bjk->ik", compliance, reactions)
    return SeatedShaft(motion, _symmetric(-reactions.reshape(MOTIONS * count, -1)))


def deflections(shaft: Shaft, at: AnyArray) -> Array:
    """Return the motions of a shaft on its bearings, along its length, by unit loads of its pinion.

    Parameters
    ----------
    shaft : Shaft
        The shaft.
    at : (n,) array
        Distances from its beginning, m.

    Returns
    -------
    (n, 5, 5) array
        Motions x, y, z, tilt_x, tilt_y (rows) by loads in the same order (columns); m/N, rad/N, m/(N m)
        and rad/(N m).
    """
    reactions, rigid_motion = _solve_balance(shaft)
    return np.array([_motion_at(shaft, float(position), reactions, rigid_motion) for position in at])


def _solve_balance(shaft: Shaft) -> tuple[Array, Array]:
    """Return the bearings' loads and the rigid motion of a shaft by unit loads of its pinion.

    The first, (bearings, 5, 5), are loads of the shaft on each bearing (rows) by the pinion's loads
    (columns). The second, (5, 5), is the rigid motion at the shaft's beginning. One linear system holds
    the motion of each bearing and the balance of all loads.
    """
    count = len(shaft.bearings)
    system, compliance, rigid = _balance_system(shaft)
    bearings = slice(0, MOTIONS * count)
    load = np.zeros((len(system), MOTIONS))
    load[bearings], load[MOTIONS * count :] = _flat(compliance[1:, :1]), rigid[0].T
    solution = np.linalg.solve(system, load)
    springs = np.array([bearing.stiffness for bearing in shaft.bearings])
    reactions = springs @ solution[bearings].reshape(count, MOTIONS, MOTIONS)
    return np.asarray(reactions), np.asarray(solution[MOTIONS * count :])


def _solve_rings(shaft: Shaft) -> tuple[Array, Array]:
    """Return what a shaft without load does by unit motions of its outer rings, all bearings in a row.

    The first, (5 bearings, 5 bearings), are motions of the shaft against each ring; the second, (5, 5
    bearings), is the rigid motion at the shaft's beginning.
    """
    motions = MOTIONS * len(shaft.bearings)
    system, _, _ = _balance_system(shaft)
    load = np.zeros((len(system), motions))
    load[:motions] = -np.eye(motions)
    solution = np.linalg.solve(system, load)
    return np.asarray(solution[:motions]), np.asarray(solution[motions:])


def _balance_system(shaft: Shaft) -> tuple[Array, Array, Array]:
    """Return the linear system of `_solve_balance`, with the compliance of the clamped shaft between pinion
    and bearings (1 + bearings, 1 + bearings, 5, 5), and their rigid motions (1 + bearings, 5, 5).
    """
    at = _load_positions(shaft)
    compliance = clamped_compliance(shaft.segments, shaft.material, at)
    count = len(shaft.bearings)
    springs = np.array([bearing.stiffness for bearing in shaft.bearings])
    rigid = np.array([carry_motion(position) for position in at])
    bearings = slice(0, MOTIONS * count)
    size = MOTIONS * (count + 1)
    system = np.zeros((size, size))
    system[bearings, bearings] = _flat(np.einsum("ijkl,jlm->ijkm", compliance[1:, 1:], springs))
    system[bearings, bearings] += np.eye(MOTIONS * count)
    system[bearings, MOTIONS * count :] = -_flat(rigid[1:, None])
    system[MOTIONS * count :, bearings] = _flat((rigid[1:].transpose(0, 2, 1) @ springs)[None])
    return system, compliance, rigid


def _motion_at(shaft: Shaft, position: float, reactions: Array, rigid_motion: Array) -> Array:
    """Return the motion (5, 5) at a distance (m) from the beginning by unit loads of the pinion.

    reactions, rigid_motion: as `_solve_balance` returns them.
    """
    at = np.array([position, *_load_positions(shaft)])
    clamped_motions = clamped_compliance(shaft.segments, shaft.material, at)[0, 1:]
    bending = clamped_motions[0] - np.einsum("jkl,jlm->km", clamped_motions[1:], reactions)
    return np.asarray(carry_motion(position) @ rigid_motion + bending)


def _load_positions(shaft: Shaft) -> Array:
    """Return the distances from the beginning of the pinion, then of all bearings, (1 + bearings,), m."""
    return np.array([shaft.pinion, *(bearing.position for bearing in shaft.bearings)])


def _flat(blocks: Array) -> Array:
    """Return blocks (rows, columns, 5, 5) as one matrix (5 rows, 5 columns)."""
    rows, columns = blocks.shape[:2]
    return blocks.transpose(0, 2, 1, 3).reshape(MOTIONS * rows, MOTIONS * columns)


def _symmetric(matrix: AnyArray) -> Array:
    """Return the symmetric part of a matrix, which removes rounding."""
    return np.asarray(0.5 * (matrix + matrix.T))
