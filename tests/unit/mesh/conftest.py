"""The paper's pair and its teeth at the coarse level."""

from math import radians

import pytest

from facegear.teeth.design import FaceGearGeometry, PairDesign, PinionGeometry, Shaper
from facegear.teeth.mesh_sizes import named_sizes
from facegear.teeth.tooth_mesh import gear_tooth, pinion_tooth


@pytest.fixture(scope="session")
def design() -> PairDesign:
    m = 3.75e-3
    pinion = PinionGeometry(23, 0.030, m, 1.25 * m, 0.1 * m, 0.025)
    return PairDesign(
        m, radians(25), pinion, FaceGearGeometry(143, 0.250, 0.275, m, 0.012), Shaper(26, 1.25 * m)
    )


@pytest.fixture(scope="session", params=["pinion", "face_gear"])
def tooth(request, design):
    build = pinion_tooth if request.param == "pinion" else gear_tooth
    return build(design, named_sizes("coarse", design.module))
