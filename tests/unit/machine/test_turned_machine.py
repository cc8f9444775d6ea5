"""Turning the whole machine about its axis, or upside down, changes nothing: all angles count from the first
pinion.
"""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lumped_machines import PLACES, make_layout, make_machine, mesh_parts
from references import against, agrees

import facegear
from facegear.harmonics import Harmonics
from facegear.machine.flank_errors import slow_errors
from facegear.machine.imperfections import Runout, perfect
from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.layout import Role, Side
from facegear.machine.mesh_phases import PhaseConvention
from facegear.machine.statics import equilibria, static_equilibrium

WAVY = Harmonics(np.array([0.0, 3e-6, 1e-6]), np.array([0.0, 5e-6, -2e-6]))
TWO_ENGINES = (("one", Role.INPUT, 0.0), ("two", Role.INPUT, 37.3))
CYCLES = np.array([0.0, 0.4, 31.7, 1500.2])
runouts = st.builds(Runout, st.floats(0.0, 30e-6), st.floats(-6.3, 6.3))


def turned(layout, by):
    return replace(layout, pinions=tuple(replace(one, pitches=one.pitches + by) for one in layout.pinions))


@against(
    "analytic",
    "symmetry under turning",
    capability="hunting",
    module="facegear.machine.statics",
)
@settings(max_examples=25, deadline=None)
@given(data=st.data(), by=st.floats(-143.0, 143.0), phasing=st.sampled_from(["mesh", "in_step", "given"]))
def test_turning_the_whole_machine_changes_no_flank_force(data, by, phasing):
    sides = data.draw(st.sampled_from([(Side.LOWER, Side.UPPER), (Side.UPPER,), (Side.LOWER,)]))
    layout = make_layout(PLACES if len(sides) > 1 else TWO_ENGINES, sides, kinematics=GEOMETRIC)
    pinions, gears = len(layout.pinions), len(layout.gears)
    flaws = replace(
        perfect(layout),
        pinion_runout=tuple(data.draw(runouts) for _ in range(pinions)),
        gear_runout=tuple(data.draw(runouts) for _ in range(gears)),
        gear_pitch={0: 8e-6 * np.sin(np.arange(143) ** 1.3)},
        pinion_pitch={1: 8e-6 * np.sin(np.arange(23) ** 1.3)},
    )
    lags = {"mesh": None, "in_step": np.zeros(pinions * gears)}
    lags["given"] = np.linspace(0.0, 0.9, pinions * gears)
    machine = replace(
        make_machine(layout, 1328.0, 0.05 if len(sides) > 1 else 0.0, imperfections=flaws),
        error=WAVY,
        error_lags=lags[phasing],
    )
    here = equilibria(machine, CYCLES).flank_forces
    there = equilibria(replace(machine, layout=turned(layout, by)), CYCLES).flank_forces
    agrees("flank force, N", there, here, relative=1e-7, absolute=1e-7 * here.max())


@against(
    "analytic",
    "symmetry under turning",
    capability="load_sharing_reference",
    module="facegear.machine.statics",
)
@pytest.mark.parametrize("convention", PhaseConvention)
@pytest.mark.parametrize("lags", [None, np.zeros(10)])
def test_turning_the_printed_machine_changes_no_mesh_force(convention, lags):
    machine = replace(make_machine(error=20e-6), error_lags=lags, phase_convention=convention)
    here = static_equilibrium(machine, 0.3).forces
    there = static_equilibrium(replace(machine, layout=turned(machine.layout, 0.25)), 0.3).forces
    agrees("mesh force, N", there, here, relative=1e-7, absolute=1e-7 * np.abs(here).max())


@against(
    "analytic",
    "symmetry under turning",
    capability="dynamics_response",
    module="facegear.motion.steady_state.simulate",
)
def test_turning_an_in_step_machine_by_a_quarter_pitch_keeps_its_vibration():
    """k(t) counted from angle 0 and e(t) from the first pinion: an RMS of 8.1 um became one of 2.7 um."""
    start = facegear.load("config/harmonics_only.yaml", results=None).with_values(
        {
            "transmission.transmission_error": {"amplitude_um": 5, "phasing": "in_step"},
            "transmission.mesh_kinematics": "geometric",
            "transmission.face_gear.mesh_radius_mm": None,
        }
    )
    angles = [place["angle_pitches"] + 0.25 for place in start.values["transmission"]["pinions"]]
    moved = {f"transmission.pinions.{i}.angle_pitches": angle for i, angle in enumerate(angles)}
    here, there = (one.response().table() for one in (start, start.with_values(moved)))
    here, there = (table[table["quantity"].str.contains("deflection_ac_rms")] for table in (here, there))
    assert here["value"].max() > 1.0
    agrees("RMS of a body's motion", there["value"], here["value"], relative=1e-6)


@against(
    "analytic",
    "an eccentric gear is a gear displaced",
    capability="hunting following",
    module="facegear.machine.flanks",
)
@settings(max_examples=25, deadline=None)
@given(one=runouts, side=st.sampled_from(Side), start=st.floats(-100.0, 100.0))
def test_an_eccentric_gear_is_a_gear_displaced_towards_its_high_point_as_it_turns(one, side, start):
    """The high point stands at its phase from the first pinion and goes on as the gear is driven."""
    places = tuple((name, role, pitches + start) for name, role, pitches in PLACES)
    layout = make_layout(places, kinematics=GEOMETRIC)
    gear = [gear.side for gear in layout.gears].index(side)
    eccentric = tuple(one if g == gear else Runout() for g in range(2))
    errors = slow_errors(
        make_machine(layout, imperfections=replace(perfect(layout), gear_runout=eccentric)), CYCLES
    )
    turn = one.phase + 2.0 * np.pi * CYCLES / layout.gear_teeth
    angle = layout.angles[0] + (turn if side is Side.UPPER else -turn)
    moved = np.zeros((CYCLES.size, layout.dof))
    at = 4 * (len(layout.pinions) + gear)
    # The mesh at distribution angle p lies towards (sin p, -cos p): there a gear moves along (cos p, sin p).
    moved[:, at], moved[:, at + 1] = one.amplitude * np.sin(angle), -one.amplitude * np.cos(angle)
    tangential, separating = mesh_parts(layout)
    expected = -moved @ np.concatenate([separating + tangential, separating - tangential]).T
    agrees("error of a flank, m", errors, expected, relative=1e-7, absolute=1e-12)


@pytest.mark.parametrize("side", Side)
def test_a_gear_whose_pitch_deviations_are_a_sine_from_the_first_pinion_on_is_an_eccentric_gear(side):
    layout = make_layout(kinematics=GEOMETRIC)
    gear = [gear.side for gear in layout.gears].index(side)
    curve = 15e-6 * np.sin(2.0 * np.pi * np.arange(143) / 143)
    pitched = replace(perfect(layout), gear_pitch={gear: curve})
    eccentric = tuple(Runout(15e-6, 0.0) if g == gear else Runout() for g in range(2))
    cycles = np.arange(0.0, 143.0)
    one, other = (
        slow_errors(make_machine(layout, imperfections=flaws), cycles)
        for flaws in (pitched, replace(perfect(layout), gear_runout=eccentric))
    )
    np.testing.assert_allclose(one, other, atol=1e-3 * 15e-6)


def test_a_machine_with_one_gear_is_the_same_upside_down():
    upper = make_layout(TWO_ENGINES, (Side.UPPER,), kinematics=GEOMETRIC)
    mirrored = tuple((name, role, -pitches) for name, role, pitches in TWO_ENGINES)
    lower = make_layout(mirrored, (Side.LOWER,), kinematics=GEOMETRIC)
    motions = []
    for layout in (upper, lower):
        machine = make_machine(layout, 1000.0, 0.0)
        found = equilibria(replace(machine, error=WAVY, error_lags=np.zeros(2)), CYCLES)
        motions.append(found.displacements[:, layout.spins])
    relative = [spins - spins[:1] for spins in motions]
    np.testing.assert_allclose(relative[1], relative[0], atol=1e-9 * np.abs(relative[0]).max())
