"""Backlash and contact path of a pair as assembled."""

from dataclasses import replace

import numpy as np
import pytest

from facegear.report.figures.teeth import path_text
from facegear.teeth import unloaded_contact
from facegear.teeth.analysis import analyse
from facegear.teeth.design import AssemblyErrors
from facegear.teeth.document import pair_record
from facegear.teeth.flank_shapes import GearModifications, Relief
from facegear.teeth.placement import pinion_angle
from facegear.teeth.rays import gear_rays
from facegear.teeth.unloaded_contact import normal_backlash
from facegear.teeth.validate import check


def test_backlash_before_meshing_is_that_of_the_full_analysis_and_the_path_reported_is_the_real_one(pair):
    """The nominal radius was printed for a misaligned pair whose path lies elsewhere."""
    design = replace(pair(26), assembly=AssemblyErrors(offset=5e-5, shaft_angle_error=5e-4, gear_axial=2e-5))
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


def test_positions_that_are_asked_for_too_change_no_backlash_and_are_not_searched_again(pair, monkeypatch):
    design, searched = pair(26, tip_relief=Relief(15e-6, length=2e-3), offset=2e-5), []

    def counted(of, phi1, **named):
        searched.append(len(np.atleast_1d(phi1)))
        return original(of, phi1, **named)

    original = unloaded_contact.searched_contact
    alone = normal_backlash(design)
    unloaded_contact._searched_motion.cache_clear()
    monkeypatch.setattr(unloaded_contact, "searched_contact", counted)
    positions = tuple(number / 16 for number in range(16))
    assert normal_backlash(design, positions) == pytest.approx(alone, rel=1e-9)
    assert searched == [16, 4]  # the drive flank at all positions, the back flank at those of the backlash
    phi2, error = unloaded_contact.unloaded_motion(design, pinion_angle(design, positions))
    assert searched == [16, 4]
    monkeypatch.undo()
    again = original(design, pinion_angle(design, positions), every_pair=False)
    assert phi2 == pytest.approx(again.phi2, abs=1e-15) and error == pytest.approx(
        again.transmission_error, abs=1e-15
    )


def test_pairs_that_differ_in_modifications_and_assembly_alone_share_the_gear_that_is_generated(pair):
    plain = pair(26)
    made = replace(
        plain.face_gear, modifications=GearModifications(profile_crowning=Relief(1e-5, length=3e-3))
    )
    other = replace(pair(26, tip_relief=Relief(15e-6, length=2e-3), offset=2e-5), face_gear=made)
    assert gear_rays(other)[1] is gear_rays(plain)[1]
    check.cache_clear()  # a process that has checked many designs may hold one of the two
    assert check(other) is check(plain)
    assert gear_rays(pair(25))[1] is not gear_rays(plain)[1]
