"""Impossible machines are refused before any work: every mistake at once, each line saying what must be."""

import shutil
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import facegear
from facegear.__main__ import main
from facegear.build.cases import expand_cases, set_key
from facegear.build.config import Config
from facegear.build.load import load_config
from facegear.build.notes import notes
from facegear.errors import ConfigError, ConfigErrors
from facegear.schema.base import NEW_KEYS, parse
from facegear.schema.strength import Strength
from facegear.schema.studies import Search
from facegear.schema.tolerances import Tolerances

CONFIG = Path(__file__).parents[3] / "config"
TWO = load_config(CONFIG / "two_pinion.yaml").model_dump(mode="json")
RENAMED_IN = ("branches", "strength_only", "harmonics_only")
"""Configs with keys that had other names in earlier versions."""
GIVEN = load_config(CONFIG / "harmonics_only.yaml").model_dump(mode="json")


def lines(values, **keys):
    """All that is told of a config with dotted keys (two underscores) set."""
    changed = {**values}
    for key, value in keys.items():
        *sections, last = key.split("__")
        inside = changed
        for section in sections:
            part = int(section) if section.isdecimal() else section
            inside[part] = inside[part].copy()
            inside = inside[part]
        inside[last] = value
    with pytest.raises(ConfigErrors) as refused:
        expand_cases(parse(Config, changed))
    return refused.value.lines


@pytest.mark.parametrize(
    ("section", "key", "line"),
    [
        ((), "Dynamics", "Dynamics = {}: unknown key; did you mean 'dynamics'?"),
        ((), "load-sharing", "load-sharing = {}: unknown key; did you mean 'load_sharing'?"),
        ((), "MESH", "MESH = {}: unknown key; did you mean 'mesh'?"),
        (("transmission",), "Backlash_um", "did you mean 'backlash_um'?"),
        (
            ("dynamics",),
            "float",
            "dynamics.float = {}: unknown key; allowed here: accuracy",
        ),
    ],
)
def test_capitals_and_hyphens_in_a_key_are_reported_with_what_was_meant(section, key, line):
    """They were taken for names of types: a traceback, or a hint at the section the key stands in."""
    (message,) = lines(TWO, **{"__".join((*section, key)): {}})
    assert line in message and message.startswith(".".join((*section, key)))


def place_of(key, values):
    """Parts of the dotted key at which a key first stands in nested values; None if it stands nowhere."""
    inside = values.items() if isinstance(values, dict) else enumerate(values)
    for part, value in inside:
        if part == key:
            return (key,)
        if isinstance(value, dict | list) and (below := place_of(key, value)) is not None:
            return (str(part), *below)
    return None


@pytest.mark.parametrize(("old", "new"), sorted(NEW_KEYS.items()))
def test_a_key_of_an_earlier_version_is_refused_with_its_name_of_today(old, new):
    """In the file itself, and as the dotted key of a change or of a study."""
    shipped = [load_config(CONFIG / f"{name}.yaml").model_dump(mode="json") for name in RENAMED_IN]
    values, *_ = [values for values in shipped if place_of(new, values)]
    *sections, _ = place_of(new, values)
    with pytest.raises(ConfigError, match=f"`{old}` is now `{new}`"):
        set_key(values, ".".join((*sections, old)), 1.0)
    inside = values
    for part in sections:
        inside = inside[int(part) if part.isdecimal() else part]
    value = inside.pop(new)
    (line,) = lines(values, **{"__".join((*sections, old)): value})
    assert line.endswith(f"{old} = {value}: unknown key; `{old}` is now `{new}`")


@given(st.text(st.characters(categories=("L", "N", "P")), min_size=1, max_size=12))
def test_any_unknown_key_is_one_line_that_names_it(key):
    for place in ((), ("dynamics",), ("transmission", "torque")):
        path = "__".join((*place, "?")).replace("?", key)
        if "__" in key or key in Config.model_fields:
            continue
        (message,) = lines(GIVEN, **{path: 1})
        assert message.startswith(".".join((*place, key)) + " = 1: unknown key; ")


def test_mistakes_in_different_parts_of_a_config_are_reported_at_once():
    message = lines(
        TWO,
        transmission__mesh_kinematics="printed",
        transmission__pinion={**TWO["transmission"]["pinion"], "clearance_um": 10.0},
        transmission__torque={"per_input_n_m": 600.0, "tail_share": 0.1},
    )
    assert [line.split(" = ")[0] for line in message] == [
        "transmission.face_gear.mesh_radius_mm",
        "transmission.torque.tail_share",
    ]
    message = lines(TWO, mesh_stiffness__torque_n_m=1e4, transmission__pinions__1__angle_deg=1.0)
    assert [line.split(" = ")[0] for line in message] == ["mesh_stiffness.torque_n_m", "transmission.pinions"]
    assert all(": must be " in line for line in message)


def test_keys_below_the_name_of_a_shaft_or_a_mesh_are_listed_too():
    """Names given by the user hid the section below them: the list was empty, and nothing was suggested."""
    segments = [{"length_mm": 100, "diameter_mm": 40}]
    bearings = [{"at_mm": at, "rolling": {"card": "deep_groove_6210"}} for at in (10, 90)]
    shaft = {"segments": segments, "pinion_mm": 50, "bearings": bearings}
    bearings[0]["rolling"]["clearance_um"] = 15
    bearings[1]["rolling"]["zzz"] = 15
    meshes = {"a/lower": {"q": 1}}
    messages = lines(TWO, transmission__shafts={"input": shaft}, transmission__single_meshes=meshes)
    (meant,) = [line for line in messages if "clearance_um" in line]
    assert meant.startswith("transmission.shafts.input.bearings[0].rolling.clearance_um = 15: unknown key; ")
    assert meant.endswith("did you mean 'clearance_diametral_um'?")
    (listed,) = [line for line in messages if "zzz" in line]
    assert "allowed here: cage, centrifugal, clearance_diametral_um" in listed
    (listed,) = [line for line in messages if "a/lower" in line]
    assert "backlash_um" in listed


CAUSE = {"name": "a", "moves": {"transmission.backlash_um": 1.0}, "source": "drawing", "spread": 2.0}
HARMONIC = {"order": 1, "amplitude_um": 1.0}


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        (
            {"transmission__torque__per_input_n_m": 1e6},
            "transmission.torque.per_input_n_m = 1000000.0: must be at most",
        ),
        (
            {"transmission__pinions__1__torque_n_m": -1e6},
            "[1].torque_n_m = -1000000.0: must be at most",
        ),
        (
            {"transmission__pinions__1__name": "lower face gear"},
            'transmission.pinions.1.name = "lower face gear": must be another name than lower face gear or',
        ),
        ({"contact__torques_n_m": [150.0, 1e6]}, "contact.torques_n_m = 1000000.0: must be at most"),
        (
            {"tooth_pair__pinion__lead_crowning": {"amount_um": 20.0, "start_mm": 12.0, "length_mm": 8.0}},
            "lead_crowning.start_mm = 12.0: must be less than 12.000, half of the gear's face",
        ),
        (
            {"transmission__transmission_error__more_harmonics": [HARMONIC]},
            "more_harmonics[0].order = 1: must be another one than 1",
        ),
        (
            {"transmission__transmission_error__more_harmonics": [{**HARMONIC, "order": 3}] * 2},
            "more_harmonics[1].order = 3: must be another one than 1, 3",
        ),
        (
            {"tolerances": {"causes": [{**CAUSE, "limits": [500.0, 520.0]}]}},
            "tolerances.causes[0].limits = [500.0, 520.0]: must be within 6 spreads of the middle",
        ),
        (
            {"tolerances": {"causes": [{**CAUSE, "limits": [-500.0, 500.0]}]}},
            "nearer than 20 spreads on one side at least, or left out: nothing is cut off",
        ),
        (
            {"transmission__pinion__mass_kg": 1e-300},
            "mass_kg = 1e-300: must be greater than or equal",
        ),
        (
            {"reproduction": "nowhere.yaml"},
            '"nowhere.yaml": must be the name of a file that exists',
        ),
    ],
)
def test_what_no_machine_can_be_is_refused(changes, line):
    message = lines(TWO, **changes)
    assert len(message) == 1 and line in message[0], message


def test_a_stiffness_in_newton_per_micrometre_is_refused_by_its_size(tmp_path):
    path = tmp_path / "harmonics.csv"
    path.write_text("order,sin_n_per_m,cos_n_per_m\n0,0,410\n1,20,0\n")
    given = {"source": "harmonics", "csv": str(path)}
    (message,) = lines(GIVEN, mesh_stiffness=given)
    assert message.endswith(
        "= 410.0: must be at least 100000 N/m; values in N/um are a million times too small"
    )
    path.write_text("order,sin_n_per_m,cos_n_per_m\n0,0,4.1e8\n1,2e7,0\n")
    assert parse(Config, {**GIVEN, "mesh_stiffness": given}).mesh_stiffness.mean == 4.1e8


def test_check_refuses_a_reproduction_whose_file_is_missing(tmp_path, capsys):
    """It said: no mistakes."""
    shutil.copy(CONFIG / "harmonics_only.yaml", tmp_path)
    shutil.copy(CONFIG / "paper.yaml", tmp_path)
    path = tmp_path / "harmonics_only.yaml"
    path.write_text(path.read_text().replace("reproduction: null", "reproduction: lost.yaml"))
    assert main(("check", str(path))) == 1
    assert 'lost.yaml": must be the name of a file that exists' in capsys.readouterr().err


def test_causes_that_move_the_same_number_are_reported_when_a_run_starts():
    causes = [CAUSE, {**CAUSE, "name": "b"}]
    message = notes({**TWO, "tolerances": {"causes": causes}})
    assert "tolerances.causes: a and b all move transmission.backlash_um: what they add is summed" in message
    assert not any("tolerances" in line for line in notes({**TWO, "tolerances": {"causes": causes[:1]}}))


@pytest.mark.parametrize(
    ("effect", "sections", "message"),
    [
        ("excitation", ("tolerances",), "excitation: samples of tolerances leave out"),
        ("excitation", ("tolerances", "search"), "samples of tolerances and designs of the search leave out"),
        ("excitation", (), None),
        ("loss_only", ("tolerances",), None),
    ],
)
def test_a_run_says_at_its_start_that_samples_leave_friction_out_of_their_motion(effect, sections, message):
    oil = {"lubrication": {"friction": {"effect": effect}}}
    found = notes({**TWO, **oil, **{section: {"causes": [CAUSE]} for section in sections}})
    about = [line for line in found if line.startswith("lubrication.friction.effect = ")]
    assert len(about) == (message is not None) and all(message in line for line in about)


@pytest.mark.parametrize(
    ("key", "hint"),
    [
        ("transmission.Backlash_um", "did you mean 'backlash_um'?"),
        ("transmision.backlash_um", "did you mean 'transmission'?"),
        ("transmission.pinions.7.role", "transmission.pinions has the positions 0 to 4"),
        ("branches.from_rpm", "branches is null, set it as a whole"),
        ("transmission.single_meshes.x.error_um", "transmission.single_meshes"),
    ],
)
def test_a_misspelt_key_of_with_values_and_of_a_study_is_reported_with_what_was_meant(key, hint):
    gearbox = facegear.example()
    with pytest.raises(ConfigErrors) as refused:
        gearbox.with_values({key: 1, "case": "other"})
    message = refused.value.lines
    assert len(message) == 2 and hint in message[0] and message[0].startswith(f"with_values: {key}"[13:])
    axis = {"label": "a", "key": key, "values": [1]}
    study = {"name": "one", "title": "One", "axes": [axis]}
    with pytest.raises(ConfigErrors, match=r"studies\.one\.1: ") as refused:
        expand_cases(parse(Config, {**gearbox.values, "studies": [study]}))
    assert hint in refused.value.lines[0]


GOAL = {"name": "x", "largest_of": ["k_gamma right input/upper"]}
CARD = {"card": "case_carburised_din3990_11", "root_roughness_um": 16.0}


@pytest.mark.parametrize(
    ("section", "values", "keys"),
    [
        (
            Tolerances,
            {"causes": [CAUSE, CAUSE], "samples": 300, "chunk_samples": 256, "index_blocks": 3},
            ["causes[1].name", "samples", "index_blocks"],
        ),
        (
            Search,
            {
                "variables": [
                    {"name": "x", "sets": ["transmission.backlash_um"], "limits": [1.0, 2.0]},
                    {"name": "y", "sets": ["transmission.backlash_um"], "limits": [1.0, 2.0]},
                ],
                "objectives": [GOAL],
                "seeds": [1, 1],
            },
            ["name", "variables.sets", "seeds"],
        ),
        (
            Strength,
            {
                "pinion": {**CARD, "both_ways": True},
                "face_gear": CARD,
                "duty": [{"torque_n_m": 1.0, "speed_rpm": 1.0, "hours": 0.0}],
                "load_factors": "machine",
                "dynamic_factor": 1.1,
            },
            ["dynamic_factor", "pinion.both_ways", "duty"],
        ),
    ],
)
def test_what_does_not_fit_together_inside_a_section_is_reported_all_at_once(section, values, keys):
    with pytest.raises(ConfigErrors) as refused:
        parse(section, values)
    assert [line.split(" = ")[0] for line in refused.value.lines] == keys
