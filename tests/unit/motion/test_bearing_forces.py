"""Forces on bearings over a response: they balance torques and meshes; at rest they are the statics'."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from lumped_machines import make_layout, make_machine
from references import against, agrees
from scipy.interpolate import CubicSpline

import facegear
from facegear.harmonics import Harmonics, stacked_values
from facegear.machine.imperfections import perfect
from facegear.machine.kinematics import GEOMETRIC, KINEMATICS, PRINTED_KINEMATICS
from facegear.machine.layout import Role
from facegear.machine.linear_model import bearing_matrix, flank_jacobian, mass_diagonal
from facegear.machine.machine import OpenFlanks
from facegear.machine.statics import static_equilibrium
from facegear.motion.bearing_forces import bearing_forces, bearing_history, bearing_table
from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.plan import Motion, Settings
from facegear.motion.steady_state.simulate import build_model, simulate
from facegear.motion.track import SampledTrack, periodic_track, track
from facegear.report.case import case_report
from facegear.report.chapter_tables import bearing_reactions

COSINE = np.cos(np.radians(25.0))


FLAT = Harmonics(np.zeros(1), np.array([4.1e8]))


def loaded(kinematics=GEOMETRIC, clearance=0.0, samples=64, **options):
    """A machine of the paper's layout under load, and its response at 2500 rpm."""
    layout = make_layout(kinematics=kinematics)
    flaws = replace(perfect(layout), bearing_clearance=np.full(5, clearance))
    model = build_model(make_machine(layout, 1500.0, imperfections=flaws, **options))
    return model, simulate(model, 2500.0, Settings(tolerance=1e-10, samples=samples))


def flank_means(response):
    """Mean force of every flank (2 meshes,), N, of a motion that never wedges."""
    mean, magnitude = response.mean_forces
    return 0.5 * np.concatenate([magnitude + mean, magnitude - mean])


def test_at_mean_an_input_leaves_its_bearing_alone_and_an_idler_pulls_it_with_twice_the_tangential_force():
    roles = ((0.0, Role.INPUT), (35.5, Role.IDLER), (71.5, Role.INPUT), (107.0, Role.IDLER))
    places = tuple((f"{role.value} {at}", role, at) for at, role in roles)
    layout = make_layout(places, pinion_bearing=1e4, gear_bearing=1e11, kinematics=GEOMETRIC)
    pinions = list(layout.pinions)
    for at in (1, 3):
        pinions[at] = replace(pinions[at], body=replace(pinions[at].body, bearing=(1e10, 1e10, 0.0)))
    layout = replace(layout, pinions=tuple(pinions))
    model = build_model(make_machine(layout, 1500.0, tail_share=0.0, backlash=0.0, error=5e-6))
    found = simulate(model, 2500.0, Settings(tolerance=1e-10))
    assert found.motion is Motion.PERIODIC
    table = bearing_table(model, found).set_index(["body", "direction"])
    upper = found.mean_forces[0, 4:]
    for pinion, force in zip(layout.pinions, upper, strict=True):
        row = table.loc[pinion.name]
        if pinion.role is Role.INPUT:
            assert np.abs(row.loc[["x", "y", "z"], ["static_n", "mean_n"]]).to_numpy().max() < 1e-3 * force
        else:
            assert -row.loc["x", "mean_n"] == pytest.approx(2.0 * force * COSINE, rel=1e-4)
            assert abs(row.loc["y", "mean_n"]) < 1e-4 * force


@against(
    "analytic",
    "balance of mean forces",
    capability="dynamics_response",
    module="facegear.motion.bearing_forces",
)
@settings(max_examples=12, deadline=None)
@given(
    st.sampled_from(list(KINEMATICS.values())),
    st.floats(0.0, 4e-5),
    st.floats(3e7, 1e9),
    st.floats(500.0, 6000.0),
    st.floats(0.0, 0.3),
)
def test_mean_forces_on_bearings_balance_torques_and_meshes(kinematics, error, bearing, speed, tail):
    layout = make_layout(pinion_bearing=bearing, kinematics=kinematics)
    options = {"tail_share": tail, "error": error, "open_flanks": OpenFlanks.ALWAYS}
    model = build_model(make_machine(layout, 1500.0, **options))
    found = simulate(model, speed, Settings(tolerance=1e-10, samples=256))
    assume(found.motion is Motion.PERIODIC and found.fractions.sum(axis=0).max() <= 1.0)
    pulls = flank_means(found) @ flank_jacobian(layout)
    mean = bearing_history(model, found).mean(axis=0)
    agrees(
        "mean bearing force, N",
        mean,
        -pulls.reshape(-1, 4)[:, :3],
        relative=1e-7,
        absolute=1e-4 * np.abs(pulls).max(),
    )


@against(
    "analytic",
    "balance of mean forces",
    capability="dynamics_response",
    module="facegear.motion.bearing_forces",
)
@pytest.mark.parametrize("kinematics", KINEMATICS.values(), ids=KINEMATICS)
def test_external_forces_stand_in_the_bearings_of_the_running_machine(kinematics):
    """Across the mesh force as well, where no mesh feels the body's motion."""
    layout = make_layout(kinematics=kinematics)
    forces = np.zeros((7, 3))
    forces[1], forces[3], forces[5] = (400.0, -900.0, 0.0), (0.0, 700.0, 0.0), (300.0, 0.0, -5000.0)
    machine = make_machine(layout, 1500.0, error=4e-6)
    model = build_model(replace(machine, forces=forces))
    found = simulate(model, 3000.0, Settings(tolerance=1e-10, samples=256))
    assert found.motion is Motion.PERIODIC
    pulls = (flank_means(found) @ flank_jacobian(layout)).reshape(-1, 4)[:, :3]
    mean = bearing_history(model, found).mean(axis=0)
    agrees("mean bearing force, N", mean, forces - pulls, relative=1e-7, absolute=1e-4 * np.abs(pulls).max())


@against(
    "analytic",
    "balance of power",
    capability="dynamics_response",
    module="facegear.motion.bearing_forces",
)
@pytest.mark.parametrize(("kinematics", "backlash"), [(GEOMETRIC, 20e-6), (PRINTED_KINEMATICS, 0.0)])
def test_bearings_masses_and_meshes_take_no_more_power_than_is_brought_in(kinematics, backlash):
    steady = {"stiffness": FLAT, "error": 8e-6, "backlash": backlash, "open_flanks": OpenFlanks.CONTACT_ONLY}
    model, found = loaded(kinematics, samples=1024, **steady)
    machine, system, rate = model.machine, model.system, rates(found)
    assert found.motion is Motion.PERIODIC and found.periods == 1
    error = stacked_values(system.error, found.phases)[:, system.error_kind]
    closed = found.coordinates @ system.mesh_jacobian.T - error - system.upper
    touches = (closed > 0.0).all(axis=0) | (kinematics is PRINTED_KINEMATICS)
    assert ((closed < 0.0).all(axis=0) | touches).all()
    time = np.append(found.phases, 1.0) * TAU / found.frequency
    error_rate = CubicSpline(time, np.vstack([error, error[:1]]), bc_type="periodic")(time[:-1], 1)
    flank_rate = rate @ system.mesh_jacobian.T
    force = (4.1e8 * closed + machine.damping.mesh * (flank_rate - error_rate)) * touches
    by_meshes = (force * flank_rate).sum(axis=1).mean()
    moving = rate @ model.reduction.basis.T
    by_masses = machine.damping.mass * (moving**2 @ mass_diagonal(machine.layout)).mean()
    at_bodies = moving.reshape(len(moving), -1, 4)[..., :3] * bearing_history(model, found)
    by_bearings = at_bodies.sum(axis=(1, 2)).mean()
    # The torques' work over a period is none, as the rigid rotation is left out.
    assert by_bearings > 1e-3 * abs(by_meshes)
    agrees(
        "power of meshes, masses and bearings, W",
        by_meshes + by_masses + by_bearings,
        0.0,
        absolute=1e-5 * abs(by_meshes),
    )


@against(
    "analytic",
    "static equilibrium",
    capability="dynamics_response",
    module="facegear.motion.bearing_forces",
)
@pytest.mark.parametrize("kinematics", list(KINEMATICS.values()))
def test_without_excitation_the_response_has_the_static_forces(kinematics):
    model, found = loaded(kinematics, error=0.0, stiffness=FLAT)
    table = bearing_table(model, found)
    largest = table["static_n"].abs().max()
    for column in ("mean_n", "rms_n"):
        agrees(
            "bearing force, N",
            table[column].abs(),
            table["static_n"].abs(),
            relative=1e-7,
            absolute=1e-6 * largest,
        )
    standing = static_equilibrium(model.machine).displacements
    exact = (bearing_matrix(model.machine.layout) @ standing).reshape(-1, 4)[:, :3]
    agrees(
        "bearing force at an instant, N",
        bearing_history(model, found)[0],
        exact,
        relative=1e-7,
        absolute=1e-6 * largest,
    )


def test_a_bearing_with_clearance_carries_its_static_force_where_nothing_excites():
    model, found = loaded(clearance=20e-6, error=0.0, stiffness=FLAT)
    table = bearing_table(model, found)
    np.testing.assert_allclose(table["mean_n"], table["static_n"], atol=1e-6 * table["static_n"].abs().max())


@against(
    "own convergence",
    "512 samples a cycle",
    capability="dynamics_response",
    module="facegear.motion.bearing_forces",
)
def test_forces_on_bearings_converge_with_the_samples():
    model, _ = loaded(error=20e-6)
    coarse, fine = (
        bearing_table(model, simulate(model, 2500.0, Settings(tolerance=1e-11, samples=samples)))
        for samples in (64, 512)
    )
    largest = fine["peak_n"].max()
    for column, tolerance in (("mean_n", 1e-6), ("rms_n", 1e-6), ("peak_n", 5e-3)):
        agrees("bearing force, N", coarse[column], fine[column], relative=1e-7, absolute=tolerance * largest)


def test_the_report_shows_the_forces_on_the_bearings_at_the_nominal_speed():
    model, found = loaded()
    values = facegear.example().values
    page = case_report(values, {"bearings": bearing_table(model, found)}, {}, [])
    assert "Reactions of the bearing of every body" in page


def test_each_bearing_has_one_row_of_reactions():
    table = bearing_table(*loaded())
    rows = bearing_reactions(table)
    assert list(rows["bearing"]) == list(dict.fromkeys(table["body"])) and len(rows) == 7
    known = table.set_index(["body", "direction"])
    for row in rows.itertuples():
        assert row.static_radial_n == known.loc[(row.bearing, "radial"), "static_n"]
        assert row.peak_z_n == known.loc[(row.bearing, "z"), "peak_n"]


def rates(response):
    """Time derivatives of the coordinates (K, n) of a response."""
    each = np.eye(response.system.size)
    return track(response).along(0.0 * each, each).T


@given(st.integers(3, 40), st.integers(0, 2**32 - 1))
def test_slopes_of_a_periodic_motion_are_those_of_the_closed_spline(count, seed):
    samples, each = np.random.default_rng(seed).normal(size=(count, 3)), np.eye(3)
    time = 0.3 * np.arange(count + 1)
    spline = CubicSpline(time, np.concatenate([samples, samples[:1]]), bc_type="periodic")
    slopes = periodic_track(samples, 0.3).along(0.0 * each, each).T
    np.testing.assert_allclose(slopes, spline(time[:-1], 1), rtol=0, atol=1e-10)


@given(st.integers(4, 40), st.integers(0, 2**32 - 1))
def test_places_and_speeds_along_some_directions_are_those_of_the_coordinates(count, seed):
    random = np.random.default_rng(seed)
    samples, places, speeds = (random.normal(size=shape) for shape in ((count, 3), (3, 2), (3, 2)))
    speeds[:, 0] = 0.0
    for motion in (periodic_track(samples, 0.3), SampledTrack(samples, 0.3)):
        moved, moving = motion.along(np.eye(3), np.zeros((3, 3))), motion.along(np.zeros((3, 3)), np.eye(3))
        expected = places.T @ moved + speeds.T @ moving
        np.testing.assert_allclose(moved, samples.T, rtol=0, atol=1e-13)
        np.testing.assert_allclose(motion.along(places, speeds), expected, rtol=0, atol=1e-11)


@pytest.mark.parametrize("clearance", [0.0, 2e-6])
def test_forces_between_the_samples_are_those_of_a_run_with_as_many_samples(clearance):
    (model, few), (_, many) = (loaded(clearance=clearance, error=4e-6, samples=each) for each in (256, 1024))
    assert few.motion is Motion.PERIODIC and few.per_period * 4 == many.per_period
    dense = np.moveaxis(bearing_forces(model, track(few, 4)), -1, 0)
    exact = bearing_history(model, many)
    np.testing.assert_allclose(dense, exact, rtol=0, atol=1e-4 * np.abs(exact).max())
