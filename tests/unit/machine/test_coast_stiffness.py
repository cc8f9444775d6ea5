"""Linear laws whose coast flanks have a stiffness of their own, given or from their own contact."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from lumped_machines import make_layout, make_machine

import facegear
from facegear.errors import FacegearError
from facegear.harmonics import Harmonics
from facegear.machine.flanks import flank_law
from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.layout import Role, Side
from facegear.machine.loaded_contacts import forces_by_active_sets
from facegear.machine.statics import equilibria, mean_equilibrium
from facegear.machine.torques import balanced_torques
from facegear.meshing.stiffness_request import StiffnessRequest
from facegear.meshing.stiffness_source import (
    flank_series,
    series_of,
    stiffness_from_contact,
)

DRIVE = Harmonics(np.array([0.0, 3e7, 0.0]), np.array([4e8, -2e7, 1e7]))
COAST = Harmonics(np.array([0.0, -1e7, 2e7]), np.array([3e8, 4e7, 0.0]))
CYCLES = np.array([0.0, 0.13, 0.4, 0.77])
GIVEN = [
    {"order": 0, "cos_n_per_m": 3.0e8},
    {"order": 1, "sin_n_per_m": 1.0e7, "cos_n_per_m": 2.0e7},
]
GEOMETRIC_MACHINE = {
    "transmission.mesh_kinematics": "geometric",
    "transmission.pinion.base_radius_mm": None,
    "transmission.face_gear.mesh_radius_mm": None,
}


def one_pinion(torque, flanks):
    layout = make_layout(places=(("in", Role.INPUT, 0.0),), sides=(Side.UPPER,), kinematics=GEOMETRIC)
    machine = make_machine(layout, torque=500.0, tail_share=0.0, error=0.0)
    torques = balanced_torques(layout, np.array([torque]))
    return replace(machine, torques=torques, stiffness=DRIVE, flank_stiffness=flanks)


def test_a_machine_that_turns_back_is_the_mirror_image_of_one_whose_flanks_have_changed_places():
    back = equilibria(one_pinion(-500.0, ((DRIVE, COAST),)), CYCLES)
    ahead = equilibria(one_pinion(500.0, ((COAST, DRIVE),)), -CYCLES)
    np.testing.assert_allclose(back.flank_forces, ahead.flank_forces[:, ::-1], rtol=1e-9, atol=1e-6)
    np.testing.assert_allclose(back.deflections, -ahead.deflections, rtol=1e-9)
    alike = equilibria(one_pinion(-500.0, None), CYCLES)
    assert np.abs(back.deflections / alike.deflections - 1.0).max() > 0.1


def test_each_flank_has_its_own_series_seen_in_the_mirror_on_the_coast_side():
    machine = one_pinion(500.0, ((DRIVE, COAST),))
    slopes = flank_law(machine).slope(CYCLES, np.full((4, 2), 1e-6))
    np.testing.assert_allclose(slopes, np.column_stack([DRIVE(CYCLES), COAST(-CYCLES)]), rtol=1e-12)
    np.testing.assert_array_equal(machine.mean_flank_stiffness, [4e8, 3e8])
    same = flank_law(one_pinion(500.0, ((DRIVE, DRIVE),))).slope(CYCLES, np.full((4, 2), 1e-6))
    assert np.array_equal(same, flank_law(one_pinion(500.0, None)).slope(CYCLES, np.full((4, 2), 1e-6)))


def test_statics_of_few_springs_know_the_stiffness_of_the_flank_that_is_closed():
    machine = one_pinion(-500.0, ((DRIVE, COAST),))
    quick = forces_by_active_sets(machine)
    np.testing.assert_allclose(quick, mean_equilibrium(machine).flank_forces[0], rtol=1e-9, atol=1e-6)


def table_of(series, scale=1.0):
    positions = np.arange(16) / 16
    values = scale * series(positions)
    rows = {"torque_n_m": 500.0, "position": positions, "interference_um": 0.0}
    return pd.DataFrame({**rows, "k_average_n_per_m": values, "k_local_n_per_m": values})


@pytest.mark.parametrize("source", ["fem", "fem_scaled"])
def test_contact_gives_each_flank_the_series_of_its_own_table_and_one_scale(source):
    ltca = table_of(DRIVE).assign(unloaded_ste_um=0.0)
    flanks = pd.concat(
        [
            table_of(COAST).assign(gear="upper", flank="back"),
            table_of(COAST, 1.1).assign(gear="lower", flank="drive"),
        ]
    )
    zeros = Harmonics(np.zeros(1), np.zeros(1))
    request = StiffnessRequest(source, 2e8, 500.0, "average", 4, 1.0, zeros)
    stiffness = stiffness_from_contact(ltca, request, flanks)
    by_gear = flank_series(stiffness.harmonics)
    (lower_drive, lower_back), (upper_drive, upper_back) = by_gear["lower"], by_gear["upper"]
    scale = 0.5 if source == "fem_scaled" else 1.0
    for found, expected in (
        (upper_drive, DRIVE),
        (upper_back, COAST),
        (lower_drive, COAST.scale(1.1)),
        (lower_back, DRIVE),
    ):
        np.testing.assert_allclose(found(CYCLES), scale * expected(CYCLES), rtol=1e-9)


def test_a_config_gives_coast_flanks_their_stiffness():
    base = facegear.load("config/harmonics_only.yaml").with_values(GEOMETRIC_MACHINE)
    gearbox = base.with_values({"mesh_stiffness.coast": GIVEN})
    table = gearbox.stiffness().content["harmonics"]
    _, back = flank_series(table)["lower"]
    np.testing.assert_allclose(
        back(CYCLES), 3e8 + 1e7 * np.sin(2 * np.pi * CYCLES) + 2e7 * np.cos(2 * np.pi * CYCLES)
    )
    assert flank_series(base.stiffness().content["harmonics"]) is None
    np.testing.assert_array_equal(
        series_of(table).cosine, series_of(base.stiffness().content["harmonics"]).cosine
    )
    moved, still = (each.statics().table()["force_n"] for each in (gearbox, base))
    assert np.abs(moved - still).max() > 1.0


def test_a_gear_alone_has_the_flanks_of_an_upper_one_whatever_its_name():
    places = (("in", Role.INPUT, 0.0),)
    alone, two = (make_layout(places=places, sides=sides) for sides in ((Side.LOWER,), tuple(Side)))
    assert alone.contact_gears == ("upper",)
    assert two.contact_gears == ("lower", "upper")


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"mesh_stiffness.coast": GIVEN[1:]}, r"coast\[0\].*order 0 with sin_n_per_m 0 and the mean"),
        (
            {"mesh_stiffness.coast": [GIVEN[0], GIVEN[0]]},
            r"coast\[1\]\.order = 0: must be above the order before",
        ),
        (
            {"mesh_stiffness.coast": [GIVEN[0], {"order": 1, "sin_n_per_m": 4e8}]},
            r"coast = .*so small beside the mean that k\(t\) stays positive",
        ),
        (
            {"mesh_stiffness.coast": GIVEN, "mesh_stiffness.source": "fem", "mesh_stiffness.table": []},
            r"source = .*must be harmonics, as a coast is given",
        ),
    ],
)
def test_wrong_stiffness_of_coast_flanks_is_refused_by_its_key(changes, message):
    base = facegear.load("config/harmonics_only.yaml").with_values(GEOMETRIC_MACHINE)
    with pytest.raises(FacegearError, match=message):
        base.with_values(changes)


def test_printed_kinematics_have_no_coast_flanks():
    with pytest.raises(FacegearError, match=r"mesh_stiffness\.coast = .*must be none where .*printed"):
        facegear.load("config/harmonics_only.yaml").with_values({"mesh_stiffness.coast": GIVEN})
