"""Root stress: superposition over teeth and loads, its tables and surface, the pinion against ISO 6336-3."""

import base64
from math import cos, sqrt
from xml.etree import ElementTree

import numpy as np
import pytest
import scipy.sparse as sp
from contact_bodies import pair_design
from hypothesis import given
from hypothesis import strategies as st
from references import against, agrees
from root_readings import ERROR, GRID, passing
from spur_gears import fzg_c, root_tension, slab_design

from facegear.io.meshes import write_vtu
from facegear.strength.root_form import SpurGear, root_form
from facegear.strength.root_tables import root_arrays, root_tables, stress_surface

ALIKE = np.zeros((2, 2), int)
"""Flanks of both gears without assembly errors."""


@against(
    "manufactured",
    "superposition of random readings and loads, by hand",
    capability="root_stress",
    module="facegear.strength.root_stress",
)
def test_a_tooth_feels_its_own_load_and_those_of_the_teeth_beside_it():
    forces = {tooth: sp.csr_matrix(np.arange(28.0).reshape(4, 7) + tooth) for tooth in (-1, 0, 1)}
    readings, found = passing(forces)
    case = 1 * 2 + 1  # 300 N m at half a pitch
    for seen in (-2, 0, 2):
        expected = sum(
            -readings[seen - tooth + 2] @ force.toarray()[case]
            for tooth, force in forces.items()
            if abs(seen - tooth) <= 2
        )
        place = np.flatnonzero(np.isclose(found.passage, seen + 0.5))
        agrees("stress at a gauge, Pa", found.stress[1, place[0]].ravel(), expected, relative=1e-12)


@against(
    "analytic",
    "linear elasticity",
    capability="root_stress",
    module="facegear.strength.root_stress",
)
@given(factor=st.floats(0.1, 10.0))
def test_root_stress_is_linear_in_the_load_at_a_fixed_contact(factor):
    one = {0: sp.csr_matrix(np.arange(28.0).reshape(4, 7))}
    many = {0: factor * one[0]}
    agrees("stress at a gauge, Pa", passing(many)[1].stress, factor * passing(one)[1].stress, relative=1e-10)


@against(
    "manufactured",
    "loads in proportion",
    capability="root_stress",
    module="facegear.strength.root_stress",
)
def test_between_the_torques_solved_stress_is_a_power_of_the_torque_and_beyond_them_proportional():
    _, found = passing({0: sp.csr_matrix(np.arange(28.0).reshape(4, 7))})
    growth = found.stress[1].max() / found.stress[0].max()
    power = np.clip(np.log(growth) / np.log(3.0), 1 / 3, 1.0)
    agrees(
        "stress below the torques solved, Pa",
        found.at_torque(50.0),
        0.5 ** max(power - 0.1, 1 / 3) * found.stress[0],
        relative=1e-7,
    )
    agrees(
        "stress above the torques solved, Pa", found.at_torque(600.0), 2.0 * found.stress[1], relative=1e-7
    )
    middle = 3.0 ** (power / 2) * found.stress[0] + 3.0 ** (-power / 2) * found.stress[1]
    agrees(
        "stress between the torques solved, Pa",
        found.at_torque(100.0 * np.sqrt(3.0)),
        0.5 * middle,
        relative=1e-7,
    )


def test_tables_name_the_largest_stress_and_where_it_is():
    _, found = passing({0: sp.csr_matrix(np.arange(28.0).reshape(4, 7))})
    summary = root_tables({"pinion": found})["summary"].set_index(["torque_n_m", "fillet"])
    row = summary.loc[(300.0, "other")]
    assert row["largest_mpa"] >= 1e-6 * found.stress[1, :, 1].max()
    assert row["radius_mm"] in 1e3 * found.along
    assert summary["at_30_deg_mpa"].le(summary["largest_mpa"]).all()
    relative = summary["largest_error_mpa"] / summary["largest_mpa"]
    assert relative.tolist() == pytest.approx(ERROR[np.searchsorted(1e3 * found.along, summary["radius_mm"])])


def published(index):
    """An FZG C gear, the roll angle of its outer point of single contact, and sigma_F0 there per N/m."""
    mesh = fzg_c()
    gear = (mesh.pinion, mesh.wheel)[index]
    force = 5912.1 / 14e-3  # of the publication, N/m
    return (
        gear,
        sqrt((mesh.single_contact_radius(gear) / gear.base_radius) ** 2 - 1),
        (271.2e6, 263.2e6)[index] / force,
    )


def paper_pinion(rack_tip_radius):
    """The paper's pinion loaded high on the flank, and the standard's stress there per N/m."""
    nominal = pair_design()
    gear = SpurGear(
        teeth=23,
        module=nominal.module,
        pressure_angle=nominal.pressure_angle,
        profile_shift=0.0,
        tip_radius=nominal.pinion_tip_radius,
        width=0.03,
        rack_addendum=1.25,
        rack_tip_radius=rack_tip_radius,
    )
    roll = 0.85 * nominal.pinion_tip_roll
    form = root_form(gear, gear.base_radius * sqrt(1 + roll**2))
    return gear, roll, cos(gear.pressure_angle) / gear.module * form.form_factor * form.stress_correction


@against(
    "external source",
    "ISO 6336-3, sigma_F0 of the nominal load; published for the FZG C gears",
    capability="root_stress",
    module="facegear.contact.root_gauges",
)
@pytest.mark.parametrize(
    "tooth",
    [lambda: paper_pinion(0.1), lambda: paper_pinion(0.25), lambda: published(0), lambda: published(1)],
    ids=["rack tip of 0.1 modules", "of 0.25 modules", "FZG C pinion", "FZG C wheel"],
)
def test_spur_teeth_in_plane_strain_agree_with_the_standard(tooth):
    """Finite elements over sigma_F0 of ISO 6336-3, of the FZG gears as it is published, thick rim."""
    gear, roll, standard = tooth()
    ratio = root_tension(slab_design(gear), roll) / standard
    agrees("largest tension over the standard's", ratio, 1.0, absolute=0.1)
    assert ratio < 1.05


def vtu_arrays(path):
    """Arrays of a .vtu by name, read as VTK's description of the format has it: base64, its length first."""
    kinds = {
        "Float64": np.float64,
        "Int64": np.int64,
        "UInt32": np.uint32,
        "UInt8": np.uint8,
        "Int32": np.int32,
    }
    found = {}
    for array in ElementTree.parse(path).getroot().iter("DataArray"):
        content = base64.b64decode(array.text.strip())
        assert np.frombuffer(content[:4], np.uint32)[0] == len(content) - 4
        found[array.get("Name")] = np.frombuffer(content[4:], kinds[array.get("type")])
    return found


def test_the_file_for_paraview_holds_points_quadrilaterals_and_stress(tmp_path):
    _, root = passing({0: sp.csr_matrix(np.arange(28.0).reshape(4, 7))})
    position = np.random.default_rng(2).normal(size=(*GRID, 3))
    both = {"pinion": root, "face_gear": root}
    points, cells, message = stress_surface(root_arrays([both], ALIKE, [dict.fromkeys(both, position)]))
    write_vtu(tmp_path / "stress.vtu", points, cells, message)
    stored = vtu_arrays(tmp_path / "stress.vtu")
    np.testing.assert_array_equal(stored["Points"].reshape(-1, 3), points)
    np.testing.assert_array_equal(stored["connectivity"].reshape(-1, 4), cells["quad"])
    np.testing.assert_array_equal(stored["offsets"], 4 * np.arange(1, len(cells["quad"]) + 1))
    assert (stored["types"] == 9).all()  # VTK_QUAD
    for name, values in message.items():
        np.testing.assert_array_equal(stored[name], values)


def test_surface_for_paraview_shows_the_largest_and_smallest_stress_of_every_gauge():
    _, root = passing({0: sp.csr_matrix(np.arange(28.0).reshape(4, 7))})
    position = np.random.default_rng(2).normal(size=(*GRID, 3))
    both = {"pinion": root, "face_gear": root}
    arrays = root_arrays([both], ALIKE, [{"pinion": position, "face_gear": 2 * position}])
    points, cells, message = stress_surface(arrays)
    assert len(points) == 2 * np.prod(GRID)
    assert len(cells["quad"]) == 2 * 2 * (GRID[1] - 1) * (GRID[2] - 1)
    np.testing.assert_array_equal(message["body"], np.repeat([0.0, 1.0], np.prod(GRID)))
    for name, found in (("largest", root.stress.max(axis=1)), ("smallest", root.stress.min(axis=1))):
        on_gear = message[f"{name}_pa_at_300_n_m"][message["body"] == 1].reshape(GRID)
        np.testing.assert_array_equal(on_gear, found[1])
    corners = points[cells["quad"][0]]
    np.testing.assert_array_equal(corners, position[0][[0, 1, 1, 0], [0, 0, 1, 1]])
