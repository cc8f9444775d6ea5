"""Backlash and contact path of a pair as assembled."""

from dataclasses import replace

import pytest

from facegear.geometry.analysis import analyse
from facegear.geometry.backlash import normal_backlash
from facegear.geometry.design import AssemblyErrors
from facegear.geometry.document import pair_record
from facegear.plots.tooth_pair import path_text


def test_backlash_before_meshing_is_that_of_the_full_analysis_and_the_path_reported_is_the_real_one(pair):
    """The nominal radius was printed for a misaligned pair whose path lies elsewhere."""
    design = replace(pair(26), assembly=AssemblyErrors(offset=5e-5, shaft_angle_error=5e-4, axial_shift=2e-5))
    analysis = analyse(design, positions=8)
    assert normal_backlash(design) == pytest.approx(analysis.backlash.min(), abs=1e-9)
    message = path_text(pair_record(design, analysis))
    where = float(message.split()[3])
    assert where == pytest.approx(1e3 * analysis.drive.path[1].mean(), abs=1e-3)
    assert abs(where - 1e3 * design.gear_pitch_radius) > 0.1
    assert message.endswith(", nominal 268.125 mm")


def test_the_path_of_a_pair_without_errors_is_the_nominal_one(pair):
    design = pair(26)
    message = path_text(pair_record(design, analyse(design, positions=4)))
    assert float(message.split()[3]) == pytest.approx(268.125, abs=0.005) and "nominal" not in message
    assert normal_backlash(design) == design.pinion.thinning
