"""Both gears of a pair, meshed, condensed and put together for contact."""

from collections.abc import Callable

from facegear.contact.bodies.compliance import FlankCompliance, flank_compliance
from facegear.contact.flanks import flank_pair
from facegear.contact.ltca import ContactModel
from facegear.contact.options import ContactPlan, Ends
from facegear.contact.teeth import contact_side, elastic_tooth
from facegear.errors import ConfigError
from facegear.geometry.design import Material, PairDesign
from facegear.mesh.sizes import MeshSizes
from facegear.mesh.tooth import ToothMesh, gear_tooth, pinion_tooth

NEIGHBOURS = 2
"""Teeth on each side whose coupling is kept: at most three or four pairs touch at once."""

BUILDERS: dict[str, Callable[[PairDesign, MeshSizes], ToothMesh]] = {
    "pinion": pinion_tooth,
    "face_gear": gear_tooth,
}


def body_compliance(
    design: PairDesign, body: str, sizes: MeshSizes, material: Material, plan: ContactPlan
) -> FlankCompliance:
    """Flank compliance of the pinion or the face gear.

    Raises ConfigError for a sector with more teeth than the gear, FacegearError if the mesh cannot be
    factorised.
    """
    tooth = BUILDERS[body](design, sizes)
    elastic, _ = elastic_tooth(design, tooth, material)
    teeth, neighbours, ends = extent(tooth, body, plan)
    return flank_compliance(elastic, plan.refinement, teeth, neighbours, ends, plan.element)


def extent(tooth: ToothMesh, body: str, plan: ContactPlan) -> tuple[int, int, Ends]:
    """How many teeth of a body are modelled, the neighbours on each side that are kept, and what ends them.

    Raises ConfigError for a sector with more teeth than the gear.
    """
    sector = plan.sector
    wanted = sector.pinion_teeth if body == "pinion" else sector.face_gear_teeth
    if wanted is None:
        return tooth.teeth, min(NEIGHBOURS, (tooth.teeth - 3) // 2), "ring"
    if wanted > tooth.teeth:
        raise ConfigError(f"contact.sector.{body}_teeth", wanted, f"at most {tooth.teeth}")
    return wanted, min(NEIGHBOURS, (wanted - 3) // 2), sector.cut_faces


def contact_model(
    design: PairDesign, sizes: MeshSizes, pinion: FlankCompliance, gear: FlankCompliance
) -> ContactModel:
    """The pair with compliances made for the same design and sizes."""
    first, second = (contact_side(design, build(design, sizes)) for build in BUILDERS.values())
    cuts = pinion.refinement, gear.refinement
    return ContactModel(flank_pair(design, (first, second), cuts, pinion.linear), pinion, gear)
