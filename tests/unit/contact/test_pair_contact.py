"""Loaded contact of the pinion and the face gear: balance, symmetries, and cases that are hard to solve."""

from dataclasses import replace
from math import radians

import numpy as np
import pytest
from contact_bodies import COARSE, STEEL, pair_design, sound
from references import against, agrees

from facegear.build.plans import stiffness_request
from facegear.contact.analysis import ltca_table
from facegear.contact.bodies.compliance import flank_compliance
from facegear.contact.flanks import FlankPair
from facegear.contact.gear_flank import BUILDERS, NEIGHBOURS, contact_model, gear_flank
from facegear.contact.ltca import loaded_contact
from facegear.contact.options import ContactOptions, ContactPlan, Sector
from facegear.contact.pressure import PINION_TIP, flank_pressure
from facegear.contact.teeth import LOADED_SIDE, elastic_tooth
from facegear.meshing.stiffness_curve import unloaded_series
from facegear.meshing.stiffness_source import stiffness_from_contact, unloaded_error
from facegear.schema.base import parse
from facegear.schema.stiffness import MeshStiffness
from facegear.teeth.clearance import smallest_gaps
from facegear.teeth.design import AssemblyErrors
from facegear.teeth.flank_shapes import Relief
from facegear.teeth.unloaded_contact import unloaded_contact

TORQUES = [100.0, 600.0]


def misaligned(model, **errors):
    """Return the same elastic bodies in another assembly."""
    return model.with_assembly(AssemblyErrors(**errors))


def redesigned(model, design):
    """Return the same elastic bodies with other flanks, a few micrometres away."""
    pinion, gear = (replace(flank, design=design) for flank in (model.flanks.pinion, model.flanks.gear))
    return replace(model, flanks=FlankPair(pinion, gear))


def test_forces_balance_the_torque_and_two_or_three_pairs_carry(model_of):
    results = sound(loaded_contact(model_of(), np.arange(8) / 8, TORQUES))
    assert {result.pairs_in_contact for result in results if result.torque == 600.0} <= {2, 3}


def test_stiffness_grows_with_load_and_the_local_one_is_larger(model_of):
    light, heavy = loaded_contact(model_of(), [0.3], TORQUES)
    assert heavy.k_average > light.k_average
    for result in (light, heavy):
        assert result.k_local > result.k_average


def test_unloaded_transmission_error_is_the_geometry_s(model_of):
    model = misaligned(model_of(), offset=50e-6, shaft_angle_error=radians(0.02))
    result = loaded_contact(model, [0.3], [600.0])[0]
    assert result.ste - result.unloaded_error > 0
    assert result.k_average == pytest.approx(
        600.0 / model.design.pinion_base_radius / (result.ste - result.unloaded_error), rel=1e-12
    )


def test_result_does_not_depend_on_the_order_of_loads_or_positions(model_of):
    together = loaded_contact(model_of(), [0.1, 0.6], [100.0, 300.0, 600.0])
    alone = loaded_contact(model_of(), [0.6], [300.0])[0]
    backwards = loaded_contact(model_of(), [0.6, 0.1], [600.0, 300.0, 100.0])
    expected = together[4]
    assert (expected.position, expected.torque) == (0.6, 300.0)
    for other in (alone, backwards[1]):
        assert other.ste == pytest.approx(expected.ste, rel=1e-8)
        np.testing.assert_allclose(other.load_share, expected.load_share, atol=1e-8)


@against(
    "analytic",
    "periodicity of a pitch",
    capability="contact",
    module="facegear.contact.ltca",
)
def test_result_repeats_after_a_pitch_with_the_next_tooth(model_of):
    first, second = loaded_contact(model_of(), [0.0, 1.0], [600.0])
    agrees("transmission error a pitch later, m", second.ste, first.ste, relative=1e-8)
    agrees(
        "share of a pair a pitch later",
        second.load_share[:-1],
        first.load_share[1:],
        relative=1e-7,
        absolute=1e-8,
    )


@pytest.fixture(scope="module")
def back_sides(model_of):
    """Compliances of the flanks of the coarse model's gears that it does not load."""
    design, (sizes, cuts) = model_of(coarse=True).design, COARSE
    found = []
    for body, build in BUILDERS.items():
        tooth, other = build(design, sizes), "left" if LOADED_SIDE[body] == "right" else "right"
        elastic, _ = elastic_tooth(design, tooth, STEEL, other)
        found.append(flank_compliance(elastic, cuts, tooth.teeth, NEIGHBOURS))
    return found


@against(
    "analytic",
    "mirror symmetry",
    capability="compliance",
    module="facegear.contact.bodies.compliance",
)
@pytest.mark.parametrize("body", [0, 1], ids=list(BUILDERS))
def test_opposite_flank_is_as_compliant_by_mirror_symmetry(model_of, back_sides, body):
    model = model_of(coarse=True)
    loaded, other = (model.pinion, model.gear)[body], back_sides[body]
    scale = loaded.loaded_tooth.max()
    agrees(
        "influence matrix, m/N", other.loaded_tooth, loaded.loaded_tooth, relative=1e-7, absolute=1e-8 * scale
    )
    for apart in (1, 2):
        agrees(
            "influence of another tooth, m/N",
            other.block(apart),
            loaded.block(-apart),
            relative=1e-7,
            absolute=1e-8 * scale,
        )


@against(
    "analytic",
    "mirror symmetry",
    capability="contact",
    module="facegear.contact.ltca",
)
def test_contact_of_the_opposite_flanks_is_the_mirror_image_s(model_of, back_sides):
    # seen in the mirror, the tooth to the right is the one to the left
    back = [replace(body, neighbour_blocks=body.neighbour_blocks[::-1]) for body in back_sides]
    for errors in ({}, {"offset": 0.1e-3, "shaft_angle_error": radians(0.05)}):
        here = misaligned(model_of(coarse=True), **errors)
        there = replace(here, pinion=back[0], gear=back[1])
        for one, other in zip(*(loaded_contact(m, [0.1, 0.7], TORQUES) for m in (here, there)), strict=True):
            agrees("transmission error, m", other.ste, one.ste, relative=1e-8)
            agrees("local stiffness, N/m", other.k_local, one.k_local, relative=1e-8)
            agrees("share of a pair", other.load_share, one.load_share, relative=1e-7, absolute=1e-8)
            for here_spot, there_spot in zip(one.spots, other.spots, strict=True):
                assert there_spot.force.max() == pytest.approx(here_spot.force.max(), rel=1e-6)


def test_contact_on_the_path_only_is_softer_near_hand_over(model_of):
    positions = np.arange(8) / 8
    full, path = (
        loaded_contact(model_of(), positions, [600.0], ContactOptions(path_only=only))
        for only in (False, True)
    )
    for everywhere, on_path in zip(full, path, strict=True):
        assert on_path.k_average <= everywhere.k_average * (1 + 1e-9)
        assert 1 <= on_path.pairs_in_contact <= everywhere.pairs_in_contact
    loss = 1 - np.mean([r.k_average for r in path]) / np.mean([r.k_average for r in full])
    assert 0.05 < loss < 0.2


def test_leaving_out_the_coupling_of_neighbours_makes_the_mesh_stiffer(model_of):
    coupled = loaded_contact(model_of(), [0.3], [600.0])[0]
    alone = loaded_contact(model_of(), [0.3], [600.0], ContactOptions(is_coupled=False))[0]
    assert 1.01 < alone.k_average / coupled.k_average < 1.15


@pytest.mark.parametrize("torque", [1.0, 5000.0])
def test_very_small_and_very_large_torques_converge(model_of, torque):
    results = sound(loaded_contact(model_of(), np.arange(4) / 4, [torque]))
    assert all(result.ste > 0 for result in results)


def test_line_contact_pair_spreads_its_load_over_the_face(model_of):
    line, crowned = (model_of(coarse=True, shaper_teeth=teeth) for teeth in (23, 26))
    reach = {}
    for name, model in (("line", line), ("crowned", crowned)):
        result = sound(loaded_contact(model, [0.5], [100.0]))[0]
        columns = np.concatenate([spot.hats % model.flanks.pinion.shape[1] for spot in result.spots])
        reach[name] = np.unique(columns).size
    assert reach["line"] > 1.3 * reach["crowned"]


@pytest.mark.parametrize(
    "errors",
    [
        {"shaft_angle_error": radians(0.2)},
        {"shaft_angle_error": radians(-0.2)},
        {"offset": 0.3e-3},
        {"offset": -0.3e-3},
        {"gear_axial": 0.3e-3},
    ],
)
def test_misaligned_pair_touches_at_an_edge_and_converges(model_of, errors):
    sound(loaded_contact(misaligned(model_of(), **errors), np.arange(4) / 4, TORQUES))


def test_gear_pressed_into_the_pinion_still_drives_while_its_back_sides_overlap(model_of):
    """The drive side alone is solved; the overlap is the geometry check's to refuse."""
    model = misaligned(model_of(), gear_axial=-0.3e-3)
    for result in sound(loaded_contact(model, np.arange(4) / 4, TORQUES)):
        along = model.design.assembly.gear_axial * np.sin(model.design.pressure_angle)
        assert result.unloaded_error == pytest.approx(along, rel=0.15)
    touching = unloaded_contact(model.design, [0.0])
    gaps = smallest_gaps(model.design, touching.phi1, touching.phi2)
    assert gaps["flank", "flank"].side == "back"
    assert gaps["flank", "flank"].gap < -0.15e-3


@pytest.mark.parametrize(("width", "radii"), [(0.005, (0.262, 0.267)), (0.046, (0.250, 0.290))])
def test_narrow_and_wide_faces_converge(model_of, width, radii):
    model = model_of(coarse=True, pinion_width=width, radii=radii)
    results = sound(loaded_contact(model, np.arange(4) / 4, TORQUES))
    assert all(result.k_average < 2e9 for result in results)


def test_tip_relief_takes_load_off_the_pair_that_comes_into_contact(model_of):
    sharp = model_of()
    relieved_pinion = replace(sharp.design.pinion, tip_relief=Relief(20e-6, 0.0, 2e-3))
    eased = redesigned(sharp, replace(sharp.design, pinion=relieved_pinion))
    plain, relieved = (sound(loaded_contact(m, np.arange(8) / 8, [600.0])) for m in (sharp, eased))
    assert min(r.k_average for r in relieved) < min(r.k_average for r in plain)
    at_tips = [
        sum(
            (loads.line_load * loads.length)[loads.edge == PINION_TIP].sum()
            for loads in flank_pressure(found, model.flanks, (STEEL, STEEL)).loads
        )
        for model, found in ((sharp, plain), (eased, relieved))
    ]
    assert at_tips[1] < 0.5 * at_tips[0]


def test_stiffness_is_continuous_through_a_hand_over(model_of):
    positions = np.linspace(0, 1, 17)
    shares = [result.load_share for result in loaded_contact(model_of(), positions, [300.0])]
    change = [i for i in range(16) if np.count_nonzero(shares[i]) != np.count_nonzero(shares[i + 1])]
    low, high = positions[change[0]], positions[change[0] + 1]
    count = np.count_nonzero(shares[change[0]])
    while high - low > 1e-6:
        middle = 0.5 * (low + high)
        here = np.count_nonzero(loaded_contact(model_of(), [middle], [300.0])[0].load_share)
        low, high = (middle, high) if here == count else (low, middle)
    before, after = sound(loaded_contact(model_of(), [low, high], [300.0]))
    assert after.pairs_in_contact != before.pairs_in_contact
    assert after.ste == pytest.approx(before.ste, rel=1e-4)


def test_linear_elements_on_the_same_nodes_are_too_stiff():
    """Trilinear hexahedra by about a percent, tetrahedra by several."""
    design, (sizes, cuts), models = pair_design(), COARSE, {}
    for element in ("hex27", "hex8", "tet4"):
        plan = ContactPlan((600.0,), 4, cuts, Sector(3, 3), ContactOptions(), element)
        bodies = [gear_flank(design, body, sizes, STEEL, plan) for body in BUILDERS]
        models[element] = contact_model(design, *bodies)
    stiffness = {
        element: np.mean([result.k_average for result in loaded_contact(model, [0.1, 0.6], [600.0])])
        for element, model in models.items()
    }
    assert 1.003 < stiffness["hex8"] / stiffness["hex27"] < 1.03
    assert 1.03 < stiffness["tet4"] / stiffness["hex27"] < 1.15


@against(
    "second implementation",
    "geometry's own unloaded contact",
    capability="contact",
    module="facegear.contact.ltca",
)
def test_a_long_tip_relief_shows_in_the_unloaded_error_that_the_dynamics_takes_from_contact(model_of):
    plain = model_of()
    relieved = replace(plain.design.pinion, tip_relief=Relief(20e-6, 0.0, 9e-3))
    model = redesigned(plain, replace(plain.design, pinion=relieved))
    positions = np.arange(8) / 8
    found = sound(loaded_contact(model, positions, [600.0]))
    table = ltca_table(found, flank_pressure(found, model.flanks, (STEEL, STEEL)))
    section = parse(MeshStiffness, {"source": "fem", "torque_n_m": 600.0})
    series = unloaded_error(stiffness_from_contact(table, stiffness_request(section)).harmonics)
    pitch = 2 * np.pi / model.design.pinion.teeth
    exact = -unloaded_contact(model.design, (positions - 0.5) * pitch).transmission_error
    assert np.ptp(exact) > 1e-6
    # Eight positions carry three orders; what they miss stands in the table.
    agrees(
        "unloaded transmission error, m",
        series(positions),
        exact - exact.mean(),
        relative=1e-7,
        absolute=0.2 * np.ptp(exact),
    )


def test_conjugate_flanks_give_no_error_from_contact_however_they_are_assembled(model_of):
    model = misaligned(model_of(), offset=50e-6, shaft_angle_error=radians(0.02))
    found = loaded_contact(model, np.arange(4) / 4, [600.0])
    table = ltca_table(found, flank_pressure(found, model.flanks, (STEEL, STEEL)))
    assert table["unloaded_ste_um"].abs().min() > 1.0
    series, missed = unloaded_series(table, 1)
    assert not series.amplitudes.any() and missed == 0.0
