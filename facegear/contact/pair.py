"""Both gears of a pair: meshed and condensed one by one, put together for contact."""

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
    """Contact surface, flank compliance and, where asked for, gauges of the pinion or the face gear.

    section: whether gauges come with the error of their section.

    Raises InvalidInput for a sector with more teeth than the gear and for a mesh with elements turned inside
    out, FacegearError if the mesh cannot be factorised.
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
    """How many teeth of a body are modelled, the neighbours on each side that are kept, and what ends them.

    Raises InvalidInput for a sector with more teeth than the gear.
    """
    sector = plan.sector
    wanted = sector.pinion_teeth if body == "pinion" else sector.face_gear_teeth
    if wanted is None:
        return tooth.teeth, min(NEIGHBOURS, (tooth.teeth - 3) // 2), "ring"
    if wanted > tooth.teeth:
        raise InvalidInput(
            f"modelled teeth of the {body.replace('_', ' ')}", wanted, f"at most {tooth.teeth}"
        )
    return wanted, min(NEIGHBOURS, (wanted - 3) // 2), sector.cut_faces


def contact_model(design: PairDesign, pinion: GearFlank, gear: GearFlank) -> ContactModel:
    """The pair with flanks made for the same design."""
    first, second = pinion.compliance, gear.compliance
    cuts = first.refinement, second.refinement
    return ContactModel(flank_pair(design, (pinion.side, gear.side), cuts, first.linear), first, second)
