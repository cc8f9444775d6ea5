"""The paper's pair at a resolution for tests, condensed once for a session."""

from collections.abc import Callable

import pytest
from contact_bodies import COARSE, FINE, STEEL, pair_design

from facegear.contact.gear_flank import contact_model, gear_flank
from facegear.contact.ltca import ContactModel
from facegear.contact.options import ContactOptions, ContactPlan, Refinement, Sector
from facegear.teeth.design import PairDesign
from facegear.teeth.mesh_sizes import MeshSizes


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """All tests of the pair's models go to one process, which condenses each of them once."""
    for item in items:
        if "model_of" in getattr(item, "fixturenames", ()):
            item.add_marker(pytest.mark.xdist_group("contact_models"))


def build_model(design: PairDesign, sizes: MeshSizes, cuts: Refinement) -> ContactModel:
    plan = ContactPlan((600.0,), 4, cuts, Sector(), ContactOptions())
    bodies = [gear_flank(design, body, sizes, STEEL, plan) for body in ("pinion", "face_gear")]
    return contact_model(design, *bodies)


@pytest.fixture(scope="session")
def model_of() -> Callable[..., ContactModel]:
    """Contact models by design and resolution, each condensed once."""
    known: dict[tuple[PairDesign, bool], ContactModel] = {}

    def model(coarse: bool = False, **changes: object) -> ContactModel:
        key = pair_design(**changes), coarse
        if key not in known:
            known[key] = build_model(key[0], *(COARSE if coarse else FINE))
        return known[key]

    return model
