"""The standard's factors against published worked examples and closed forms."""

from math import radians, sqrt

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from facegear.strength.factors import (
    contact_ratio_factor,
    elasticity_factor,
    mean_stress_factor,
    relative_notch_sensitivity,
)
from facegear.strength.fatigue import damage, life_at_reliability
from facegear.strength.materials import Life
from facegear.strength.root_form import root_form
from facegear.strength.spur import SpurGear, SpurMesh

STEEL = (206e9, 0.3)
BENDING = Life((1e3, 3e6, 1e10), (2.5, 1.0, 0.85))


def fzg_c() -> SpurMesh:
    """FZG type C test gears: published with their form factors and stresses by a public tribology code."""
    pinion, wheel = (
        SpurGear(
            teeth=teeth,
            module=4.5e-3,
            pressure_angle=radians(20.0),
            profile_shift=shift,
            tip_radius=tip,
            width=14e-3,
            rack_addendum=1.25,
            rack_tip_radius=0.38,
        )
        for teeth, shift, tip in ((16, 0.1817, 41.318e-3), (24, 0.1715, 59.272e-3))
    )
    return SpurMesh(pinion, wheel, 91.5e-3)


def test_form_and_stress_correction_of_fzg_c_gears_match_the_published_ones():
    mesh = fzg_c()
    found = [root_form(gear, mesh.single_contact_radius(gear)) for gear in (mesh.pinion, mesh.wheel)]
    assert [form.form_factor for form in found] == pytest.approx([1.689, 1.583], rel=5e-3)
    assert [form.stress_correction for form in found] == pytest.approx([1.851, 1.917], rel=5e-3)


def test_stresses_of_fzg_c_gears_match_the_published_ones():
    mesh, torque = fzg_c(), 200.0
    working = mesh.centre_distance / (1.0 + mesh.ratio)
    force = torque / working  # the published code takes the force at the working circle
    bending = [
        force / (gear.width * gear.module) * form.form_factor * form.stress_correction
        for gear in (mesh.pinion, mesh.wheel)
        for form in [root_form(gear, mesh.single_contact_radius(gear))]
    ]
    assert bending == pytest.approx([271.2e6, 263.2e6], rel=5e-3)
    angle = mesh.working_angle
    zone = sqrt(2.0 * np.cos(angle) / (np.cos(radians(20.0)) ** 2 * np.sin(angle)))
    diameter = mesh.pinion.module * mesh.pinion.teeth
    line = force / (diameter * mesh.pinion.width) * (mesh.ratio + 1.0) / mesh.ratio
    stress = zone * elasticity_factor(STEEL, STEEL) * contact_ratio_factor(mesh.contact_ratio) * sqrt(line)
    assert stress == pytest.approx(1228.9e6, rel=1e-3)
    normal = torque / mesh.pinion.base_radius
    assert normal == pytest.approx(5912.1, rel=1e-4)
    hertz = elasticity_factor(STEEL, STEEL) * sqrt(normal / mesh.pinion.width / mesh.pitch_curvature_radius())
    assert hertz == pytest.approx(1347.3e6, rel=1e-3)


@given(st.floats(1.0, 12.0))
def test_life_factor_and_allowed_cycles_are_each_others_inverse(decades):
    cycles = 10.0**decades
    inside = np.clip(cycles, 1e3, 1e10 * (1 - 1e-9))
    assert BENDING.allowed_cycles(BENDING.factor(inside)) == pytest.approx(inside, rel=1e-6)


def test_damage_adds_cycles_over_allowed_ones_and_is_infinite_above_static_strength():
    stress = np.array([1.0, 0.8, 3.0])
    found = damage(stress, np.array([3e6, 1e12, 0.0]), 1.0, BENDING)
    assert found == pytest.approx([1.0, 0.0, 0.0])
    assert np.isinf(damage(np.array([3.0]), np.array([1.0]), 1.0, BENDING)).all()


def test_reference_gear_has_no_relative_notch_sensitivity_and_pulsation_no_mean_stress_factor():
    assert relative_notch_sensitivity(3e-6, 2.5) == pytest.approx(1.0)
    assert mean_stress_factor(0.0, 0.5) == 1.0
    assert mean_stress_factor(-1.2, 0.5) == pytest.approx(1.0 / (1.0 + 1.2 * 0.5 / 1.5))


def test_half_the_gears_live_longer_than_ninety_nine_percent_do():
    assert life_at_reliability(100.0, 0.99, 1.5) == pytest.approx(100.0)
    assert life_at_reliability(100.0, 0.5, 1.5) > 1000.0
