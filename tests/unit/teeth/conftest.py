"""The paper's pair as a factory, where what a test does not name has the paper's value, and its teeth."""

from collections.abc import Callable
from math import radians

import pytest

from facegear.teeth.design import AssemblyErrors, FaceGearGeometry, PairDesign, PinionGeometry, Shaper
from facegear.teeth.flank_shapes import Relief
from facegear.teeth.mesh_sizes import named_sizes
from facegear.teeth.tooth_mesh import gear_tooth, pinion_tooth


def paper_pair(
    shaper_teeth: int = 26,
    shaper_addendum: float = 1.25,
    rack_tip_radius: float = 0.1,
    shift: float = 0.0,
    thinning: float = 0.0,
    tip_relief: Relief | None = None,
    tip_rounding: float = 0.0,
    **assembly: float,
) -> PairDesign:
    m = 3.75e-3
    pinion = PinionGeometry(
        teeth=23,
        width=0.030,
        addendum=m,
        dedendum=1.25 * m,
        rack_tip_radius=rack_tip_radius * m,
        bore_radius=0.025,
        profile_shift=shift * m,
        thinning=thinning,
        tip_relief=tip_relief or Relief(),
    )
    gear = FaceGearGeometry(
        teeth=143, inner_radius=0.250, outer_radius=0.275, addendum=m, rim_thickness=0.012
    )
    shaper = Shaper(shaper_teeth, shaper_addendum * m, tip_rounding * m)
    return PairDesign(m, radians(25), pinion, gear, shaper, AssemblyErrors(**assembly))


@pytest.fixture(scope="session")
def pair() -> Callable[..., PairDesign]:
    return paper_pair


@pytest.fixture(scope="session")
def design() -> PairDesign:
    return paper_pair()


@pytest.fixture(scope="session", params=["pinion", "face_gear"])
def tooth(request, design):
    build = pinion_tooth if request.param == "pinion" else gear_tooth
    return build(design, named_sizes("coarse", design.module))
