"""Section `transmission.casing`: the example runs, bad values are refused in one line that names the key."""

from pathlib import Path

import numpy as np
import pytest

import facegear
from facegear.build.casing import reduced_casing
from facegear.build.config import Config
from facegear.build.load import load_config
from facegear.build.notes import notes
from facegear.errors import ConfigErrors
from facegear.schema.base import parse
from facegear.schema.casing import CasingSection
from tests.helpers.public_casing import FILE

EXAMPLE = Path(__file__).parents[3] / "config" / "casing.yaml"
KEY = "transmission.casing"


def refusal(**changes):
    """The error lines of the example with some keys of its casing changed."""
    with pytest.raises(ConfigErrors) as error:
        load_config(EXAMPLE, {"transmission": {"casing": changes}})
    assert len(error.value.lines) == 1, error.value.lines
    return error.value.lines[0]


def test_the_example_has_the_published_mesh_forces():
    forces = facegear.load(EXAMPLE, results=None).statics().table().set_index("mesh")["force_n"]
    assert forces["p0/lower"] == pytest.approx(10_639.410, abs=6e-4)
    assert forces["p0/upper"] == pytest.approx(26_139.854, abs=6e-4)


@pytest.mark.parametrize(
    ("changes", "start", "words"),
    [
        ({"stiffness": "none.npz"}, f"{KEY}.stiffness = ", "no such file"),
        ({"seats": {"p9": 101}}, f"{KEY}.seats.p9 = ", "one of p0, p1, p2, lower gear, upper gear"),
        ({"seats": {"p0": 999}}, f"{KEY}.seats.p0 = 999", "a node that has rows"),
        (
            {"seats": {"p0": {"at_mm": [140, 0, 0]}, "p1": {"at_mm": [0, 121.5, 0]}}},
            f"{KEY}.seats.p1.at_mm",
            "1.5 mm",
        ),
        ({"seats": {"p0": {"patch": "left wall"}}}, f"{KEY}.seats.p0.patch", "it has none"),
        ({"seats": {"p0": {"node": 101, "patch": "a"}}}, f"{KEY}.seats.p0.patch", "left out beside node"),
        ({"feet": []}, f"{KEY}.feet = ", "such that they hold the casing"),
        ({"feet": [{"node": 301}]}, f"{KEY}.feet[0].held", "true, or else stiffness_n_per_m"),
        ({"feet": [{"node": 101, "held": True}]}, f"{KEY}.feet[0] = 101", "does not belong to p0"),
        ({"units": "si"}, f"{KEY}.mass = ", "units mm_t_s"),
        ({"mass_kg": 20.0}, f"{KEY}.mass = ", "from 18 to 22 kg"),
        ({"axes": {"z": [1, 0, 1]}}, f"{KEY}.axes.z = ", "perpendicular to x"),
        (
            {"sensors": [{"name": "top", "node": 77}]},
            f"{KEY}.sensors.top.node = 77",
            "motions along x, y and z",
        ),
        ({"damping": "none.csv"}, f"{KEY}.damping = ", "no such file"),
    ],
)
def test_a_bad_value_is_refused_by_its_key(changes, start, words):
    line = refusal(**changes)
    assert line.partition(": ")[2].startswith(start) or line.startswith(start)
    assert words in line


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(
    ("quantity", "factor", "words"),
    [("damping", -1e-6, "without negative eigenvalues"), ("stiffness", 0.0, "holds every row")],
)
def test_matrices_that_give_energy_or_hold_nothing_are_refused(quantity, factor, words, tmp_path):
    with np.load(EXAMPLE.parent / "casing" / "box.npz") as archive:
        arrays = dict(archive)
    arrays[quantity] = factor * arrays["stiffness"]
    np.savez(tmp_path / "box.npz", **arrays)
    line = refusal(stiffness=str(tmp_path / "box.npz"))
    assert f"{KEY}.{quantity} = " in line
    assert words in line


def test_a_foot_of_springs_with_too_few_of_them_is_refused():
    line = refusal(feet=[{"node": 301, "stiffness_n_per_m": {"x": 1e8, "y": 1e8, "z": 1e8}}])
    assert "3 free motions" in line


@pytest.mark.parametrize("order", [(2, 1, 0), (1, 2, 0)])
def test_mesh_forces_on_a_casing_do_not_depend_on_the_order_of_pinions(order):
    """The casing turned with the pinion that came first in the list."""
    gearbox = facegear.load(EXAMPLE, results=None)
    pinions = gearbox.values["transmission"]["pinions"]
    reordered = gearbox.with_values({"transmission.pinions": [pinions[number] for number in order]})
    forces, expected = (each.statics().table().set_index("mesh")["force_n"] for each in (reordered, gearbox))
    np.testing.assert_allclose(forces[expected.index], expected, rtol=1e-10)


def test_clearance_beside_a_seat_that_gives_way_is_refused():
    with pytest.raises(ConfigErrors, match=r"transmission\.pinion\.clearance_um"):
        load_config(EXAMPLE, {"transmission": {"pinion": {"clearance_um": 10}}})


def test_clearance_is_refused_by_whole_names_of_seats():
    """The seat of p10 was taken for one of p1, which has the clearance and stands on the ground."""
    values = load_config(EXAMPLE).model_dump(mode="json")
    machine = values["transmission"]
    for pinion, name in zip(machine["pinions"], ("p10", "p1", "p2"), strict=True):
        pinion["name"] = name
    machine["casing"]["seats"] = {"p10": 101, "lower gear": 104, "upper gear": 105}
    machine["single_pinions"] = {"p1": {"clearance_um": 10.0}}
    parse(Config, values)
    machine["casing"]["seats"]["p1"] = 102
    with pytest.raises(ConfigErrors, match=r"single_pinions\.p1\.clearance_um = 10\.0: must be 0"):
        parse(Config, values)


@pytest.mark.parametrize(
    ("axes", "noted"),
    [
        ({}, []),
        ({"x": [0, 1, 0]}, ["p0", "p1", "p2"]),
        ({"x": [-1, 0, 0]}, ["p0", "p1", "p2"]),
        ({"x": [1, 0, 0], "z": [0, 0, -1]}, ["p1", "upper gear"]),
    ],
)
def test_seats_far_from_what_they_carry_get_a_note(axes, noted):
    """Mistaken axes of the file passed without a word: bearings were tied to seats of other pinions."""
    values = load_config(EXAMPLE, {"transmission": {"casing": {"axes": axes}}}).model_dump(mode="json")
    lines = [line for line in notes(values) if ".casing.seats." in line]
    assert [line.split(".seats.")[1].split(":")[0] for line in lines] == noted


def test_printed_kinematics_beside_a_casing_are_refused():
    changes = {
        "mesh_kinematics": "printed",
        "pinion": {"base_radius_mm": 27},
        "face_gear": {"mesh_radius_mm": 90},
    }
    with pytest.raises(ConfigErrors, match="left out where mesh_kinematics is printed"):
        load_config(EXAMPLE, {"transmission": changes})


def section(**changes):
    seats = {"p0": 101, "p1": 102, "p2": 103, "lower gear": 104, "upper gear": 105}
    base = {"node": 301, "held": True}
    values = {"stiffness": str(FILE), "units": "mm_t_s", "seats": seats, "feet": [base], **changes}
    return CasingSection.model_validate(values, strict=False)


def test_stiff_springs_below_a_foot_are_a_held_foot():
    held = reduced_casing(section(modes=0))
    springs = dict.fromkeys("xyz", 100000000000000.0)
    foot = {
        "node": 301,
        "stiffness_n_per_m": springs,
        "stiffness_n_m_per_rad": dict.fromkeys("xyz", 10000000000000.0),
    }
    sprung = reduced_casing(section(modes=0, feet=[foot]))
    assert sprung.size == held.size + 6
    first, second = (np.linalg.inv(casing.stiffness)[:30, :30] for casing in (held, sprung))
    np.testing.assert_allclose(second, first, rtol=2e-4, atol=1e-6 * np.abs(first).max())
    load = np.eye(30)[:, 26]
    on_foot = sprung.foot_loads @ np.linalg.solve(sprung.stiffness, np.append(load, np.zeros(6)))
    np.testing.assert_allclose(on_foot[:3], held.foot_loads[:3] @ (first @ load), rtol=1e-6, atol=1e-6)


def test_axes_turn_a_casing_into_those_of_the_machine():
    plain = reduced_casing(section(modes=5))
    turned = reduced_casing(section(modes=5, axes={"x": [0, 1, 0], "z": [0, 0, 1], "origin_mm": [1, 2, 3]}))
    # The machine's X is the file's y, its Y the file's -x.
    np.testing.assert_allclose(turned.stiffness[0, 0], plain.stiffness[1, 1], rtol=1e-12)
    np.testing.assert_allclose(turned.stiffness[0, 1], -plain.stiffness[0, 1], rtol=1e-9, atol=1.0)
    np.testing.assert_allclose(turned.seat_positions[1], [0.118, 0.001, -0.003], atol=1e-15)
    np.testing.assert_allclose(turned.own_frequencies, plain.own_frequencies, rtol=1e-9)


def test_arrays_of_the_stage_give_the_casing_back():
    casing = reduced_casing(section(modes=5))
    again = type(casing).of_arrays(casing.to_arrays())
    np.testing.assert_array_equal(again.stiffness, casing.stiffness)
    assert again.seats == casing.seats


def test_equal_sections_share_the_reduction():
    assert reduced_casing(section(modes=3)) is reduced_casing(section(modes=3))
