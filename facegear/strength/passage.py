"""Root stress of a tooth on its way through the mesh, its largest value, and its error along the face.

Error of root stress from the distance of planes along the face, by a mesh with twice that distance. A section
of the tooth shows what the mesh misses across the profile (`facegear.contact.root_gauges`). It does not
show how contact is spread over the planes along the face, nor how they follow the stress to a sharp end.

Stress is linear in the forces. The largest that a unit force on a node makes anywhere down the fillet, in one
plane across the face, bounds what all forces together can make there; stress is only superposed where this
bound exceeds the largest that is known. Forces, all compressed by rows, stand tooth by tooth and position by
position.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from facegear._kernels import strength
from facegear.arrays import Array, Arrays, Integers
from facegear.contact.gear_flank import GearFlank, contact_model, gear_flank
from facegear.contact.ltca import loaded_contact
from facegear.contact.nodal_loads import load_arrays, loads_by_tooth
from facegear.contact.options import ContactPlan
from facegear.errors import InvalidInput
from facegear.quantities import BODIES, Body
from facegear.strength.contact_pressure import scale
from facegear.strength.root_stress import LONE, RootStress, down_the_fillet, root_stress
from facegear.teeth.design import Material, PairDesign
from facegear.teeth.mesh_sizes import MeshSizes


def passing(body: str, flank: GearFlank, loads: Arrays, variant: int = 0) -> RootStress:
    """Superpose the root stress of one body under the loads of stage contact on its flank.

    Forces on its fillet are left out: the gauges below would read the dent. The teeth read run from the
    one before the first loaded tooth to the one after the last.

    Parameters
    ----------
    body : str
        `pinion` or `face_gear`.
    flank : GearFlank
        Flank of the body, with gauges on its fillets.
    loads : Arrays
        Arrays of nodal loads (LOAD_ARRAYS).
    variant : int
        Index of the variant of assembly errors in `loads`.

    Returns
    -------
    RootStress
        Root stress over torque and passage.

    Raises
    ------
    InvalidInput
        Where the fillets carry no gauges.
    """
    if flank.gauges is None:
        raise InvalidInput("gauges on the fillets", False, "true, for root stress")
    loaded_teeth = loads[f"{body}_tooth"]
    return root_stress(
        flank.compliance.readings,
        loads_by_tooth(loads, body, flank.side.flank_rows * flank.side.shape[1], variant),
        np.unique(loads["torque_n_m"]),
        np.unique(loads["position"]),
        flank.gauges.along(body),
        flank.gauges.tangent_angle,
        flank.gauges.error,
        np.arange(loaded_teeth.min() - 1, loaded_teeth.max() + 2),
    )


FIRST = 16
"""Number of places whose stress is superposed first, those with the largest bounds."""


@dataclass(frozen=True, eq=False)
class PassingTension:
    """Root stress of one body by the forces on its flank, ready to be superposed for many sets of forces.

    Attributes
    ----------
    body
        `pinion` or `face_gear`.
    flank_nodes
        Number of nodes of the contact surface, before refinement, that belong to the flank.
    readings : (2 d + 1, 2, a, b, c)
        Readings of `FlankCompliance`, Pa/N, by distance of the tooth, fillet, a gauges down it, b along
        the face and loaded node.
    bounds : (2, 2 d + 1, c, 2 b)
        Largest stress (Pa, 0 at least) in each plane of both fillets, by a unit force on a node that
        pushes into the surface (index 0), and by one that pulls (1).
    """

    body: str
    flank_nodes: int
    readings: Array
    bounds: Array

    @classmethod
    def of_flank(cls, body: str, flank: GearFlank) -> "PassingTension":
        """Prepare the readings and bounds of a flank with gauges.

        Parameters
        ----------
        body : str
            `pinion` or `face_gear`.
        flank : GearFlank
            The flank.

        Returns
        -------
        PassingTension
            Readings and their bounds.

        Raises
        ------
        InvalidInput
            Where the fillets carry no gauges.
        """
        if flank.gauges is None:
            raise InvalidInput("gauges on the fillets", False, "true, for root stress")
        readings = flank.compliance.readings
        readings = readings.reshape(len(readings), *flank.gauges.tangent_angle.shape, -1)
        bounds = np.stack([np.stack([_bounds(sign * part) for part in readings]) for sign in (-1.0, 1.0)])
        return cls(body, flank.side.flank_rows * flank.side.shape[1], readings, bounds)

    def under(self, loads: Arrays, variant: int = 0) -> Callable[[float], float]:
        """Return the largest stress on either fillet over the passage and the face, as a function of torque.

        Forces on the body's own fillet are left out.

        Parameters
        ----------
        loads : Arrays
            LOAD_ARRAYS.
        variant : int
            Number of the variant whose loads act.

        Returns
        -------
        Callable[[float], float]
            Stress (Pa) at a torque (N m).
        """
        by_tooth = loads_by_tooth(loads, self.body, self.flank_nodes, variant)
        torques, count = np.unique(loads["torque_n_m"]), np.unique(loads["position"]).size
        teeth = np.array(sorted(by_tooth))
        # loads of flanks with more nodes make the matrices wider than this flank is
        nodes = self.readings.shape[-1]
        every = sp.vstack([by_tooth[tooth] for tooth in teeth], format="csr")[:, :nodes]
        first_rows = np.arange(teeth.size)[:, None] * (torques.size * count)

        def force(row: int) -> sp.csr_matrix:
            """Return the forces (teeth positions, c), N, at the torque of index `row`, tooth by tooth."""
            return every[(first_rows + np.arange(row * count, (row + 1) * count)).ravel()]

        def largest(torque: float) -> float:
            """Return the largest stress (Pa) at a torque (N m), with forces interpolated between the
            solved torques.
            """
            first = int(np.clip(np.searchsorted(torques, torque) - 1, 0, max(torques.size - 2, 0)))
            near = range(first, min(first + 2, torques.size))
            ends = [force(row) for row in near]
            bounds = [_stress_bounds(end, teeth, self.bounds) for end in ends]
            stress = np.array(
                [
                    self._largest(end, teeth, bound, splined=False)
                    for end, bound in zip(ends, bounds, strict=True)
                ]
            )
            growth = scale(torques[list(near)], stress, LONE, 1.0)
            (row,), (below,), (above,) = growth.parts(np.array([torque]))
            force_at_torque = below * ends[row] + (above * ends[row + 1] if above > 0.0 else 0.0 * ends[row])
            # neither factor is negative: bounds add up as forces do
            bound = below * bounds[row] + (above * bounds[row + 1] if above > 0.0 else 0.0)
            return self._largest(force_at_torque, teeth, bound, splined=True)

        return largest

    def _largest(self, force: sp.csr_matrix, teeth: Integers, bounds: Array, splined: bool) -> float:
        """Return the largest stress (Pa) at the gauges, or with `splined` of the splines down the fillet
        through them.

        `force` (teeth positions, c): N on the nodes of the loaded `teeth`. No stress is larger than
        `bounds`, by tooth, position and plane as `_stress_bounds` returns them; places are superposed by
        falling bound until the rest cannot exceed the largest found.
        """
        left, largest = bounds.ravel().copy(), -np.inf
        while (above := np.flatnonzero(left > largest)).size:
            if above.size > FIRST:
                above = above[np.argpartition(-left[above], FIRST)[:FIRST]]
            indices = np.stack(np.unravel_index(above, bounds.shape), axis=1)
            stress = np.empty((len(indices), self.readings.shape[2]))
            forces = force.indptr, force.indices, force.data, teeth
            strength.superpose(*forces, self.readings, indices, stress)
            if splined:
                stress = down_the_fillet(stress[:, :, None])[..., 0]
            largest, left[above] = max(largest, float(stress.max())), -np.inf
        return largest


def _bounds(stress: Array) -> Array:
    """Return the largest stress down each plane of both fillets, 0 at least, (c, 2 b), by unit forces on
    c nodes.

    `stress` (2, a, b, c): stress at the gauges by each force, Pa/N; splines between gauges count, too.
    """
    down = np.moveaxis(stress, 1, -1)[..., None]
    between = down_the_fillet(down)[..., 0].max(axis=-1)
    largest = np.maximum(np.maximum(stress.max(axis=1), between), 0.0)
    return np.ascontiguousarray(largest.reshape(-1, largest.shape[-1]).T)


def _stress_bounds(force: sp.csr_matrix, teeth: Integers, bounds: Array) -> Array:
    """Return upper bounds (t, positions, 2 b), Pa, of the stress in each plane of both fillets, of all
    teeth read.

    The t teeth run from the one before the first of the loaded `teeth` to the one after the last. `force`
    (teeth positions, c): N on nodes; `bounds` as in PassingTension.
    """
    reach, forces = bounds.shape[1] // 2, force.toarray().reshape(teeth.size, -1, force.shape[1])
    pushes, pulls = np.maximum(forces, 0.0), np.maximum(-forces, 0.0)
    limits = np.zeros((teeth[-1] - teeth[0] + 3, forces.shape[1], bounds.shape[3]))
    for read, limit in enumerate(limits, teeth[0] - 1):
        for tooth, push, pull in zip(teeth, pushes, pulls, strict=True):
            if abs(read - tooth) <= reach:
                apart = read - tooth + reach
                limit += push @ bounds[0, apart] + pull @ bounds[1, apart]
    return limits


ORDER, SAFETY = 2.0, 1.25
"""Power of the distance that the error goes with, and factor of the grid convergence index (Roache 1994)."""
NEAR = 0.9
"""Part of the largest stress from which on a place along the face counts: the largest may lie there."""


def coarser_roots(
    design: PairDesign,
    materials: Mapping[Body, Material],
    sizes: MeshSizes,
    plan: ContactPlan,
    roots: Mapping[Body, RootStress],
) -> dict[Body, RootStress]:
    """Solve root stress with twice the distance of planes along the face.

    It is solved at the smallest and the largest torque, at the positions where tension below the loaded
    flank is largest at either.

    Parameters
    ----------
    design : PairDesign
        The pair that is in contact.
    materials : Mapping[Body, Material]
        Material of each body.
    sizes : MeshSizes
        Mesh sizes that `roots` are from.
    plan : ContactPlan
        Contact analysis that `roots` are from.
    roots : Mapping[Body, RootStress]
        Root stress of each body.

    Returns
    -------
    dict[Body, RootStress]
        Root stress of each body by the coarser mesh.

    Raises
    ------
    NotConverged
        Where the contact of the coarser mesh is not solved.
    """
    wide = replace(sizes, width=2.0 * sizes.width)
    flanks: dict[Body, GearFlank] = {
        body: gear_flank(design, body, wide, materials[body], plan, section=False) for body in BODIES
    }
    torques = sorted({float(ends) for root in roots.values() for ends in root.torques[[0, -1]]})
    positions = sorted({position for root in roots.values() for position in _worst_positions(root)})
    model = contact_model(design, flanks["pinion"], flanks["face_gear"])
    results = loaded_contact(model, positions, torques, plan.options)
    loads = load_arrays([results], np.zeros((2, 2), dtype=np.int64))
    return {body: passing(body, flank, loads) for body, flank in flanks.items()}


def face_error(root: RootStress, coarser: RootStress) -> float:
    """Estimate the relative error of the largest tension by Richardson's rule.

    It is SAFETY abs(coarse - fine) / (2^ORDER - 1) over the largest tension, the worst of all torques. The
    difference at the places where stress is near its largest counts, not that of the largest values:
    these lie at gauges, which stand elsewhere on another mesh, and may agree by chance.

    Parameters
    ----------
    root : RootStress
        Root stress by the mesh whose error is estimated.
    coarser : RootStress
        Root stress with twice the distance of planes along the face.

    Returns
    -------
    float
        Error, relative; nan where the face has too few elements for planes twice as far apart.
    """
    if coarser.along.size >= root.along.size:
        return float("nan")
    within = np.isin(_positions(root), _positions(coarser))
    largest = 0.0
    for row, torque in enumerate(coarser.torques):
        at = int(np.argmin(np.abs(root.torques - torque)))
        fine = _along_face(root.stress[at, within])
        coarse = np.interp(root.along, coarser.along, _along_face(coarser.stress[row]))
        inside = (root.along >= coarser.along[0]) & (root.along <= coarser.along[-1])
        near = (fine >= NEAR * fine.max()) & inside
        largest = max(largest, float(np.abs(coarse - fine).max(where=near, initial=0.0) / fine.max()))
    return SAFETY * largest / (2.0**ORDER - 1.0)


def _along_face(stress: Array) -> Array:
    """Return the largest tension (b,), Pa, below the loaded flank over a passage, of stress (n, 2, a, b)."""
    return np.asarray(down_the_fillet(stress[:, 0]).max(axis=(0, 1)))


def _positions(root: RootStress) -> Array:
    """Return the mesh position in pitches (n,), 0 to 1, of each place of the passage, rounded to 9
    digits.
    """
    return np.round(root.passage % 1.0, 9)


def _worst_positions(root: RootStress) -> set[float]:
    """Return the positions in the pitch where tension is largest at the smallest and at the
    largest torque.
    """
    worst = {int(root.stress[row, :, 0].max(axis=(1, 2)).argmax()) for row in (0, -1)}
    return {float(_positions(root)[index]) for index in worst}
