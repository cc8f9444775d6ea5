"""Loaded contact of every kind of teeth on finite elements: both flanks, balance, and the spur limit."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from contact_bodies import COARSE, STEEL, pair_design, sound
from family_pairs import public_pair
from public_teeth import NAMES

from facegear.contact.analysis import contact_analysis
from facegear.contact.bodies import compliance
from facegear.contact.bodies.compliance import flank_compliance
from facegear.contact.gear_flank import (
    BUILDERS,
    contact_model,
    every_flank_from_arrays,
    every_flank_to_arrays,
    gear_flank,
    gear_flanks,
)
from facegear.contact.ltca import loaded_contact
from facegear.contact.options import ContactOptions, ContactPlan, Sector
from facegear.contact.pattern import LTCA_COLUMNS, pattern_margins
from facegear.contact.summary import BY_FLANK_COLUMNS, WRENCH_QUANTITIES
from facegear.contact.teeth import LOADED_SIDE, elastic_tooth
from facegear.contact.tooth_errors import loaded_curves
from facegear.teeth.flank_shapes import DeviationGrid
from facegear.teeth.limits import radius_limits
from facegear.teeth.placement import mirror_design, nominal_pairs

SIZES, CUTS = COARSE
PLAN = ContactPlan((200.0, 500.0), 3, CUTS, Sector(3, 3), ContactOptions())
UPPER = ("upper",)


@pytest.fixture(scope="module")
def bodies_of():
    """Flanks of all pairs of bodies of the upper gear, by name of a public design, condensed once."""
    known = {}

    def bodies(name):
        if name not in known:
            design = public_pair(name)
            parts = [gear_flanks(design, body, SIZES, STEEL, PLAN, UPPER) for body in BUILDERS]
            known[name] = list(zip(*parts, strict=True))
        return known[name]

    return bodies


@pytest.mark.parametrize("name", NAMES)
def test_both_flanks_balance_their_torque_with_the_axial_force_of_their_helicoids(bodies_of, name):
    design = public_pair(name)
    found = contact_analysis(design, (STEEL, STEEL), bodies_of(name), PLAN)
    assert len(found.models) == (1 if design.is_symmetric else 2)
    for model, (results, pressure), table in zip(found.models, found.results, found.wrenches, strict=True):
        flank = model.design.family.pinion_flanks[0]
        sound(results)
        expected = -table["torque_n_m"] * flank.sine / model.design.normal_arm
        error = np.abs(table["pinion_axial_n"] - expected) / (table["torque_n_m"] / model.design.normal_arm)
        # an edge presses along the opposite flank's normal or has a mean normal of its own
        assert error.max() < 0.02
        for loads in pressure.loads:
            assert np.isfinite(loads.pressure[loads.edge == 0]).all()
    assert list(found.by_flank.columns) == [*BY_FLANK_COLUMNS, "load_share_max", *WRENCH_QUANTITIES]
    assert len(found.by_flank) == 4 * len(PLAN.torques)


@pytest.mark.parametrize("name", NAMES)
def test_wrench_at_every_position_has_the_torque_about_the_pinions_axis(bodies_of, name):
    design = public_pair(name)
    table = contact_analysis(design, (STEEL, STEEL), bodies_of(name), PLAN, every_flank=False).ltca[0]
    assert tuple(table.columns) == (*LTCA_COLUMNS, *WRENCH_QUANTITIES)
    force, moment = np.split(table[list(WRENCH_QUANTITIES[:6])].to_numpy(), 2, axis=1)
    place, axis = np.array([design.offset, 0.0, 0.0]), design.family.motion.basis[1]
    error = -((moment - np.cross(place, force)) @ axis) / table["torque_n_m"] - 1.0
    assert np.abs(error).max() < 1e-3  # loads on edges have lever arms of their own
    assert np.abs(error).min() < 1e-9


@pytest.mark.parametrize("name", ["P1", "P3"])
def test_mirrored_pair_has_the_compliance_of_the_coast_flanks_on_the_same_mesh(bodies_of, name):
    """The coast flanks are solved as the drive flanks of the mirrored pair, with its own mesh."""
    design = public_pair(name)
    for number, (body, build) in enumerate(BUILDERS.items()):
        tooth, side = build(design, SIZES), "left" if LOADED_SIDE[body] == "right" else "right"
        elastic, _ = elastic_tooth(design, tooth, STEEL, side)
        coast = flank_compliance(elastic, CUTS, 3, 0, "free")
        mirrored = bodies_of(name)[1][number].compliance
        scale = mirrored.loaded_tooth.max()
        np.testing.assert_allclose(coast.loaded_tooth, mirrored.loaded_tooth, rtol=1e-7, atol=1e-8 * scale)


@pytest.mark.parametrize("name", NAMES)
def test_more_material_on_every_tooth_comes_early_by_as_much_and_patterns_know_their_edges(bodies_of, name):
    design, bodies = public_pair(name), bodies_of(name)
    found = contact_analysis(design, (STEEL, STEEL), bodies, PLAN)
    sides = {body: flank.side for body, flank in zip(BUILDERS, bodies[0], strict=True)}
    grids = {
        "pinion": DeviationGrid((-0.02, 0.02), (0.0, 0.05), ((1e-6, 1e-6), (1e-6, 1e-6))),
        "face_gear": DeviationGrid((0.1, 0.3), (0.0, 0.02), ((2e-6, 2e-6), (2e-6, 2e-6))),
    }
    curves = loaded_curves(design, sides, found.loads, 500.0, {body: 3 * (grids[body],) for body in grids})
    # teeth are no longer rigid where fillets take a part of the torque, with other lever arms
    assert curves["pinion"] == pytest.approx(np.full(9, 1e-6), rel=1e-3)
    assert curves["face_gear"] == pytest.approx(np.full(9, 2e-6), rel=1e-3)
    margins = pattern_margins(found.pressure[0], design, 500.0)
    limits = radius_limits(design)
    assert margins.undercut >= design.face_gear.inner_radius - limits.inner - 1e-12
    assert 0.0 <= margins.pinion_tip < design.module


def test_stored_flanks_of_all_pairs_come_back(bodies_of):
    flanks = [pinion for pinion, _ in bodies_of("P1")]
    for before, after in zip(flanks, every_flank_from_arrays(every_flank_to_arrays(flanks)), strict=True):
        np.testing.assert_array_equal(after.side.u, before.side.u)
        np.testing.assert_array_equal(after.compliance.loaded_tooth, before.compliance.loaded_tooth)


@pytest.mark.parametrize(("name", "count"), [("P1", 2), ("P2", 1), ("P3", 4), ("P4", 4)])
def test_teeth_need_a_pair_of_bodies_for_each_flank_that_is_no_mirror_image(name, count):
    design = public_pair(name)
    assert len(nominal_pairs(design)) == count
    assert len(nominal_pairs(pair_design())) == 1
    assert nominal_pairs(mirror_design(design), UPPER)[0] == nominal_pairs(design, UPPER)[-1]


def test_a_helical_pinion_s_coast_flank_takes_the_compliance_of_its_drive_flank(monkeypatch):
    """Without taper one is the other in a mirror across the face; it was condensed a second time."""
    design, plan = public_pair("P1"), replace(PLAN, root_stress=True)
    expected = [gear_flank(pair, "pinion", SIZES, STEEL, plan) for pair in nominal_pairs(design, UPPER)]
    count = []
    condense = compliance.condense
    monkeypatch.setattr(compliance, "condense", lambda *of: count.append(0) or condense(*of))
    found = gear_flanks(design, "pinion", SIZES, STEEL, plan, UPPER)
    assert len(count) == 1
    for flank, alone in zip(found, expected, strict=True):
        for field in ("loaded_tooth", "neighbour_blocks", "readings"):
            values, wanted = (getattr(of.compliance, field) for of in (flank, alone))
            np.testing.assert_allclose(values, wanted, rtol=0, atol=1e-11 * np.abs(wanted).max())
        np.testing.assert_allclose(flank.gauges.error, alone.gauges.error, rtol=1e-9)


SMALL = {
    "helix": {"helix_angle": 1.0},
    "taper": {"taper_angle": 1.0},
    "shaft angle": {"shaft_angle": 1.0},
    "offset": {"offset": 0.1},
    "coast flank": {"coast_pressure_angle": 1.0},
}
"""Changes that make each kind of teeth of a spur pair, per rad of smallness; of the offset in m per rad."""


@pytest.mark.parametrize("kind", SMALL)
def test_contact_of_every_kind_goes_to_the_spur_pair_s_in_proportion(kind):
    spur = pair_design()
    start = {"shaft_angle": pi / 2, "coast_pressure_angle": spur.pressure_angle}

    def answers(small):
        changes = {name: start.get(name, 0.0) + small * size for name, size in SMALL[kind].items()}
        design = replace(spur, **changes)
        model = contact_model(design, *(gear_flank(design, body, SIZES, STEEL, PLAN) for body in BUILDERS))
        results = loaded_contact(model, [0.1, 0.6], [500.0])
        return np.array([[result.ste, 1.0 / result.k_local, *result.load_share] for result in results])

    nominal = answers(0.0)
    scale = np.abs(nominal).max(axis=0) + (nominal.max(axis=0) == 0.0)
    slopes = [(answers(small) - nominal) / scale / small for small in (1e-4, 1e-6, 1e-8)]
    size = np.abs(slopes[1]).max()
    assert size < 300.0
    np.testing.assert_allclose(slopes[0], slopes[1], atol=0.05 * size)
    np.testing.assert_allclose(slopes[2], slopes[1], atol=0.05 * size + 1e-3)
