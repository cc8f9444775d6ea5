"""The loaded flank of one gear with its compliance, and both gears of a pair together."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from math import pi

import numpy as np

from facegear.arrays import AnyArray, Arrays, Integers
from facegear.contact.bodies import compliance
from facegear.contact.bodies.compliance import FlankCompliance, flank_compliance
from facegear.contact.flanks import flank_pair
from facegear.contact.ltca import ContactModel
from facegear.contact.options import ContactPlan, Ends
from facegear.contact.root_gauges import RootGauges, root_gauges, section_errors
from facegear.contact.teeth import ContactSide, elastic_tooth, is_mirrored_across
from facegear.errors import InvalidInput
from facegear.teeth.design import Material, PairDesign
from facegear.teeth.mesh_quality import require_right_side_out
from facegear.teeth.mesh_sizes import MeshSizes
from facegear.teeth.placement import GEARS, distinct_pairs, nominal_pairs, nominal_teeth
from facegear.teeth.tooth_mesh import FeTooth, gear_tooth, pinion_tooth


@dataclass(frozen=True, eq=False)
class GearFlank:
    """Contact surface of a tooth, compliance of the gear's flanks, and root gauges, if any."""

    side: ContactSide
    compliance: FlankCompliance
    gauges: RootGauges | None = None

    def softer(self, factor: float) -> "GearFlank":
        """Return the flank with Young's modulus divided by a factor; its gauges read the same stress.

        Parameters
        ----------
        factor : float
            Old over new Young's modulus, dimensionless.

        Returns
        -------
        GearFlank
            Flank whose displacements are `factor` times as large.
        """
        flank_compliance = self.compliance
        return replace(self, compliance=replace(flank_compliance, scale=factor * flank_compliance.scale))


ARRAY_SHAPES = {
    **compliance.ARRAY_SHAPES,
    "flank_nodes": (None, None),
    "flank_u": (None, None),
    "flank_v": (None, None),
    "flank_rows": (1,),
    "junction": (None,),
    "gauge_position_m": (None, None, None, None),
    "gauge_across": (None, None, None, None),
    "gauge_error": (None,),
}
"""Names and shapes of the arrays of a stored flank; u, v and junction as in `ContactSide`."""


def to_arrays(flank: GearFlank) -> dict[str, AnyArray]:
    """Return named arrays from which `from_arrays` rebuilds the flank.

    Parameters
    ----------
    flank : GearFlank
        Flank to store.

    Returns
    -------
    dict of arrays
        Arrays with the (...) shapes of ARRAY_SHAPES.
    """
    side, gauges = flank.side, flank.gauges
    empty_gauges = np.zeros((0, 0, 0, 3))
    return {
        **compliance.to_arrays(flank.compliance),
        "flank_nodes": side.nodes,
        "flank_u": side.u,
        "flank_v": side.v,
        "flank_rows": np.array([side.flank_rows]),
        "junction": side.junction,
        "gauge_position_m": empty_gauges if gauges is None else gauges.position,
        "gauge_across": empty_gauges if gauges is None else gauges.across,
        "gauge_error": np.zeros(0) if gauges is None else gauges.error,
    }


def every_flank_to_arrays(flanks: Sequence[GearFlank]) -> dict[str, AnyArray]:
    """Return named arrays from which `every_flank_from_arrays` rebuilds the flanks of a body.

    Parameters
    ----------
    flanks : Sequence[GearFlank]
        Flank in each pair of bodies.

    Returns
    -------
    dict of arrays
        Arrays with the (...) shapes of ARRAY_SHAPES for the first pair, and for each further one the same
        with its number in front of their names.
    """
    further = {
        f"{number}_{name}": values
        for number, flank in enumerate(flanks[1:], 1)
        for name, values in to_arrays(flank).items()
    }
    return {**to_arrays(flanks[0]), **further}


def every_flank_from_arrays(arrays: Arrays) -> list[GearFlank]:
    """Rebuild the flanks of a body in all pairs of bodies.

    Parameters
    ----------
    arrays : Arrays
        Arrays of `every_flank_to_arrays`.

    Returns
    -------
    list[GearFlank]
        Flank in each pair of bodies.
    """
    flanks = [from_arrays(arrays)]
    while f"{len(flanks)}_shape" in arrays:
        flanks.append(from_arrays({name: arrays[f"{len(flanks)}_{name}"] for name in ARRAY_SHAPES}))
    return flanks


def from_arrays(arrays: Arrays) -> GearFlank:
    """Rebuild a flank from the arrays of `to_arrays`.

    Parameters
    ----------
    arrays : Arrays
        Arrays as ARRAY_SHAPES.

    Returns
    -------
    GearFlank
        The flank.
    """
    side = ContactSide(
        nodes=arrays["flank_nodes"],
        u=arrays["flank_u"],
        v=arrays["flank_v"],
        flank_rows=int(arrays["flank_rows"][0]),
        junction=arrays["junction"],
    )
    position, across = arrays["gauge_position_m"], arrays["gauge_across"]
    gauges = RootGauges(position, across, arrays["gauge_error"]) if position.size else None
    return GearFlank(side, compliance.from_arrays(arrays), gauges)


NEIGHBOURS = 2
"""Teeth on each side whose coupling is kept: at most three or four pairs touch at once."""

BUILDERS: dict[str, Callable[[PairDesign, MeshSizes], FeTooth]] = {
    "pinion": pinion_tooth,
    "face_gear": gear_tooth,
}
"""Function that builds the finite elements of a tooth, by body."""


def gear_flank(
    design: PairDesign,
    body: str,
    sizes: MeshSizes,
    material: Material,
    plan: ContactPlan,
    section: bool = True,
) -> GearFlank:
    """Compute contact surface, flank compliance and, if the plan has root stress, gauges of the pinion or the
    face gear.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    body : str
        `pinion` or `face_gear`.
    sizes : MeshSizes
        Element sizes.
    material : Material
        Of the gear.
    plan : ContactPlan
        Refinement, sector and element.
    section : bool
        Whether gauges come with the error of their section.

    Returns
    -------
    GearFlank
        Flank of the gear.

    Raises
    ------
    InvalidInput
        For a sector with more teeth than the gear, and for a mesh with elements turned inside out.
    FacegearError
        If the mesh cannot be factorised.
    """
    return _flank_of(design, BUILDERS[body](design, sizes), sizes, material, plan, section)


def _flank_of(
    design: PairDesign,
    tooth: FeTooth,
    sizes: MeshSizes,
    material: Material,
    plan: ContactPlan,
    section: bool,
    image: GearFlank | None = None,
) -> GearFlank:
    """Return `gear_flank` of a tooth that is meshed already.

    `image` is the flank of a tooth that is this one in a mirror across the face, whose compliance is taken.
    """
    require_right_side_out(tooth)
    elastic, side = elastic_tooth(design, tooth, material)
    teeth, neighbours, ends = extent(tooth, tooth.body, plan)
    gauges, rows = None, None
    if plan.root_stress:
        is_estimated, build = section and image is None, BUILDERS[tooth.body]
        errors = section_errors(design, tooth.body, build, sizes, material) if is_estimated else None
        gauges, rows = root_gauges(tooth, material, errors)
    if image is not None:
        shape = (0, 0, 0)
        if gauges is not None and image.gauges is not None:
            gauges = replace(gauges, error=image.gauges.error[::-1])
            shape = gauges.position.shape[:3]
        return GearFlank(side, image.compliance.reverse_along_face(shape), gauges)
    compliance = flank_compliance(elastic, plan.refinement, teeth, neighbours, ends, plan.element, rows)
    return GearFlank(side, compliance, gauges)


def extent(tooth: FeTooth, body: str, plan: ContactPlan) -> tuple[int, int, Ends]:
    """Return how many teeth of a body are modelled, from the plan's sector.

    Without a number in the plan, all teeth are modelled, as a ring.

    Parameters
    ----------
    tooth : FeTooth
        Mesh of a tooth.
    body : str
        `pinion` or `face_gear`.
    plan : ContactPlan
        Sector that is modelled.

    Returns
    -------
    tuple[int, int, Ends]
        Number of teeth that are modelled, number of neighbours on each side whose coupling is kept, and
        the kind of ends.

    Raises
    ------
    InvalidInput
        For a sector with more teeth than the gear.
    """
    sector = plan.sector
    teeth = sector.pinion_teeth if body == "pinion" else sector.face_gear_teeth
    if teeth is None:
        return tooth.teeth, min(NEIGHBOURS, (tooth.teeth - 3) // 2), "ring"
    if teeth > tooth.teeth:
        raise InvalidInput(f"modelled teeth of the {body.replace('_', ' ')}", teeth, f"at most {tooth.teeth}")
    return teeth, min(NEIGHBOURS, (teeth - 3) // 2), sector.cut_faces


def contact_model(design: PairDesign, pinion: GearFlank, gear: GearFlank) -> ContactModel:
    """Build the contact model of a pair from flanks made for the same design.

    Whether displacements are linear between nodes is taken from the pinion's compliance for both gears.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    pinion : GearFlank
        Flank of the pinion.
    gear : GearFlank
        Flank of the face gear.

    Returns
    -------
    ContactModel
        The model.
    """
    first, second = pinion.compliance, gear.compliance
    cuts = first.refinement, second.refinement
    return ContactModel(flank_pair(design, (pinion.side, gear.side), cuts, first.linear), first, second)


PairFlanks = tuple[GearFlank, GearFlank]
"""Flank of the pinion, and the flank of the face gear that it drives."""


RIGHT_ANGLE = pi / 2
"""Shaft angle (rad) of axes that cross at a right angle."""


def gear_flanks(
    design: PairDesign,
    body: str,
    sizes: MeshSizes,
    material: Material,
    plan: ContactPlan,
    gears: Sequence[str] = GEARS,
) -> list[GearFlank]:
    """Compute the flanks of a body in all pairs of bodies that both gears' both flanks need.

    Coast flanks are the drive flanks of the mirrored pair, with a mesh of their own. Where that mesh is
    another one in a mirror across the face, as that of a helical pinion without taper is, the two have one
    compliance.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    body : str
        `pinion` or `face_gear`.
    sizes : MeshSizes
        Element sizes.
    material : Material
        Of the body.
    plan : ContactPlan
        Refinement, sector and element.
    gears : Sequence[str]
        Gears that there are, of `upper` and `lower`.

    Returns
    -------
    list[GearFlank]
        Flank in each of `placement.nominal_pairs`.

    Raises
    ------
    InvalidInput, FacegearError
        As `gear_flank` does.
    """
    flanks: dict[PairDesign, GearFlank] = {}
    teeth: dict[PairDesign, FeTooth] = {}
    keys = [_mesh_key(pair, body) for pair in nominal_pairs(design, gears)]
    for key, pair in zip(keys, nominal_pairs(design, gears), strict=True):
        if key not in flanks:
            tooth = BUILDERS[body](pair, sizes)
            images = [flanks[known_key] for known_key in teeth if is_mirrored_across(tooth, teeth[known_key])]
            teeth[key] = tooth
            flanks[key] = _flank_of(pair, tooth, sizes, material, plan, True, next(iter(images), None))
    return [flanks[key] for key in keys]


def _mesh_key(pair: PairDesign, body: str) -> PairDesign:
    """Return the pair as far as a body's mesh depends on it: a pinion's does not on how its axis stands."""
    return replace(pair, shaft_angle=RIGHT_ANGLE, offset=0.0) if body == "pinion" else pair


def gears_of(design: PairDesign, flanks: Sequence[PairFlanks]) -> Sequence[str]:
    """Return the gears that flanks are of: `upper` alone where those of another lower gear are missing.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    flanks : Sequence[tuple[GearFlank, GearFlank]]
        Flanks of the first of `placement.nominal_pairs`.

    Returns
    -------
    Sequence[str]
        Names of the gears.
    """
    return GEARS if len(flanks) >= len(nominal_pairs(design)) else GEARS[:1]


def flank_models(
    design: PairDesign, flanks: Sequence[PairFlanks], gears: Sequence[str] | None = None
) -> tuple[list[ContactModel], Integers]:
    """Build the contact models of all flanks that differ, each on the bodies that it belongs to.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    flanks : Sequence[tuple[GearFlank, GearFlank]]
        Flanks of `placement.nominal_pairs`, in their order; models of missing ones are left out.
    gears : Sequence[str], optional
        Gears that there are, of `upper` and `lower`; those of `gears_of` if not given.

    Returns
    -------
    tuple[list[ContactModel], Integers]
        Models, that of the upper gear's drive flank first, and the number of the model of each gear's
        each flank, (2, 2), as `placement.distinct_pairs` returns it.
    """
    different, numbers = distinct_pairs(design, gears or gears_of(design, flanks))
    bodies = dict(zip(nominal_pairs(design), flanks, strict=False))
    pair_bodies = [(pair, bodies.get(nominal_teeth(pair))) for pair in different]
    return [contact_model(pair, *flanks) for pair, flanks in pair_bodies if flanks is not None], numbers


def flanks_of(pair: PairDesign, design: PairDesign, flanks: Sequence[PairFlanks]) -> PairFlanks:
    """Return the flanks of a pair, one of those of a design in any assembly and with any deviations.

    Parameters
    ----------
    pair : PairDesign
        Pair by `placement.pair_at` of the design, maybe in another assembly.
    design : PairDesign
        Pair of gears.
    flanks : Sequence[tuple[GearFlank, GearFlank]]
        Flanks of `placement.nominal_pairs` of the design.

    Returns
    -------
    tuple[GearFlank, GearFlank]
        Flank of the pinion, and the flank of the face gear that it drives.
    """
    return flanks[nominal_pairs(design).index(nominal_teeth(pair))]
