"""The plane-strain twin against finite elements that share none of its parts."""

from math import radians

import pytest
from references import against, agrees

from facegear.teeth.design import FaceGearGeometry, PairDesign, PinionGeometry, Shaper
from facegear.teeth.flank_shapes import Relief
from validation.contact.twin_study import twin_gears, twin_study

M = 3.75e-3


def design_with(**changes) -> PairDesign:
    pinion = PinionGeometry(23, 0.030, M, 1.25 * M, 0.1 * M, 0.025, **changes)
    return PairDesign(
        M, radians(25), pinion, FaceGearGeometry(143, 0.250, 0.275, M, 0.012), Shaper(26, 1.25 * M)
    )


def test_twin_of_a_modified_pair_is_the_standard_pair_without_backlash():
    modified = design_with(thinning=100e-6, tip_relief=Relief(20e-6, 0.0, 1e-3), lead_crowning=Relief(5e-6))
    assert twin_gears(modified, 143) == twin_gears(design_with(), 143)


@against(
    "third-party program",
    "scikit-fem: contact of both teeth on a mesh that resolves it; ISO 6336-1 for the size",
    capability="contact",
    module="facegear.contact.ltca",
)
@pytest.mark.xdist_group("contact_models")  # the largest group begins first: this would be the last of all
def test_twin_is_within_half_a_percent_of_brute_force_where_one_pair_carries():
    table = twin_study(design_with(), 23, (0.4, 0.1), positions=(0.6,), line_loads=(6e5,), sector=7)
    agrees(
        "difference of the mesh stiffness, percent", table["difference_percent"].iloc[0], 0.0, absolute=0.5
    )
    iso = table["iso_6336_c_gamma_n_per_mm_um"].iloc[0]
    agrees(
        "mesh stiffness beside c_gamma of ISO 6336-1, N/(mm um)",
        table["k_n_per_mm_um"].iloc[0],
        iso,
        relative=0.3,
    )
