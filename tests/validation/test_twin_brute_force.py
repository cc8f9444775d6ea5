"""The plane-strain twin against finite elements that share none of its parts."""

from math import radians

import pytest

from facegear.contact.validation.twin_study import twin_study
from facegear.geometry.design import FaceGear, PairDesign, Pinion, Shaper

M = 3.75e-3


def test_twin_is_within_half_a_percent_of_brute_force_where_one_pair_carries():
    design = PairDesign(
        M,
        radians(25),
        Pinion(23, 0.030, M, 1.25 * M, 0.1 * M, 0.025),
        FaceGear(143, 0.250, 0.275, M, 0.012),
        Shaper(26, 1.25 * M),
    )
    table = twin_study(design, 23, (0.2, 0.1), positions=(0.6,), line_loads=(6e5,), sector=7)
    assert abs(table["difference_percent"].iloc[0]) < 0.5
    iso = table["iso_6336_c_gamma_n_per_mm_um"].iloc[0]
    assert table["k_n_per_mm_um"].iloc[0] == pytest.approx(iso, rel=0.3)
