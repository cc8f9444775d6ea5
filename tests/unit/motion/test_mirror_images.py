"""Which mirror image a sweep takes where symmetry breaks does not depend on rounding."""

from dataclasses import replace

import numpy as np
import pytest
from oscillators import backlash_oscillator
from symmetric_machine import build_symmetric_model, load_gearbox, make_plan

from facegear.motion.plan import Settings, State
from facegear.motion.steady_state.mirror_images import symmetries_of_start, symmetry_broken
from facegear.motion.steady_state.simulate import simulate, static_start, steady_state
from facegear.motion.symmetries import mesh_images, symmetries

BROKEN_RPM = 9560.0
"""A speed at which only motions without left-right symmetry are stable near the symmetric one."""


@pytest.fixture(scope="module")
def symmetric_start():
    settings = make_plan("up", (9500.0, 9500.0, 1)).settings
    return simulate(build_symmetric_model(), 9500.0, settings).state


def kick_to_one_side(start, size):
    """Move a start by some length scales in a direction that the exchange of left and right reverses."""
    system = build_symmetric_model().system
    (symmetry,) = symmetries(system)
    way = np.cos(1.0 + np.arange(system.size))
    way -= symmetry.matrix @ way
    weights = np.abs(system.mesh_jacobian).max(axis=0) / system.scale
    return replace(start, displacement=start.displacement + size * way / np.abs(weights * way).max())


@pytest.mark.parametrize("size", [0.0, 1e-12, -1e-12, 1e-7, -1e-7])
def test_a_disturbance_does_not_choose_between_two_mirror_images(symmetric_start, size):
    settings = make_plan("up", (9500.0, 9500.0, 1)).settings
    start = kick_to_one_side(symmetric_start, size)
    response = simulate(build_symmetric_model(), BROKEN_RPM, settings, start)
    names = build_symmetric_model().machine.layout.mesh_names
    ac_rms = dict(zip(names, response.moments.ac_rms, strict=True))
    assert symmetry_broken(response)
    assert ac_rms["right idler/lower"] > 2.0 * ac_rms["left idler/lower"]


def test_a_run_that_starts_on_one_image_stays_on_it(symmetric_start):
    model, settings = build_symmetric_model(), make_plan("up", (9500.0, 9500.0, 1)).settings
    chosen = simulate(model, BROKEN_RPM, settings, symmetric_start)
    (symmetry,) = symmetries(model.system)
    image = State(symmetry.matrix @ chosen.state.displacement, symmetry.matrix @ chosen.state.velocity)
    other = simulate(model, BROKEN_RPM, settings, image)
    found, expected = other.moments.ac_rms, chosen.moments.ac_rms[mesh_images(model.system)[1]]
    np.testing.assert_allclose(found, expected, rtol=1e-6)


@pytest.mark.parametrize("chunks", [2, 5])
def test_rows_where_symmetry_is_broken_do_not_depend_on_the_chunks(chunks):
    gearbox = load_gearbox()
    options = {"points": 11, "directions": ["up"]}
    split = {"dynamics.sweep.chunks": chunks, "dynamics.sweep.overlap_points": 1}
    whole = gearbox.sweep(9200, 9700, **options).content["sweep"]
    again = gearbox.with_values(split).sweep(9200, 9700, **options, threads=2).content["sweep"]
    broken = whole.groupby("speed_rpm")["symmetry_broken"].all()
    assert broken.tolist() == [False] * 7 + [True] * 4
    rows = [table[table["quantity"] == "deflection_ac_rms_um"]["value"] for table in (whole, again)]
    np.testing.assert_allclose(rows[1], rows[0], rtol=1e-5)


def test_of_a_motion_without_mean_load_the_half_period_image_is_another_motion():
    """Symmetry of the motion with impacts on both sides breaks at 0.3485 (the page on branches, case d)."""
    settings = Settings(tolerance=1e-8, settle=2000)
    broken = []
    for speed in (0.40, 0.34):
        system = backlash_oscillator(speed, mean=0.0, amplitude=2.0)
        start = State(np.array([1.674]), np.array([0.365 * speed]))
        response = steady_state(system, speed, settings, start)
        assert response.period == 1
        broken.append(symmetry_broken(response))
    assert broken == [False, True]


def test_static_equilibrium_has_all_symmetries_of_its_machine():
    model = build_symmetric_model()
    start = static_start(model)
    assert symmetries_of_start(model.system, start) == symmetries(model.system)
    assert symmetries_of_start(model.system, kick_to_one_side(start, 0.01)) == ()
