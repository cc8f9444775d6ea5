"""The paper's pair at a resolution for tests, condensed once for a session."""

from collections.abc import Callable

import pytest
from contact_bodies import STEEL, pair_design

from facegear.contact.ltca import ContactModel
from facegear.contact.options import ContactOptions, ContactPlan, Refinement, Sector
from facegear.contact.pair import contact_model, gear_flank
from facegear.geometry.design import PairDesign
from facegear.mesh.sizes import MeshSizes

SIZES = MeshSizes(1.5e-3, 3.2e-3, 3e-3)
CUTS = Refinement(4, 2, 2, 2.0)


def build_model(design: PairDesign, cuts: Refinement = CUTS, sizes: MeshSizes = SIZES) -> ContactModel:
    plan = ContactPlan((600.0,), 4, cuts, Sector(), ContactOptions())
    bodies = [gear_flank(design, body, sizes, STEEL, plan) for body in ("pinion", "face_gear")]
    return contact_model(design, *bodies)


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
