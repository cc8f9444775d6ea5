"""Single teeth that deviate from the others: in the transmission error without load and under it."""

from dataclasses import replace

import numpy as np
import pytest
from contact_bodies import pair_design
from lumped_machines import make_layout
from measured_flanks import MM, UM, constant, sampled, with_grid
from references import against, agrees

from facegear.contact.ltca import loaded_contact
from facegear.contact.nodal_loads import load_arrays
from facegear.contact.tooth_errors import loaded_curves, located_range, orders, pair_gaps, unloaded_errors
from facegear.machine.imperfections import ToothErrors

BODIES = ("pinion", "face_gear")


@pytest.fixture(scope="module")
def gaps():
    return pair_gaps(pair_design(), np.arange(32) / 32)


def teeth(pinion=0.0, gear=0.0):
    """One tooth of each gear thicker by so much (m), as all others are."""
    design = pair_design()
    added = {"pinion": (pinion, 23), "face_gear": (gear, 143)}
    return {
        body: [
            sampled(design, body, constant(amount if m == 0 else 0.0), (2, 2)) for m in range(min(count, 2))
        ]
        + [None] * (count - 2)
        for body, (amount, count) in added.items()
    }


@against(
    "analytic",
    "envelope of the pairs' closed forms, 128 positions a pitch",
    capability="tooth_errors",
    module="facegear.contact.tooth_errors",
)
def test_a_thick_pinion_tooth_shows_at_the_orders_that_counting_teeth_gives(gaps):
    error = 1e6 * unloaded_errors(gaps, teeth(pinion=6 * UM), 23)
    agrees("mean, um", error.mean(), 0.47665, absolute=1e-3)
    agrees("peak to peak, um", np.ptp(error), 6.0, absolute=1e-6)
    agrees("orders of a pinion turn, um", orders(error, 23, 3), [0.94334, 0.91384, 0.86592], absolute=2e-3)


@against(
    "analytic",
    "envelope of the pairs' closed forms, 128 positions a pitch",
    capability="tooth_errors",
    module="facegear.contact.tooth_errors",
)
def test_thick_teeth_of_both_gears_show_at_their_own_orders_over_the_hunting_cycle(gaps):
    error = 1e6 * unloaded_errors(gaps, teeth(6 * UM, 4 * UM), 23 * 143)
    agrees("mean, um", error.mean(), 0.52462, absolute=1e-3)
    agrees("peak to peak, um", np.ptp(error), 10.0, absolute=1e-6)
    agrees("orders of a pinion turn, um", orders(error, 23, 2), [0.9399, 0.9105], absolute=2e-3)
    agrees("orders of a gear turn, um", orders(error, 143, 2), [0.0959, 0.0958], absolute=2e-4)
    spectrum = 2 * np.abs(np.fft.rfft(error.ravel())) / error.size
    counted = np.arange(spectrum.size)
    elsewhere = spectrum[(counted % 143 != 0) & (counted % 23 != 0)]
    assert elsewhere.max() < 0.005


@against(
    "second implementation",
    "the loaded contact of flanks that deviate",
    capability="tooth_errors",
    module="facegear.contact.tooth_errors",
)
@pytest.mark.parametrize("body", BODIES)
def test_under_load_teeth_add_what_their_part_of_the_force_says(model_of, body):
    """All teeth deviate alike here, by slopes of 1 um, so that contact can be solved anew. What remains is of
    second order, and forces' differences over torques 7 % apart.
    """
    model, positions = model_of(coarse=True), [0.1, 0.6]
    design = model.design
    middle = (
        np.mean([design.face_gear.inner_radius, design.face_gear.outer_radius]) if body != "pinion" else 0.0
    )
    grid = sampled(design, body, lambda face, depth: UM * ((face - middle) / (12.5 * MM) - depth / (9 * MM)))
    results = loaded_contact(model, positions, [560.0, 600.0, 640.0])
    deviating = loaded_contact(model.of(with_grid(design, body, grid)), positions, [600.0])
    sides = {"pinion": model.flanks.pinion.side, "face_gear": model.flanks.gear.side}
    counts = {"pinion": 23, "face_gear": 143}
    all_teeth = {name: [grid if name == body else None] * count for name, count in counts.items()}
    curves = loaded_curves(design, sides, load_arrays([results], np.zeros((2, 2), int)), 600.0, all_teeth)
    added = [before.ste - after.ste for before, after in zip(results[1::3], deviating, strict=True)]
    agrees("added transmission error, m", curves[body][:2], added, absolute=0.08 * UM)
    assert np.abs(added).min() > 0.1 * UM


@against(
    "analytic",
    "top of a narrow bump on one tooth",
    capability="tooth_errors",
    module="facegear.contact.tooth_errors",
)
def test_peak_to_peak_does_not_depend_on_the_positions_that_are_looked_at():
    design = pair_design()

    def bump(face, depth):
        return 6 * UM * np.exp(-(((depth - np.quantile(depth, 0.55)) / (0.08 * MM)) ** 2)) + 0.0 * face

    one = [sampled(design, "pinion", bump, (3, 401)), *[None] * 22]
    bumpy = {"pinion": one, "face_gear": [None] * 143}
    errors = unloaded_errors(pair_gaps(design, np.arange(16) / 16), bumpy, 23)
    peak_to_peak, left = located_range(design, bumpy, errors)
    assert np.ptp(errors) < 5.8 * UM
    agrees("peak to peak, m", peak_to_peak, 6 * UM, absolute=0.01 * UM)
    assert left < 0.05 * UM


def test_a_tooth_is_felt_by_both_its_flanks_while_it_is_in_mesh():
    layout, positions = make_layout(), 8
    curve = np.zeros((layout.pinion_teeth, positions))
    curve[0, positions // 2 :], curve[1, : positions // 2] = 1.0, 1.0  # from 0.5 to 1.5, about the place 1
    gear = np.zeros((layout.gear_teeth, positions))
    errors = ToothErrors((curve.ravel(), curve.ravel()), (gear.ravel(), gear.ravel()))
    assert errors.turning == (True, False)
    places = np.linspace(0.0, layout.pinion_teeth, 400, endpoint=False)
    drive, back = errors.early(layout, places, 0.0 * places)
    assert places[drive > 0.9].mean() == pytest.approx(1.0, abs=0.1)
    assert places[back > 0.9].mean() == pytest.approx(1.0, abs=0.1)


def test_without_teeth_that_differ_the_transmission_error_is_the_mean_flanks_own(gaps):
    error = unloaded_errors(gaps, teeth(), 3)
    np.testing.assert_allclose(error, np.broadcast_to(gaps.mean, error.shape), atol=1e-9)
    assert replace(gaps, mean=gaps.mean + UM).mean[0] == pytest.approx(gaps.mean[0] + UM)
