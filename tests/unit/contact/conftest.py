"""The paper's pair at a resolution for tests, condensed once for a session."""

from collections.abc import Callable
from math import radians

import pytest

from facegear.contact.ltca import ContactModel
from facegear.contact.options import ContactOptions, ContactPlan, Refinement, Sector
from facegear.contact.pair import body_compliance, contact_model
from facegear.geometry.design import FaceGear, Material, PairDesign, Pinion, Relief, Shaper
from facegear.mesh.sizes import MeshSizes

STEEL = Material(206e9, 0.3)
SIZES = MeshSizes(1.5e-3, 3.2e-3, 3e-3)
CUTS = Refinement(4, 2, 2, 2.0)


def pair_design(
    shaper_teeth: int = 26,
    rack_tip_radius: float = 0.1,
    pinion_width: float = 0.030,
    radii: tuple[float, float] = (0.250, 0.275),
    tip_relief: Relief | None = None,
) -> PairDesign:
    m = 3.75e-3
    pinion = Pinion(
        23, pinion_width, m, 1.25 * m, rack_tip_radius * m, 0.025, tip_relief=tip_relief or Relief()
    )
    return PairDesign(m, radians(25), pinion, FaceGear(143, *radii, m, 0.012), Shaper(shaper_teeth, 1.25 * m))


def build_model(design: PairDesign, cuts: Refinement = CUTS, sizes: MeshSizes = SIZES) -> ContactModel:
    plan = ContactPlan((600.0,), 4, cuts, Sector(), ContactOptions())
    bodies = [body_compliance(design, body, sizes, STEEL, plan) for body in ("pinion", "face_gear")]
    return contact_model(design, sizes, *bodies)


@pytest.fixture(scope="session")
def model_of() -> Callable[..., ContactModel]:
    """Contact models by design, each condensed once."""
    known: dict[PairDesign, ContactModel] = {}

    def model(**changes: object) -> ContactModel:
        design = pair_design(**changes)
        if design not in known:
            known[design] = build_model(design)
        return known[design]

    return model
