"""Root stress: superposition over teeth and loads, and the spur pinion against ISO 6336-3."""

from dataclasses import replace
from math import cos

import numpy as np
import pytest
import scipy.sparse as sp
from contact_bodies import STEEL, pair_design
from hypothesis import given
from hypothesis import strategies as st

from facegear.contact.bodies.compliance import flank_compliance
from facegear.contact.bodies.surface import interpolation
from facegear.contact.options import Refinement
from facegear.contact.root_gauges import root_gauges
from facegear.contact.teeth import elastic_tooth
from facegear.geometry import pinion
from facegear.mesh.sizes import named_sizes
from facegear.strength.dynamic_stress import dynamic_stress_table
from facegear.strength.root_form import root_form
from facegear.strength.root_stress import root_stress
from facegear.strength.root_tables import root_tables
from facegear.strength.spur import SpurGear
from facegear.validation.contact.twin import slab_tooth

TORQUES, POSITIONS = np.array([100.0, 300.0]), np.array([0.0, 0.5])
GRID = (2, 4, 3)


def passing(loads):
    """Root stress by readings on five teeth of gauges GRID from seven flank nodes."""
    readings = np.random.default_rng(1).normal(size=(5, int(np.prod(GRID)), 7))
    angle = np.broadcast_to(np.linspace(0.4, 1.2, 4)[:, None], GRID)
    found = root_stress(readings, loads, TORQUES, POSITIONS, np.linspace(0.25, 0.27, 3), angle)
    return readings, found


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
        np.testing.assert_allclose(found.stress[1, place[0]].ravel(), expected, rtol=1e-12)


@given(factor=st.floats(0.1, 10.0))
def test_root_stress_is_linear_in_the_load_at_a_fixed_contact(factor):
    one = {0: sp.csr_matrix(np.arange(28.0).reshape(4, 7))}
    many = {0: factor * one[0]}
    np.testing.assert_allclose(passing(many)[1].stress, factor * passing(one)[1].stress, rtol=1e-10)


def test_between_the_torques_solved_stress_is_interpolated_and_beyond_them_proportional():
    _, found = passing({0: sp.csr_matrix(np.arange(28.0).reshape(4, 7))})
    np.testing.assert_allclose(found.at_torque(200.0), found.stress.mean(axis=0))
    np.testing.assert_allclose(found.at_torque(50.0), 0.5 * found.stress[0])
    np.testing.assert_allclose(found.at_torque(600.0), 2.0 * found.stress[1])


def test_tables_name_the_largest_stress_and_where_it_is():
    _, found = passing({0: sp.csr_matrix(np.arange(28.0).reshape(4, 7))})
    summary = root_tables({"pinion": found})["summary"].set_index(["torque_n_m", "fillet"])
    row = summary.loc[(300.0, "other")]
    assert row["largest_mpa"] >= 1e-6 * found.stress[1, :, 1].max()
    assert row["radius_mm"] in 1e3 * found.along
    assert summary["at_30_deg_mpa"].le(summary["largest_mpa"]).all()


@pytest.mark.parametrize("rack_tip_radius", [0.1e-3 * 3.75, 0.25e-3 * 3.75])
def test_spur_pinion_in_plane_strain_agrees_with_the_standard(rack_tip_radius):
    """Finite elements over Y_F Y_S of ISO 6336-3 for a load high on the flank, thick rim."""
    nominal = pair_design()
    design = replace(nominal, pinion=replace(nominal.pinion, rack_tip_radius=rack_tip_radius, thinning=0.0))
    m, part = design.module, design.pinion
    roll = 0.85 * design.pinion_tip_roll
    tooth = slab_tooth(design, replace(named_sizes("medium", m), width=0.64 * m))
    elastic, side = elastic_tooth(design, tooth, STEEL, "right")
    held = elastic.held.copy()
    held[:, 1] = True
    gauges, rows = root_gauges(tooth, STEEL)
    plain = replace(elastic, held=held)
    found = flank_compliance(plain, Refinement(), part.teeth, 2, "ring", gauges=rows)
    at = np.interp(-roll, -side.u[: side.flank_rows, 1], np.arange(side.flank_rows))
    line = interpolation(np.array([[at, 0.0], [at, 1.0], [at, 2.0]]), side.shape).toarray()
    stress = -(found.readings[2] @ (np.array([1.0, 4.0, 1.0]) / 6.0 @ line)).reshape(
        gauges.position.shape[:3]
    )
    width = float(np.ptp(elastic.points[:, 1]))
    spur = SpurGear(
        teeth=part.teeth,
        module=m,
        pressure_angle=design.pressure_angle,
        profile_shift=part.profile_shift / m,
        tip_radius=design.pinion_tip_radius,
        width=width,
        rack_addendum=part.dedendum / m,
        rack_tip_radius=rack_tip_radius / m,
    )
    radius, _ = pinion.involute_point(design, roll)
    form = root_form(spur, float(radius))
    nominal_stress = cos(design.pressure_angle) / (width * m) * form.form_factor * form.stress_correction
    assert 0.90 < stress[0].max() / nominal_stress < 1.05


def test_running_machine_is_judged_by_the_magnitude_of_each_mesh_force():
    _, found = passing({0: sp.csr_matrix(np.arange(28.0).reshape(4, 7))})
    forces = {
        "pulsing": np.array([1000.0, 3000.0]),
        "back": np.array([-2000.0, -2000.0]),
        "open": np.zeros(2),
    }
    table = dynamic_stress_table(forces, 0.1, {"pinion": found, "face_gear": found}).set_index("mesh")
    assert table["dynamic_factor"].iloc[:2].tolist() == pytest.approx([1.5, 1.0])
    assert np.isnan(table.loc["open", "dynamic_factor"])
    assert table.loc["pulsing", "pinion_mean_mpa"] == pytest.approx(table.loc["back", "pinion_largest_mpa"])
    solved = root_tables({"pinion": found})["summary"]
    largest = solved[solved["torque_n_m"] == 300.0]["largest_mpa"].max()
    assert table.loc["pulsing", "face_gear_largest_mpa"] == pytest.approx(largest)
    assert table["within_torques_solved"].all()
    beyond = dynamic_stress_table({"high": np.array([4000.0])}, 0.1, {"pinion": found, "face_gear": found})
    assert not beyond["within_torques_solved"].any()
