"""The viewer's data say what the contact analysis found, and the page carries all that it needs."""

import base64
import gzip
import json
import re
from math import cos, sin
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from family_pairs import public_pair
from public_teeth import NAMES

from facegear.build.load import load_config
from facegear.build.tooth_pair import pair
from facegear.contact.pattern import SHARES
from facegear.report.page import Chapter, render
from facegear.report.viewers import line_load, pair_view

ROWS, COLUMNS = 5, 4
CONFIG = Path(__file__).parents[3] / "config" / "quick.yaml"


@pytest.fixture(scope="module")
def loads():
    """Two torques and positions; at each one tooth carries load on two rows of every column."""
    chance = np.random.default_rng(1)
    nodes = np.concatenate([np.arange(COLUMNS), COLUMNS + np.arange(COLUMNS)])
    keys = [(torque, position) for torque in (100.0, 300.0) for position in (0.0, 0.5)]
    size = len(keys) * nodes.size
    y = np.array([0.250, 0.251, 0.253, 0.254])
    grid = np.broadcast_to(y, (ROWS, COLUMNS))
    return {
        "torque_n_m": np.repeat([torque for torque, _ in keys], nodes.size),
        "position": np.repeat([position for _, position in keys], nodes.size),
        "tooth": np.repeat([-1, 0, 1, 0], nodes.size),
        "node": np.tile(nodes, len(keys)),
        "force_n": chance.uniform(1.0, 100.0, size),
        "in_fillet": np.zeros(size, bool),
        "shape": np.array([ROWS, COLUMNS]),
        "point_m": np.stack([0 * grid, grid, 0 * grid], axis=-1).reshape(-1, 3),
        "line_torque_n_m": np.repeat([torque for torque, _ in keys], COLUMNS),
        "line_position": np.repeat([position for _, position in keys], COLUMNS),
        "line_tooth": np.repeat([-1, 0, 1, 0], COLUMNS),
        "line_plane": np.tile(np.arange(COLUMNS), len(keys)),
        "line_where": np.tile([1, 0, 0, 3], len(keys)),
        "line_pressure_pa": chance.uniform(1e8, 1e9, len(keys) * COLUMNS),
    }


@pytest.fixture(scope="module")
def view(loads):
    rows = [(100.0, 0.5, 2.0), (100.0, 0.0, 1.0), (300.0, 0.0, 3.0), (300.0, 0.5, 4.0)]
    frame = pd.DataFrame(rows, columns=["torque_n_m", "position", "ste_um"])
    for name in SHARES:
        frame[name] = float(name.endswith("_0"))
    return pair_view(design(), loads, frame)


def design():
    return pair(load_config(CONFIG).tooth_pair).design


def decoded(text, kind):
    return np.frombuffer(base64.b64decode(text), kind)


def test_load_along_the_face_adds_up_to_the_force(loads):
    on = loads["torque_n_m"] == 300.0
    first = on & (loads["node"] < COLUMNS)  # one of the two rows, each with its column's whole load
    width = np.tile([0.5, 1.5, 1.5, 0.5], 2)  # mm that each column stands for
    assert line_load(loads, first | on)[loads["node"][on] < COLUMNS] @ width == pytest.approx(
        loads["force_n"][on].sum()
    )


def test_the_viewer_holds_every_loaded_node_at_its_torque_and_position(loads, view):
    for found in view.data["torques"]:
        node, tooth = decoded(found["node"], "<u2"), decoded(found["tooth"], "i1")
        load, pressure = (decoded(found["values"][key], "u1") for key in ("load", "pressure"))
        for index, position in enumerate(view.data["positions"]):
            here = slice(*found["start"][index : index + 2])
            on = (loads["torque_n_m"] == found["torque_n_m"]) & (loads["position"] == position)
            np.testing.assert_array_equal(node[here], loads["node"][on])
            np.testing.assert_array_equal(tooth[here], loads["tooth"][on])
            drawn = load[here] / 255 * found["largest"]["load"]
            np.testing.assert_allclose(drawn, line_load(loads, on), atol=found["largest"]["load"] / 255)
            lines = (loads["line_torque_n_m"] == found["torque_n_m"]) & (loads["line_position"] == position)
            message = np.tile(np.where([0, 1, 1, 0], 1e-6 * loads["line_pressure_pa"][lines], 0.0), 2)
            drawn = pressure[here] / 255 * found["largest"]["pressure"]
            np.testing.assert_allclose(drawn, message, atol=found["largest"]["pressure"] / 255)
    assert [found["error_um"] for found in view.data["torques"]] == [[1.0, 2.0], [3.0, 4.0]]


def test_the_page_carries_viewer_and_data_below_two_megabytes(view):
    text = render("Case", "Lead", [Chapter("Loaded contact", "", view=view)])
    assert len(text) < 2e6
    assert not re.search(r"""(src|href)=["'](?!data:|#)|https?://""", text)
    (stored,) = re.findall(r'<script type="application/gzip">(.*?)</script>', text, re.DOTALL)
    assert json.loads(gzip.decompress(base64.b64decode(stored)))["positions"] == [0.0, 0.5]
    assert text.count('querySelectorAll(".pair-view")') == 1
    asked = set(re.findall(r'find\("(\w+)"\)', text))
    assert asked == set(re.findall(r'name="?(\w+)"? ?(?:type="range"|type="button"|>)', text)), "controls"
    assert "pair-view" not in re.sub(r"(?s)<style>.*</style>", "", render("C", "L", [Chapter("Modes", "")]))


def test_root_stress_colours_the_fillets_of_every_tooth_on_its_passage(loads):
    chance = np.random.default_rng(2)
    stress = {"torque_n_m": np.array([100.0, 300.0])}
    for name, shape in (("pinion", (2, 3)), ("face_gear", (4, 2))):
        stress[f"{name}_passage"] = np.array([-1.0, -0.5, 0.0, 0.5])  # two teeth at the two positions
        stress[f"{name}_stress_pa"] = chance.normal(0.0, 1e8, (2, 4, 2, *shape))
        stress[f"{name}_position_m"] = chance.normal(size=(2, *shape, 3))
        stress[f"{name}_tangent_rad"] = np.zeros((2, *shape))
    ltca = pd.DataFrame(
        [(t, x, 1.0) for t in (100.0, 300.0) for x in (0.0, 0.5)],
        columns=["torque_n_m", "position", "ste_um"],
    )
    seen = pair_view(design(), loads, ltca.assign(**dict.fromkeys(SHARES, 0.0)), stress).data
    assert [one["name"] for one in seen["quantities"]] == ["pressure", "load", "root stress"]
    found = seen["torques"][1]
    largest = 1e-6 * max(stress[f"{name}_stress_pa"][1].max() for name in ("pinion", "face_gear"))
    assert found["largest"]["root_stress"] == pytest.approx(largest)
    for body in seen["bodies"]:
        message = decoded(found["tension"][body["name"]], "u1").astype(float) / 255.0 * largest
        wanted = 1e-6 * np.maximum(stress[f"{body['name']}_stress_pa"][1], 0.0).ravel()
        assert body["fillets"]["first"] == -1
        np.testing.assert_allclose(message, wanted, atol=largest / 255.0)
        points = decoded(body["fillets"]["points"], "<f4")
        np.testing.assert_allclose(points, 1e3 * stress[f"{body['name']}_position_m"].ravel(), rtol=1e-6)


def test_friction_colours_the_lines_of_contact_by_loss_and_by_flash_temperature(loads):
    chance = np.random.default_rng(3)
    friction = {key: loads[f"line_{key}"] for key in ("torque_n_m", "position", "tooth", "plane")}
    size = friction["plane"].size
    friction |= {
        "inside": (loads["line_where"] == 0).astype(int),
        "loss_w_per_m": chance.uniform(1e4, 2e5, size),
        "flash_k": chance.uniform(10.0, 90.0, size),
    }
    ltca = pd.DataFrame(
        [(t, x, 1.0) for t in (100.0, 300.0) for x in (0.0, 0.5)],
        columns=["torque_n_m", "position", "ste_um"],
    )
    ltca = ltca.assign(**dict.fromkeys(SHARES, 0.0))
    seen = pair_view(design(), loads, ltca, friction=friction).data
    assert [one["name"] for one in seen["quantities"][2:]] == ["friction loss", "flash temperature"]
    for number, found in enumerate(seen["torques"]):
        here = slice(2 * COLUMNS * number, 2 * COLUMNS * (number + 1))
        loss = np.tile(1e-3 * friction["loss_w_per_m"][here].reshape(2, 1, COLUMNS), (1, 2, 1)).ravel()
        rise = np.where(friction["inside"], friction["flash_k"], 0.0)[here].reshape(2, 1, COLUMNS)
        for key, wanted in (("loss", loss), ("flash", np.tile(rise, (1, 2, 1)).ravel())):
            drawn = decoded(found["values"][key], "u1").astype(float) / 255.0 * found["largest"][key]
            assert found["largest"][key] == pytest.approx(wanted.max())
            np.testing.assert_allclose(drawn, wanted, atol=found["largest"][key] / 255.0)


@pytest.mark.parametrize("name", NAMES)
def test_a_pinion_is_drawn_where_its_axis_stands(loads, name):
    """It was drawn about y through the origin, whatever the shaft angle and the offset."""
    pair_of_kind = public_pair(name)
    ltca = pd.DataFrame({"torque_n_m": [100.0], "position": [0.0], "ste_um": [1.0]})
    data = pair_view(pair_of_kind, loads, ltca.assign(**dict.fromkeys(SHARES, 0.0))).data
    pinion, gear = data["bodies"]
    gamma = pair_of_kind.shaft_angle
    outwards = np.reshape(pinion["matrix"], (3, 3)) @ [0.0, 1.0, 0.0]
    np.testing.assert_allclose(outwards, [0.0, sin(gamma), -cos(gamma)], atol=1e-15)
    np.testing.assert_allclose(pinion["shift"], [1e3 * pair_of_kind.offset, 0.0, 0.0], atol=1e-12)
    assert gear["matrix"] == np.eye(3).ravel().tolist() and gear["shift"] == [0.0, 0.0, 0.0]
    # the pinion's pitch line passes by the middle of the picture
    height = -pair_of_kind.pinion_pitch_radius * np.array([0.0, cos(gamma), sin(gamma)])
    expected = np.array([pair_of_kind.offset, 0.0, 0.0]) + pair_of_kind.middle * outwards + height
    np.testing.assert_allclose(data["centre"], 1e3 * expected, atol=1e-10)
