"""Contact model of a pair: both gears are meshed and condensed one by one."""

from collections.abc import Callable

from facegear.contact.bodies.compliance import flank_compliance
from facegear.contact.flanks import flank_pair
from facegear.contact.gear_flank import GearFlank
from facegear.contact.ltca import ContactModel
from facegear.contact.options import ContactPlan, Ends
from facegear.contact.root_gauges import root_gauges
from facegear.contact.section_error import section_errors
from facegear.contact.teeth import elastic_tooth
from facegear.errors import InvalidInput
from facegear.geometry.design import Material, PairDesign
from facegear.mesh.quality import require_right_side_out
from facegear.mesh.sizes import MeshSizes
from facegear.mesh.tooth import FeTooth, gear_tooth, pinion_tooth

NEIGHBOURS = 2
"""Teeth on each side whose coupling is kept: at most three or four pairs touch at once."""

BUILDERS: dict[str, Callable[[PairDesign, MeshSizes], FeTooth]] = {
    "pinion": pinion_tooth,
    "face_gear": gear_tooth,
}


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
    tooth = BUILDERS[body](design, sizes)
    require_right_side_out(tooth)
    elastic, side = elastic_tooth(design, tooth, material)
    teeth, neighbours, ends = extent(tooth, body, plan)
    gauges, rows = None, None
    if plan.root_stress:
        errors = section_errors(design, body, BUILDERS[body], sizes, material) if section else None
        gauges, rows = root_gauges(tooth, material, errors)
    compliance = flank_compliance(elastic, plan.refinement, teeth, neighbours, ends, plan.element, rows)
    return GearFlank(side, compliance, gauges)


def extent(tooth: FeTooth, body: str, plan: ContactPlan) -> tuple[int, int, Ends]:
    """Return the extent of a body's model.

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
