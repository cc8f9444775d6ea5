"""Errors of single meshes and bodies in the config: one line each, and one line of refusal."""

import re
from copy import deepcopy

import numpy as np
import pytest
from ruamel.yaml import YAML
from three_pinions import STIFFNESS, TEETH, TEXT

import facegear
from facegear.build.lumped_model import machine
from facegear.build.notes import notes, require_buildable, require_room
from facegear.errors import ConfigError, ConfigErrors
from facegear.harmonics import Harmonics
from facegear.machine.statics import mean_equilibrium, static_equilibrium
from facegear.schema.base import parse
from facegear.schema.changes import add_changes, movable
from facegear.schema.transmission import Transmission


def section(**changes):
    values = YAML(typ="safe").load(TEXT)
    return {**values, **changes}


def built(**changes):
    return machine(parse(Transmission, section(**changes)), TEETH, STIFFNESS)


def test_one_line_overrides_one_mesh():
    found = built(single_meshes={"two/lower": {"error_um": 12.0}}).imperfections
    np.testing.assert_allclose(found.error, [0, 12e-6, 0, 0, 0, 0])
    found = built(single_meshes={"tail/upper": {"backlash_um": 60, "stiffness_factor": 1.1}})
    np.testing.assert_allclose(found.half_backlash, [50e-6] * 5 + [30e-6])
    np.testing.assert_allclose(found.imperfections.stiffness, [1, 1, 1, 1, 1, 1.1])
    own = built(single_meshes={"one/upper": {"transmission_error": {"amplitude_um": 3}}}).imperfections
    assert own.series[3].amplitudes[1] == pytest.approx(3e-6)


def test_errors_from_contact_are_those_of_the_unloaded_pair_and_one_mesh_may_differ():
    unloaded = Harmonics(np.array([0.0, 2e-6]), np.array([0.0, -1e-6]))
    values = section(transmission_error="from_contact")
    for spelling in ("from_contact", {"source": "from_contact"}):
        found = machine(parse(Transmission, section(transmission_error=spelling)), TEETH, STIFFNESS, unloaded)
        np.testing.assert_array_equal(found.error.sine, unloaded.sine)
        np.testing.assert_array_equal(found.error.cosine, unloaded.cosine)
        assert found.error_lags is None
    own = {**values, "single_meshes": {"two/lower": {"transmission_error": {"amplitude_um": 3}}}}
    found = machine(parse(Transmission, own), TEETH, STIFFNESS, unloaded)
    assert found.imperfections.series[1].amplitudes[1] == pytest.approx(3e-6)
    with pytest.raises(ConfigError, match=r"mesh_stiffness\.source is harmonics"):
        machine(parse(Transmission, values), TEETH, STIFFNESS)


@pytest.mark.parametrize(
    ("error", "line"),
    [
        (
            {"source": "from_contact", "amplitude_um": 5},
            "error.amplitude_um = 5.0: must be left out",
        ),
        ({"source": "from_contact", "phasing": "in_step"}, 'phasing = "in_step": must be left out'),
        ({"phase_deg": 5}, "transmission_error.amplitude_um = null: must be given, unless"),
    ],
)
def test_an_error_is_either_given_or_from_contact(error, line):
    with pytest.raises(ConfigErrors, match="transmission_error") as caught:
        parse(Transmission, section(transmission_error=error))
    assert line in str(caught.value)


@pytest.mark.parametrize(
    "changes",
    [
        {"transmission.transmission_error": "from_contact"},
        {"transmission.single_meshes": {"tail idler/lower": {"transmission_error": "from_contact"}}},
    ],
)
def test_an_error_from_contact_is_refused_where_stiffness_is_given(changes):
    given = {"mesh_stiffness": {"source": "harmonics", "table": [{"order": 0, "cos_n_per_m": 4e8}]}}
    with pytest.raises(ConfigErrors, match="no contact analysis gives e"):
        facegear.example().with_values(given | changes)


def lags_of_error(phasing):
    error = {"amplitude_um": 10, "phasing": phasing}
    return machine(parse(Transmission, section(transmission_error=error)), TEETH, STIFFNESS)


def test_error_lags_where_a_pattern_says_so_and_a_mesh_goes_before_its_role():
    found = lags_of_error({"input/lower": 0.5, "two/lower": 0.25})
    names = found.layout.mesh_names
    np.testing.assert_array_equal(
        found.error_phases, [{"one/lower": 0.5, "two/lower": 0.25}.get(name, 0.0) for name in names]
    )


def test_pattern_of_the_stiffness_lags_is_the_phasing_by_mesh():
    by_mesh = lags_of_error("mesh")
    pattern = dict(zip(by_mesh.layout.mesh_names, by_mesh.phases.tolist(), strict=True))
    np.testing.assert_array_equal(lags_of_error(pattern).error_phases, by_mesh.error_phases)
    assert not lags_of_error({}).error_phases.any()


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        (
            {"transmission_error": {"phasing": "in step"}},
            '"in step": must be mesh, in_step, or lags',
        ),
        (
            {"transmission_error": {"phasing": {"one/lower": 1.0}}},
            "one/lower = 1.0: must be a number from",
        ),
        ({"transmission_error": {"phasing": {"idler/lower": 0.5}}}, "one of one/lower"),
        (
            {"single_meshes": {"one/lower": {"transmission_error": {"phasing": {}}}}},
            "one mesh has no pattern",
        ),
    ],
)
def test_pattern_that_names_no_mesh_or_no_part_of_a_period_is_refused_in_one_line(changes, line):
    for error in (changes, *changes.get("single_meshes", {}).values()):
        error.get("transmission_error", {})["amplitude_um"] = 10
    with pytest.raises(ConfigErrors) as caught:
        parse(Transmission, section(**changes))
    assert line in str(caught.value)
    assert len(str(caught.value).splitlines()) == 1


def test_one_line_overrides_one_body():
    bearing = {"x": 2e8, "y": 3e8, "z": 0, "xy": 5e7}
    found = built(single_pinions={"two": {"bearing_stiffness_n_per_m": bearing, "mass_kg": 2.0}})
    assert found.layout.pinions[1].body.bearing == (2e8, 3e8, 0)
    assert found.layout.pinions[1].body.bearing_xy == 5e7
    assert [pinion.body.mass for pinion in found.layout.pinions] == [1.2, 2.0, 1.2]
    gear = built(single_gears={"upper": {"runout": {"eccentricity_um": 20, "phase_deg": 90}}})
    assert gear.imperfections.gear_runout[1].amplitude == pytest.approx(20e-6)
    assert gear.imperfections.gear_runout[1].phase == pytest.approx(np.pi / 2)
    assert gear.imperfections.gear_runout[0].amplitude == 0.0


def test_what_all_pinions_have_holds_where_one_has_none_of_its_own():
    body = {**section()["pinion"], "clearance_um": 20, "runout": {"eccentricity_um": 5}}
    found = built(pinion=body, single_pinions={"one": {"clearance_um": 0}}).imperfections
    np.testing.assert_allclose(found.bearing_clearance, [0, 20e-6, 20e-6])
    np.testing.assert_allclose([one.amplitude for one in found.pinion_runout], 5e-6)


def test_clearance_is_given_to_each_side_or_from_side_to_side_as_catalogues_do():
    body = {**section()["pinion"], "clearance_diametral_um": 40}
    single = {"one": {"clearance_diametral_um": 30}, "two": {"clearance_um": 0}}
    found = built(pinion=body, single_pinions=single).imperfections
    np.testing.assert_allclose(found.bearing_clearance, [15e-6, 0.0, 20e-6])


@pytest.mark.parametrize(
    ("key", "clearance_um"),
    [
        ("pinion.clearance_um", [15, 25, 25]),
        ("single_pinions.one.clearance_um", [20, 20, 20]),
        ("single_pinions.two.clearance_um", [15, 25, 20]),
    ],
)
def test_a_tolerance_adds_to_a_clearance_that_is_given_from_side_to_side(key, clearance_um):
    """It was refused in every sample, or the pinion named lost the play that all pinions have."""
    body, key = {**section()["pinion"], "clearance_diametral_um": 40}, f"transmission.{key}"
    given = section(pinion=body, single_pinions={"one": {"clearance_diametral_um": 30}})
    start = movable({"transmission": parse(Transmission, given).model_dump(mode="json")}, [key])
    sample = parse(Transmission, add_changes(start, {key: 5.0})["transmission"])
    found = machine(sample, TEETH, STIFFNESS).imperfections.bearing_clearance
    np.testing.assert_allclose(found, 1e-6 * np.array(clearance_um))


def test_a_sample_shares_with_the_nominal_machine_what_it_does_not_change_and_leaves_that_as_it_is():
    given = section(single_pinions={"one": {"clearance_um": 30}})
    keys = [f"transmission.single_pinions.{name}.clearance_um" for name in ("one", "two")]
    start = movable({"transmission": parse(Transmission, given).model_dump(mode="json")}, keys)
    before = deepcopy(start)
    sample = add_changes(start, {keys[0]: 5.0, keys[1]: -5.0})
    assert start == before
    own = sample["transmission"]["single_pinions"]
    assert own["one"]["clearance_um"] == 35.0
    assert own["two"]["clearance_um"] == before["transmission"]["single_pinions"]["two"]["clearance_um"] - 5.0
    assert sample["transmission"]["pinions"] is start["transmission"]["pinions"]


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        (
            {"single_pinions": {"one": {"clearance_um": 5, "clearance_diametral_um": 10}}},
            r"clearance_diametral_um = 10\.0: must be left out where clearance_um = 5 is given",
        ),
        (
            {"single_meshes": {"three/lower": {"error_um": 1}}},
            r"single_meshes\.three/lower.*one of one/lower",
        ),
        ({"single_meshes": {"one/side": {"error_um": 1}}}, r"single_meshes\.one/side"),
        ({"single_pinions": {"six": {}}}, r"single_pinions\.six.*one of one, two, tail"),
        (
            {"face_gears": ["upper"], "single_gears": {"lower": {"runout": {"eccentricity_um": 3}}}},
            r"single_gears\.lower.*one of upper",
        ),
        (
            {
                "single_pinions": {
                    "one": {"clearance_um": 5, "bearing_stiffness_n_per_m": {"x": 0, "y": 0, "z": 0}}
                }
            },
            r"single_pinions\.one\.clearance_um = 5\.0: must be 0 unless the bearing is round",
        ),
        (
            {
                "single_pinions": {
                    "one": {"bearing_stiffness_n_per_m": {"x": 1e8, "y": 1e8, "z": 0, "xy": 2e8}}
                }
            },
            r"xy = 200000000\.0: must be less than",
        ),
        (
            {"face_gear": {**section()["face_gear"], "mesh_radius_mm": 262.5}},
            r"mesh_radius_mm = 262\.5.*printed",
        ),
        (
            {"mesh_kinematics": "printed"},
            r"mesh_radius_mm = null: must be given, as required by",
        ),
        (
            {
                "mesh_kinematics": "printed",
                "face_gear": {**section()["face_gear"], "mesh_radius_mm": 262.5},
                "single_meshes": {"one/lower": {"error_um": 1}},
            },
            r"single_meshes = .*mesh_kinematics is printed",
        ),
    ],
)
def test_parts_that_are_not_there_or_cannot_be_are_refused_by_key(changes, line):
    with pytest.raises(ConfigErrors, match=line) as caught:
        parse(Transmission, section(**changes))
    assert len(caught.value.lines) == 1


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        (
            {"pinions": [*section()["pinions"][:2], {"name": "tail", "role": "tail", "angle_deg": 56.0}]},
            r"pinions\[2\]\.angle_deg = 56\.0: .* fit, .* 55\.38.* 56\.64.* -5220 um .* 100 um",
        ),
        (
            {
                "face_gear": {
                    **section()["face_gear"],
                    "bearing_stiffness_n_per_m": {"x": 1e9, "y": 1e9, "z": 0},
                },
                "single_gears": {"lower": {"force_n": {"z": 80}}},
            },
            r"single_gears\.lower\.force_n\.z = 80\.0: must be 0, as the bearing has no stiffness along z",
        ),
        (
            {"single_pinions": {"one": {"cumulative_pitch_um": [1.0, 2.0]}}},
            r"cumulative_pitch_um = '2 values': must be one for each of the 23 teeth",
        ),
    ],
)
def test_machines_that_do_not_go_together_are_refused(changes, line):
    with pytest.raises(ConfigError, match=line):
        require_buildable(parse(Transmission, section(**changes)), TEETH)


PRELOADED = [
    ({"position_um": {"x": 150.0}}, {}, r"single_pinions\.two: -\d+ um between its two meshes: preloaded"),
    ({"position_um": {"y": 150.0}}, {}, r"two\.position_um\.y: 13\.4 um too deep in two/upper: preloaded"),
    (
        {"position_um": {"x": 20.0}},
        {"backlash_um": 0},
        r"single_pinions\.two: -\d+ um between its two meshes",
    ),
]


@pytest.mark.parametrize(("own", "changes", "line"), PRELOADED)
def test_a_machine_that_errors_press_together_is_solved_with_a_note_and_jams_in_a_series(own, changes, line):
    parts = parse(Transmission, section(single_pinions={"two": own}, **changes))
    require_buildable(parts, TEETH)
    teeth = {"pinion_teeth": 23, "face_gear_teeth": 143, "module_mm": 3.75, "pressure_angle_deg": 25}
    values = {"transmission": parts.model_dump(mode="json"), "reproduction": None, "tooth_pair": teeth}
    message = [note for note in notes(values) if "preloaded" in note]
    assert message and re.search(line, message[0])
    idle = parse(Transmission, parts.model_dump() | {"torque": {"per_input_n_m": 1e-3, "tail_share": 0.1}})
    found = mean_equilibrium(machine(idle, TEETH, STIFFNESS))
    assert found.flank_forces[0].max() > 100.0
    assert found.residual[0] < 1e-12
    with pytest.raises(ConfigError):
        require_room(parts, TEETH)


def test_an_external_force_is_carried_by_the_bearings_and_noted():
    own = {"single_pinions": {"two": {"force_n": {"x": 300, "y": -200}}}}
    parts = parse(Transmission, section(**own))
    loaded = machine(parts, TEETH, STIFFNESS)
    np.testing.assert_array_equal(loaded.linear.loads[4:8], [300.0, -200.0, 0.0, 800.0])
    values = {"transmission": parts.model_dump(mode="json"), "reproduction": None}
    assert "external forces on two" in notes(values)[0]


def test_a_machine_with_errors_within_its_backlash_is_buildable():
    errors = {"single_pinions": {"two": {"position_um": {"x": 20.0, "y": -20.0}, "clearance_um": 20}}}
    require_buildable(parse(Transmission, section(**errors)), TEETH)


def test_a_config_of_ones_own_is_reported_once_what_printed_meshes_and_runouts_mean():
    plain = parse(Transmission, section()).model_dump(mode="json")
    printed = {**plain, "mesh_kinematics": "printed"}
    turning = {**plain, "single_gears": {"upper": {"runout": {"eccentricity_um": 5.0}}}}
    for transmission, reproduction, message in (
        (plain, None, 0),
        (printed, None, 1),
        (printed, "a.yaml", 0),
        (turning, None, 1),
        (None, None, 0),
    ):
        assert len(notes({"transmission": transmission, "reproduction": reproduction})) == message


def test_both_gears_may_carry_load_and_differ_in_all_but_their_teeth():
    """Lower gear of its own mass, bearing, tilt and load; the upper one's torque follows, as do forces."""
    lower = {
        "torque_n_m": -2000.0,
        "mass_kg": 12.0,
        "bearing_stiffness_n_per_m": {"x": 1e9, "y": 2e9, "z": 3e9},
    }
    lower["tilt"] = {"inertia_kg_m2": 0.4, "stiffness_n_m_per_rad": 5e8}
    found = built(single_gears={"lower": lower}, transmission_error={"amplitude_um": 0})
    upper, below = found.layout.gears[1], found.layout.gears[0]
    assert below.body.mass == 12.0 and upper.body.mass == 7.8
    assert below.body.bearing == (1e9, 2e9, 3e9) and upper.body.tilt is None
    ratio = 143 / 23
    assert found.torques[3] == -2000.0
    assert found.torques[4] == pytest.approx(2000.0 - ratio * found.torques[:3].sum(), rel=1e-12)
    forces = static_equilibrium(found).forces
    arm = found.layout.gear_arm
    assert forces[:3].sum() * arm == pytest.approx(2000.0, rel=1e-11)
    assert forces[3:].sum() * arm == pytest.approx(-found.torques[4], rel=1e-11)


def test_the_output_gears_torque_is_not_given():
    with pytest.raises(ConfigErrors, match=r"single_gears\.upper\.torque_n_m.*balance"):
        parse(Transmission, section(single_gears={"upper": {"torque_n_m": -100.0}}), "transmission")
