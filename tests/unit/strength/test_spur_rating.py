"""The standard's factors against published worked examples and closed forms."""

from math import radians, sqrt

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from references import against, agrees
from spur_gears import din_3990_11, fzg_c

from facegear.build.strength import material_card
from facegear.schema.cards import CARDS
from facegear.strength.materials import Life, damage
from facegear.strength.root_form import (
    STRESS_CORRECTION_REFERENCE,
    contact_ratio_factor,
    elasticity_factor,
    mean_stress_factor,
    relative_notch_sensitivity,
    root_form,
)

STEEL = (206e9, 0.3)
BENDING = Life((1e3, 3e6, 1e10), (2.5, 1.0, 0.85))


@against(
    "external source",
    "published form factors and stresses of FZG type C gears",
    capability="rating",
    module="facegear.strength.root_form",
)
def test_form_and_stress_correction_of_fzg_c_gears_match_the_published_ones():
    mesh = fzg_c()
    found = [root_form(gear, mesh.single_contact_radius(gear)) for gear in (mesh.pinion, mesh.wheel)]
    agrees("form factor Y_F", [form.form_factor for form in found], [1.689, 1.583], relative=5e-3)
    agrees("stress correction Y_S", [form.stress_correction for form in found], [1.851, 1.917], relative=5e-3)


@against(
    "external source",
    "published form factors and stresses of FZG type C gears",
    capability="rating",
    module="facegear.strength.root_form",
)
def test_stresses_of_fzg_c_gears_match_the_published_ones():
    mesh, torque = fzg_c(), 200.0
    working = mesh.centre_distance / (1.0 + mesh.ratio)
    force = torque / working  # the published code takes the force at the working circle
    bending = [
        force / (gear.width * gear.module) * form.form_factor * form.stress_correction
        for gear in (mesh.pinion, mesh.wheel)
        for form in [root_form(gear, mesh.single_contact_radius(gear))]
    ]
    agrees("root stress at the working circle's force, Pa", bending, [271.2e6, 263.2e6], relative=5e-3)
    reference = working / (0.5 * mesh.pinion.module * mesh.pinion.teeth)  # the standard's force is larger
    agrees(
        "root stress at the standard's force, Pa",
        [reference * stress for stress in bending],
        [271.2e6, 263.2e6],
        relative=0.0135,
    )
    angle = mesh.working_angle
    zone = sqrt(2.0 * np.cos(angle) / (np.cos(radians(20.0)) ** 2 * np.sin(angle)))
    diameter = mesh.pinion.module * mesh.pinion.teeth
    line = force / (diameter * mesh.pinion.width) * (mesh.ratio + 1.0) / mesh.ratio
    stress = zone * elasticity_factor(STEEL, STEEL) * contact_ratio_factor(mesh.contact_ratio) * sqrt(line)
    agrees("contact stress, Pa", stress, 1228.9e6, relative=1e-3)
    normal = torque / mesh.pinion.base_radius
    agrees("normal force, N", normal, 5912.1, relative=1e-4)
    hertz = elasticity_factor(STEEL, STEEL) * sqrt(normal / mesh.pinion.width / mesh.pitch_curvature_radius())
    agrees("pressure at the pitch point, Pa", hertz, 1347.3e6, relative=1e-3)


@against(
    "third-party program",
    "DIN 3990-11 example of a public code that prints every factor (hanslhansl/din3990)",
    capability="rating",
    module="facegear.strength.root_form",
)
def test_form_and_stress_correction_of_the_din_3990_11_example_for_a_load_at_the_tip():
    """To 1e-4: that code stops the iteration for the 30 degree tangent earlier."""
    mesh = din_3990_11()
    found = [root_form(gear, gear.tip_radius) for gear in (mesh.pinion, mesh.wheel)]
    printed = {
        "chord": [8.748743e-3, 9.239505e-3],
        "fillet_radius": [1.316148e-3, 1.325999e-3],
        "lever_arm": [8.174658e-3, 7.834246e-3],
        "form_factor": [2.246336, 2.161657],
        "stress_correction": [1.914726, 2.008782],
    }
    for name, values in printed.items():
        agrees(f"root form: {name}", [getattr(form, name) for form in found], values, relative=1e-4)
    assert mesh.contact_ratio == pytest.approx(1.536323594583, rel=1e-9)


@against(
    "third-party program",
    "DIN 3990-11 example of a public code that prints every factor (hanslhansl/din3990)",
    capability="rating",
    module="facegear.strength.root_form",
)
def test_safety_of_the_din_3990_11_example_with_its_load_factors():
    """Load factors, Z_B and Y_epsilon are the example's; its notch, surface and size factors are 1."""
    mesh, card = din_3990_11(), material_card(CARDS / "case_carburised_din3990_11.yaml")
    force = 55e3 / (2 * np.pi * 980 / 60) / (0.5 * mesh.pinion.module * mesh.pinion.teeth)
    line = force / mesh.pinion.width
    angle = mesh.working_angle
    zone = sqrt(2.0 * np.cos(angle) / (np.cos(radians(20.0)) ** 2 * np.sin(angle)))
    diameter = mesh.pinion.module * mesh.pinion.teeth
    pitting = zone * elasticity_factor(STEEL, STEEL) * contact_ratio_factor(mesh.contact_ratio)
    pitting *= sqrt(line / diameter * (mesh.ratio + 1.0) / mesh.ratio)
    agrees("contact stress, Pa", pitting, 875.3827378988e6, relative=1e-3)  # Z_E is rounded there, 189.8
    loads = 1.75 * 1.0278576 * 1.1064273
    (limit, life), bending = (card.pitting.limit, card.pitting.life), card.bending
    endurance, static = float(life.factor(5e7)), float(life.factor(1.0))
    found = limit / (pitting * 1.0055470 * sqrt(loads))
    agrees("safety against pitting", found * endurance, 1.20793605, relative=1e-3)
    statically = 2.5 * 1.0278576 * 1.1064273
    at_rest = static * limit / (pitting * 1.0055470 * sqrt(statically))
    agrees("static safety against pitting", at_rest, 1.61701090, relative=1e-3)
    form = root_form(mesh.pinion, mesh.pinion.tip_radius)
    stress = line / mesh.pinion.module * form.form_factor * form.stress_correction * 0.7381784
    agrees("root stress, Pa", stress, 230.1514e6, relative=1e-4)
    bent = 1.75 * 1.0278576 * 1.0864854
    agrees(
        "safety against bending",
        bending.limit * STRESS_CORRECTION_REFERENCE / (stress * bent),
        1.91200876,
        relative=1e-4,
    )


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
