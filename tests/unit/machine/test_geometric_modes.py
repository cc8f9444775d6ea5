"""Modes of geometric meshes, beside those of equation (13) as printed."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from free_machines import natural_modes
from hypothesis import event, given, settings
from hypothesis import strategies as st
from lumped_machines import make_layout, make_machine, mesh_parts
from references import against, agrees
from scipy.linalg import eigh

from facegear.machine.imperfections import perfect
from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.layout import Role, Side, Tilt
from facegear.machine.linear_model import bearing_matrix, lumped_model, mass_diagonal
from facegear.machine.loaded_contacts import forces_by_active_sets, loaded_contacts
from facegear.machine.loaded_modes import contact_table, loaded_modes, vibrating_machine
from facegear.machine.modes import ModeClass, name_modes
from facegear.machine.statics import mean_equilibrium

ROOT = Path(__file__).parents[3]

LAYOUT = make_layout(kinematics=GEOMETRIC)


def working_flanks(machine):
    return np.array([state == "closed" for state in loaded_contacts(machine).flank_states()])


def test_inputs_work_on_their_drive_flanks_and_idlers_on_the_back_flank_below():
    working = working_flanks(make_machine(LAYOUT, torque=2000.0, tail_share=0.03))
    drive, back = np.split(working, 2)
    np.testing.assert_array_equal(back, [True, True, False, False, True] + 5 * [False])
    np.testing.assert_array_equal(drive, ~back)


def test_with_a_large_tail_torque_the_tail_idlers_upper_mesh_changes_flank():
    working = working_flanks(make_machine(LAYOUT, torque=2000.0, tail_share=0.9))
    drive, back = np.split(working, 2)
    assert back[5] and not drive[5]


@against(
    "second implementation",
    "active sets with NumPy beside the compiled statics",
    capability="modal",
    module="facegear.machine.loaded_modes",
)
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
    forces, exact = forces_by_active_sets(machine), mean_equilibrium(machine).flank_forces[0]
    event("settled" if forces is not None else "left to the compiled statics")
    if forces is not None:
        agrees("flank force, N", forces, exact, relative=1e-7, absolute=1e-9 * exact.max())


def test_pinions_float_in_one_direction_less_and_the_rigid_modes_stay():
    machine = make_machine(LAYOUT, torque=2000.0, tail_share=0.03)
    modes = loaded_modes(machine)
    assert (modes.frequencies[:6] == 0.0).all() and modes.frequencies[6] > 100.0
    names = name_modes(LAYOUT, lumped_model(LAYOUT), modes)
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
    assert any("tilt" in name.symbols for name in name_modes(tilting(1e6).layout, tilting(1e6).linear, soft))


def test_inputs_float_along_one_line_and_idlers_along_none():
    """In the printed model every pinion has one translation that no mesh feels; really only inputs have.

    Their two meshes push along one line, while an idler's drive flank above and back flank below push along
    two.
    """
    printed, geometric = both_modes()
    assert multiplicities(printed) == [6, 1, 1, 2, 1, 5, 1, 1, 1, 1, 1, 1, 2, 1, 1, 1, 1]
    assert multiplicities(geometric) == [6, 1, 1, 1, 1, 2] + 16 * [1]
    classes = [name.mode_class for name in name_modes(LAYOUT, lumped_model(LAYOUT), geometric)]
    coupled = [ModeClass.PINION_AND_GEAR]
    expected = 6 * [ModeClass.RIGID] + coupled + 2 * [ModeClass.PINION] + coupled + 2 * [ModeClass.PINION]
    assert classes == expected + 16 * coupled


def test_the_table_of_both_kinematics_in_the_docs_is_what_the_model_gives():
    message = (ROOT / "docs" / "explanation" / "validation.md").read_text().splitlines()
    for line in table_lines():
        assert line in message


def both_modes():
    """The paper's machine at the torque of its config, as printed and with geometric meshes."""
    at_work = {"torque": 1327.6, "tail_share": 0.034}
    return loaded_modes(make_machine(make_layout(), **at_work)), loaded_modes(make_machine(LAYOUT, **at_work))


def multiplicities(modes):
    return [stop - start for start, stop in modes.groups]


def table_lines() -> Iterator[str]:
    """Frequencies of both by the class of their modes, with the multiplicity of those that repeat."""
    printed, geometric = (frequencies_by_class(modes) for modes in both_modes())
    for kind in ("pinion", "face gear", "pinion coupled face gear"):
        yield f"| {kind} | {printed.get(kind, 'none')} | {geometric.get(kind, 'none')} |"


def frequencies_by_class(modes):
    """Return the text of a cell by class."""
    names, cells = name_modes(LAYOUT, lumped_model(LAYOUT), modes), {}
    for start, stop in modes.groups:
        cell = f"{modes.frequencies[start]:.1f}" + (f" ({stop - start})" if stop > start + 1 else "")
        cells.setdefault(names[start].mode_class.value, []).append(cell)
    return {kind: ", ".join(frequencies) for kind, frequencies in cells.items()}


def test_bearings_with_clearance_vibrate_along_and_across_their_load_as_they_are_pressed():
    """k along the load, k (1 - c / r) across it: not the bearing without play."""
    clearance = 30e-6
    flaws = replace(perfect(LAYOUT), bearing_clearance=np.full(5, clearance))
    machine = make_machine(LAYOUT, torque=2000.0, tail_share=0.03, imperfections=flaws)
    standing = mean_equilibrium(machine).displacements[0].reshape(-1, 4)
    pinions = list(LAYOUT.pinions)
    for i, pinion in enumerate(pinions):
        place = standing[i, :2]
        k, r = pinion.body.bearing[0], np.hypot(*place)
        assert r > clearance
        matrix = k * (1.0 - clearance / r) * np.eye(2) + k * clearance / r**3 * np.outer(place, place)
        bearing = (matrix[0, 0], matrix[1, 1], 0.0)
        pinions[i] = replace(pinion, body=replace(pinion.body, bearing=bearing, bearing_xy=matrix[0, 1]))
    pressed = make_machine(replace(LAYOUT, pinions=tuple(pinions)), torque=2000.0, tail_share=0.03)
    np.testing.assert_array_equal(working_flanks(pressed), working_flanks(machine))
    frequencies = loaded_modes(machine).frequencies
    np.testing.assert_allclose(frequencies, loaded_modes(pressed).frequencies, rtol=1e-9, atol=1e-4)
    without = loaded_modes(make_machine(LAYOUT, torque=2000.0, tail_share=0.03)).frequencies
    assert (frequencies <= without + 1e-6).all() and (frequencies < 0.99 * without).any()


def idle_machine(torque, clearance=0.0, turned=1.0, **options):
    """One face gear driven by two of three pinions: the third carries nothing. `turned` -1: in a mirror."""
    places = (("a", Role.INPUT, 0.0), ("b", Role.INPUT, turned * 45.0), ("idle", Role.IDLER, turned * 80.5))
    layout = make_layout(places, (Side.UPPER,), kinematics=GEOMETRIC)
    flaws = replace(perfect(layout), bearing_clearance=np.full(3, clearance))
    return make_machine(layout, turned * torque, 0.0, imperfections=flaws, **options)


def test_a_mesh_that_carries_nothing_stays_open_in_the_modes():
    """The idle pinion vibrates in its bearing alone, at sqrt(k / m), along x and y.

    Each of the others does so across the force of its one mesh.
    """
    modes = loaded_modes(idle_machine(800.0))
    alone = np.sqrt(6.5e7 / 1.199) / (2.0 * np.pi)
    assert (np.abs(modes.frequencies / alone - 1.0) < 1e-9).sum() == 2 + 2
    # Three axial motions, the turn of the machine, and that of the idle pinion.
    assert (modes.frequencies == 0.0).sum() == 5


@against(
    "analytic",
    "mirror symmetry",
    capability="modal",
    module="facegear.machine.loaded_modes",
)
@settings(max_examples=20, deadline=None)
@given(torque=st.floats(50.0, 4000.0), backlash=st.floats(0.0, 2e-4), clearance=st.sampled_from([0.0, 2e-5]))
def test_a_machine_and_its_mirror_image_have_the_same_modes(torque, backlash, clearance):
    one, other = (
        loaded_modes(idle_machine(torque, clearance, turned, backlash=backlash)).frequencies
        for turned in (1.0, -1.0)
    )
    agrees("natural frequency, Hz", one, other, relative=1e-6, absolute=1e-6)


@settings(max_examples=30, deadline=None)
@given(
    torque=st.floats(50.0, 4000.0),
    clearance=st.floats(1e-6, 5e-5),
    backlash=st.floats(1e-6, 2e-4),
    seed=st.integers(0, 2**31),
)
def test_no_mode_of_a_pinion_in_its_clearance_hangs_on_the_last_digits_of_a_torque(
    torque, clearance, backlash, seed
):
    machine = idle_machine(torque, clearance, backlash=backlash)
    place = 2e-6 * np.random.default_rng(seed).normal(size=(3, 2))
    found = []
    for factor in (1.0, 1.0 + 1e-6):
        flaws = replace(machine.imperfections, position=place)
        near = replace(machine, torques=factor * machine.torques, imperfections=flaws)
        found.append(vibrating_machine(near))
    firm = found[0].is_decided & found[1].is_decided
    one, other = (modes.modes.frequencies[firm] for modes in found)
    np.testing.assert_allclose(one, other, rtol=1e-4, atol=1e-6)
    assert firm.all() or any(machine.contacts.any_undecided() for machine in found)


@against(
    "analytic",
    "eigenvalues of the machine with both flanks, by hand",
    capability="modal",
    module="facegear.machine.loaded_modes",
)
def test_a_wedged_mesh_has_both_flanks_and_the_table_names_it():
    """A pinion set too deep presses both flanks of a tooth: 2 k along its way, 2 k along the gears' axis."""
    layout = make_layout((("a", Role.INPUT, 0.0),), kinematics=GEOMETRIC)
    flaws = replace(perfect(layout), position=np.array([[0.0, 30e-6]]))
    machine = make_machine(layout, 100.0, 0.0, backlash=0.0, imperfections=flaws)
    found = vibrating_machine(machine)
    table = contact_table(machine, found, "local").set_index("contact")
    assert table["state"].to_list() == ["open", "wedged"]
    tangential, separating = (parts[1] for parts in mesh_parts(layout))
    squares = np.outer(tangential, tangential) + np.outer(separating, separating)
    exact = eigh(bearing_matrix(layout) + 2.0 * 4.1e8 * squares, np.diag(mass_diagonal(layout)))[0]
    agrees(
        "square of an angular frequency, 1/s2",
        (2.0 * np.pi * found.modes.frequencies) ** 2,
        exact,
        relative=1e-7,
        absolute=1e-9 * exact.max(),
    )


def test_the_table_says_what_every_mesh_and_every_bearing_with_clearance_does():
    machine = idle_machine(800.0, 2e-5)
    table = contact_table(machine, vibrating_machine(machine), "average").set_index("contact")
    assert table["state"].to_dict() == {
        "a/upper": "drive",
        "b/upper": "drive",
        "idle/upper": "open",
        "a bearing": "closed",
        "b bearing": "closed",
        "idle bearing": "open",
    }
    assert table.loc["a/upper", "force_n"] == pytest.approx(800.0 / machine.layout.pinion_arm, rel=1e-9)
    assert table.loc["a/upper", ["stiffness_n_per_m", "definition"]].to_list() == [4.1e8, "average"]


@pytest.mark.parametrize(("share", "state"), [(1e-11, "open"), (1e-8, "undecided"), (1e-3, "closed")])
def test_a_contact_that_carries_next_to_nothing_is_undecided_and_so_are_the_modes_it_changes(share, state):
    places = (("a", Role.INPUT, 0.0), ("tail", Role.TAIL, 45.0))
    layout = make_layout(places, (Side.UPPER,), kinematics=GEOMETRIC)
    found = vibrating_machine(make_machine(layout, 800.0, share))
    states = [str(one) for one in found.contacts.flank_states()]
    assert states == ["closed", "open", "open", state]
    assert found.is_decided.all() == (state != "undecided")
