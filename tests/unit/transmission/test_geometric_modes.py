"""Modes of geometric meshes, beside those of equation (13) as printed."""

import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
from hypothesis import event, given, settings
from hypothesis import strategies as st
from lumped_machines import make_layout, make_machine

from facegear.transmission.imperfections import perfect
from facegear.transmission.layout import MeshKinematics, Tilt
from facegear.transmission.loaded_modes import _forces_by_active_sets, loaded_modes, working_flanks
from facegear.transmission.mode_classes import ModeClass, name_modes
from facegear.transmission.modes import natural_modes
from facegear.transmission.statics import mean_equilibrium

ROOT = Path(__file__).parents[3]

LAYOUT = make_layout(kinematics=MeshKinematics.GEOMETRIC)


def test_inputs_work_on_their_drive_flanks_and_idlers_on_the_back_flank_below():
    working = working_flanks(make_machine(LAYOUT, torque=2000.0, tail_share=0.03))
    drive, back = np.split(working, 2)
    np.testing.assert_array_equal(back, [True, True, False, False, True] + 5 * [False])
    np.testing.assert_array_equal(drive, ~back)


def test_with_a_large_tail_torque_the_tail_idlers_upper_mesh_changes_flank():
    working = working_flanks(make_machine(LAYOUT, torque=2000.0, tail_share=0.9))
    drive, back = np.split(working, 2)
    assert back[5] and not drive[5]


@settings(max_examples=40, deadline=None)
@given(
    st.integers(0, 2**31), st.floats(50.0, 4000.0), st.floats(0.0, 0.9), st.floats(1e-6, 2e-4), st.booleans()
)
def test_active_sets_find_the_flank_forces_of_the_compiled_statics(seed, torque, share, backlash, flawed):
    random = np.random.default_rng(seed)
    flaws = perfect(LAYOUT)
    if flawed:
        flaws = replace(
            flaws,
            error=15e-6 * random.normal(size=len(LAYOUT.meshes)),
            position=15e-6 * random.normal(size=(len(LAYOUT.pinions), 2)),
            stiffness=random.uniform(0.7, 1.4, len(LAYOUT.meshes)),
        )
    machine = make_machine(LAYOUT, torque, share, backlash, imperfections=flaws)
    forces, exact = _forces_by_active_sets(machine), mean_equilibrium(machine).flank_forces[0]
    event("settled" if forces is not None else "left to the compiled statics")
    if forces is not None:
        np.testing.assert_allclose(forces, exact, atol=1e-9 * exact.max())


def test_modes_of_geometric_meshes_need_no_compiled_code():
    code = (
        "import sys, facegear; found = facegear.load('facegear/example.yaml', None).modes();"
        "print(found.values['transmission']['mesh_kinematics'], 'numba' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["geometric", "False"]


def test_pinions_float_in_one_direction_less_and_the_rigid_modes_stay():
    machine = make_machine(LAYOUT, torque=2000.0, tail_share=0.03)
    modes = loaded_modes(machine)
    assert (modes.frequencies[:6] == 0.0).all() and modes.frequencies[6] > 100.0
    names = name_modes(LAYOUT, modes)
    assert [name.mode_class for name in names[:6]] == 6 * [ModeClass.RIGID]
    # As printed, each pinion has a translation that no mesh feels: five modes at 1171.8 Hz.
    free = np.sqrt(6.5e7 / 1.199) / (2.0 * np.pi)
    assert (np.abs(modes.frequencies - free) < 0.01).sum() < 5
    assert (np.abs(natural_modes(make_layout(), 4.1e8).frequencies - free) < 0.01).sum() == 5


def test_printed_machines_keep_their_modes():
    machine = make_machine()
    np.testing.assert_array_equal(
        loaded_modes(machine).frequencies, natural_modes(machine.layout, machine.stiffness.mean).frequencies
    )


def test_tilting_gears_add_two_modes_each_and_stiff_tilt_adds_nothing_else():
    def tilting(stiffness):
        gears = tuple(replace(g, body=replace(g.body, tilt=Tilt(0.3, stiffness))) for g in LAYOUT.gears)
        return make_machine(replace(LAYOUT, gears=gears), torque=2000.0, tail_share=0.03)

    square = loaded_modes(make_machine(LAYOUT, torque=2000.0, tail_share=0.03)).frequencies
    stiff = loaded_modes(tilting(1e19)).frequencies
    assert stiff.size == square.size + 4
    np.testing.assert_allclose(stiff[:-4], square, rtol=1e-6, atol=1e-2)
    soft = loaded_modes(tilting(1e6))
    # More freedom with its own inertia lowers every frequency (interlacing).
    assert (soft.frequencies[:-4] <= square + 1e-6).all()
    assert any("tilt" in name.symbols for name in name_modes(tilting(1e6).layout, soft))


def test_inputs_float_along_one_line_and_idlers_along_none():
    """As printed every pinion has one translation that no mesh feels; really only inputs, whose two meshes
    push along one line, while an idler's drive flank above and back flank below push along two.
    """
    printed, geometric = both_modes()
    assert multiplicities(printed) == [6, 1, 1, 2, 1, 5, 1, 1, 1, 1, 1, 1, 2, 1, 1, 1, 1]
    assert multiplicities(geometric) == [6, 1, 1, 1, 1, 2] + 16 * [1]
    classes = [name.mode_class for name in name_modes(LAYOUT, geometric)]
    coupled = [ModeClass.COUPLED]
    expected = 6 * [ModeClass.RIGID] + coupled + 2 * [ModeClass.PINION] + coupled + 2 * [ModeClass.PINION]
    assert classes == expected + 16 * coupled


def test_the_table_of_both_kinematics_in_the_docs_is_what_the_model_gives():
    told = (ROOT / "docs" / "validation.md").read_text().splitlines()
    for line in table_lines():
        assert line in told


def both_modes():
    """The paper's machine at the torque of its config, as printed and with geometric meshes."""
    at_work = {"torque": 1327.6, "tail_share": 0.034}
    return loaded_modes(make_machine(make_layout(), **at_work)), loaded_modes(make_machine(LAYOUT, **at_work))


def multiplicities(modes):
    return [stop - start for start, stop in modes.groups]


def table_lines() -> Iterator[str]:
    """Orders, frequency, multiplicity and class by both, orders that are alike in one row."""
    columns = [cells(modes) for modes in both_modes()]
    rows = list(zip(*columns, strict=True))
    edges = [0] + [k for k in range(1, len(rows)) if rows[k] != rows[k - 1]] + [len(rows)]
    for start, stop in pairwise(edges):
        orders = str(stop) if stop == start + 1 else f"{start + 1}-{stop}"
        yield f"| {orders} | {' | '.join(rows[start])} |"


def cells(modes):
    names = name_modes(LAYOUT, modes)
    for start, stop in modes.groups:
        for order in range(start, stop):
            cell = f"{modes.frequencies[order]:.1f} | {stop - start} | {names[order].mode_class.value}"
            yield cell


def test_bearings_with_play_vibrate_along_and_across_their_load_as_they_are_pressed():
    """k along the load, k (1 - c / r) across it: not the bearing without play."""
    play = 30e-6
    flaws = replace(perfect(LAYOUT), clearance=np.full(5, play))
    machine = make_machine(LAYOUT, torque=2000.0, tail_share=0.03, imperfections=flaws)
    standing = mean_equilibrium(machine).displacements[0].reshape(-1, 4)
    pinions = list(LAYOUT.pinions)
    for i, pinion in enumerate(pinions):
        place = standing[i, :2]
        k, r = pinion.body.bearing[0], np.hypot(*place)
        assert r > play
        matrix = k * (1.0 - play / r) * np.eye(2) + k * play / r**3 * np.outer(place, place)
        bearing = (matrix[0, 0], matrix[1, 1], 0.0)
        pinions[i] = replace(pinion, body=replace(pinion.body, bearing=bearing, bearing_xy=matrix[0, 1]))
    pressed = make_machine(replace(LAYOUT, pinions=tuple(pinions)), torque=2000.0, tail_share=0.03)
    np.testing.assert_array_equal(working_flanks(pressed), working_flanks(machine))
    frequencies = loaded_modes(machine).frequencies
    np.testing.assert_allclose(frequencies, loaded_modes(pressed).frequencies, rtol=1e-9, atol=1e-4)
    without = loaded_modes(make_machine(LAYOUT, torque=2000.0, tail_share=0.03)).frequencies
    assert (frequencies <= without + 1e-6).all() and (frequencies < 0.99 * without).any()
