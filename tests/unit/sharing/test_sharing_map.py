"""The load-sharing map: curves meet the closed forms, and each advice is what the changed machine does."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from idler_machines import FLOATING, HELD, make_idlers
from references import against, agrees
from test_closed_form import config_of

import facegear
from facegear.door.outputs import machine_of
from facegear.errors import ConfigErrors
from facegear.harmonics import Harmonics
from facegear.machine.layout import Role, Side
from facegear.report.sharing_map import sharing_map_tables, sharing_map_text
from facegear.sharing.groups import GroupKind, MapOptions
from facegear.sharing.mapped_machine import MappedMachine, groups_of_kind
from facegear.sharing.path_changes import LEVELS, draws, floated, with_half_backlash, with_scaled_bearings

SPLIT = config_of(3, 1e8, 1e9, 30.0)
MAP = {"mesh_deviation_um": 5.0, "position_deviation_um": 5.0, "samples": 200, "points": 4}


def make_split(**changes):
    """Build the split machine of the closed form's tests with some keys changed."""
    return facegear.load({**SPLIT, "sharing_map": MAP}, None).with_values(changes)


@against(
    "analytic",
    "closed form of equal paths, while all carry",
    capability="sharing_map",
    module="facegear.sharing.sharing_map",
)
@pytest.mark.parametrize("upper", [HELD, 3e8, FLOATING])
def test_curves_of_equal_idlers_are_the_closed_form(upper):
    gearbox = make_idlers(5, upper, backlash_um=2000.0).with_values({"sharing_map": MAP})
    curves = gearbox.sharing_map().curves()
    known = curves[curves["all_carry"] == 1.0]
    assert len(known) > 12
    for level in LEVELS:
        computed, expected = known[f"k_gamma_p{level:g}"], known[f"closed_p{level:g}"]
        agrees(f"P{level:g} of K_gamma of idlers", computed, expected, relative=2e-6)


@against(
    "analytic",
    "loop formula of docs/explanation/theory.md",
    capability="sharing_map",
    module="facegear.sharing.sharing_map",
)
def test_curves_of_inputs_are_the_loop_formula():
    inputs = make_split().sharing_map().inputs()
    assert inputs["bearing_factor"].nunique() == 5
    agrees("K_gamma of inputs", inputs["k_gamma"], inputs["closed"], relative=1e-4)


@against(
    "external source",
    "Singh 2010: X_e alone decides",
    capability="sharing_map",
    module="facegear.sharing.sharing_map",
)
@pytest.mark.parametrize("sides", [(), (Side.UPPER,)])
def test_curves_of_a_hundred_random_machines_collapse_where_paths_part_too(sides):
    """Mesh and bearing stiffness, torque and number of samples late differ; the drawn errors are the same."""
    random, spread = np.random.default_rng(1), {}
    base = floated(machine_of(make_idlers(5)), sides)
    group = groups_of_kind(base, GroupKind.IDLERS)[0]
    drawn = draws(group, MapOptions(1.0, 1.0, 100, 2, 3, (1.0,)))
    for _ in range(100):
        factors = 10.0 ** random.uniform(-1.0, 1.0, 3)
        stiffness = Harmonics(np.zeros(1), factors[0] * base.stiffness.cosine)
        other = replace(base, stiffness=stiffness, torques=factors[1] * base.torques)
        softer = MappedMachine(with_scaled_bearings(other, (Role.IDLER,), factors[2]))
        load, path = softer.load(group), softer.path_stiffness(group)
        mapped = MappedMachine(with_half_backlash(softer.machine, 3.0 * load / path))
        for number in (0.05, 0.2, 0.6):
            forces = mapped.idler_forces(group, number * load / path * drawn)
            found = np.percentile(forces.max(axis=1) / load * 5, LEVELS)
            spread.setdefault(number, []).append(found)
    for number, found in spread.items():
        mean = np.mean(found, axis=0)
        agrees(
            f"K_gamma of random machines at X = {number}, their mean",
            found,
            np.tile(mean, (100, 1)),
            relative=0.01,
        )


CHANGED = {
    "halve the radial stiffness of the bearings of the inputs": {
        f"transmission.single_pinions.input {n}.bearing_stiffness_n_per_m": dict.fromkeys("xyz", 5e7)
        for n in (0, 2)
    },
    "double the radial stiffness of the bearings of the idlers": {
        f"transmission.single_pinions.idler {n}.bearing_stiffness_n_per_m": dict.fromkeys("xyz", 2e9)
        for n in (1, 3, 4)
    },
    "let the upper face gear float": {
        "transmission.single_gears": {"upper": {"bearing_stiffness_n_per_m": {"x": 0.1, "y": 0.1, "z": 1e14}}}
    },
    "halve the backlash of all meshes": {"transmission.backlash_um": 15.0},
}


@against(
    "second implementation",
    "the changed config, put at rest",
    capability="sharing_map",
    module="facegear.sharing.sharing_advice",
)
@pytest.mark.parametrize("words", list(CHANGED))
def test_each_advice_is_what_statics_of_the_changed_config_find(words):
    advice = make_split().sharing_map().table()
    own = advice[(advice["change"] == words) & (advice["kind"] == "inputs")]
    table = make_split(**CHANGED[words]).statics().table().set_index("mesh")
    for row in own.itertuples():
        forces = table.loc[[f"{row.group}/lower", f"{row.group}/upper"], "force_n"].abs()
        agrees(
            "K_gamma of an input after a change", row.found, 2.0 * forces.max() / forces.sum(), relative=1e-9
        )
        assert row.gain == pytest.approx(row.k_gamma - row.found, abs=1e-12)


def test_a_drawn_path_is_late_as_an_error_of_its_upper_mesh_is():
    gearbox = make_split()
    mapped = MappedMachine(machine_of(gearbox))
    group = groups_of_kind(mapped.machine, GroupKind.IDLERS)[0]
    late = 1e-6 * np.array([[7.0, -3.0, 4.0]])
    errors = {f"idler {n}/upper": {"error_um": um} for n, um in zip((1, 3, 4), 1e6 * late[0], strict=True)}
    table = gearbox.with_values({"transmission.single_meshes": errors}).statics().table().set_index("mesh")
    lower = table.loc[[f"idler {n}/lower" for n in (1, 3, 4)], "force_n"].abs()
    assert mapped.idler_forces(group, late)[0] == pytest.approx(lower.to_numpy(), rel=1e-9)


def test_a_machine_turned_the_other_way_has_the_same_map():
    """Negated torques load the back flanks; drawn errors count from the flank that works."""
    ahead, back = (make_idlers(5, torque=torque, backlash_um=2000.0) for torque in (6000.0, -6000.0))
    points = [each.with_values({"sharing_map": MAP}).sharing_map().points() for each in (ahead, back)]
    assert points[0]["k_gamma_p95"].to_numpy() == pytest.approx(points[1]["k_gamma_p95"].to_numpy(), rel=1e-6)


def test_the_text_names_what_lowers_the_largest_factor_and_why_the_closed_form_fails():
    content = make_split(**{"transmission.pinion.clearance_um": 5.0}).sharing_map().content
    text = sharing_map_text({f"sharing_map_{name}": table for name, table in content.items()})
    best = content["advice"].loc[content["advice"]["worst_found"].idxmin()]
    assert f"{best['change']} ({best['from_to']}), {best['worst_found']:.3f}" in text
    assert "bearings have clearance" in text and "uneven angles" in text


def test_tables_of_advice_are_one_a_group_without_changes_that_do_nothing():
    content = make_split().sharing_map().content
    tables = sharing_map_tables({f"sharing_map_{name}": table for name, table in content.items()})
    advice = content["advice"]
    groups = list(advice["group"].unique())
    assert [group in table.caption for group, table in zip(groups, tables, strict=False)] == [True] * 3
    shown = pd.concat([table.frame for table in tables[: len(groups)]])
    assert (shown["gain"] != 0.0).all() and len(shown) == (advice["gain"] != 0.0).sum()


def test_the_advice_on_backlash_halves_that_of_each_mesh():
    """A mean backlash on all meshes would even out meshes that differ."""
    single = {"input 0/upper": {"backlash_um": 90.0}}
    gearbox = make_split(**{"transmission.single_meshes": single})
    words = "halve the backlash of all meshes"
    advice = gearbox.sharing_map().table().set_index(["change", "group"])
    half = {
        "transmission.backlash_um": 15.0,
        "transmission.single_meshes": {"input 0/upper": {"backlash_um": 45.0}},
    }
    forces = gearbox.with_values(half).statics().table().set_index("mesh")["force_n"].abs()
    pair = forces[["input 0/lower", "input 0/upper"]]
    assert advice.loc[(words, "input 0"), "found"] == pytest.approx(2.0 * pair.max() / pair.sum(), rel=1e-9)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"sharing_map.input_bearing_factors": [1.0, 1.0]}, "rising, each once"),
        ({"sharing_map.mesh_deviation_um": 0, "sharing_map.position_deviation_um": 0}, "above 0"),
        ({"transmission.face_gears": ["upper"]}, "one gear alone splits no load"),
    ],
)
def test_a_map_that_cannot_be_is_refused_with_its_key(changes, words):
    with pytest.raises(ConfigErrors, match=words):
        make_split(**changes)
