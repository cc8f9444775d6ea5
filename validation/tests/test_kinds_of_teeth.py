"""Which teeth for which gearbox: columns that are stored follow from the pairs, and from closed forms."""

import numpy as np
import pandas as pd
import pytest

from validation.kinds_of_teeth import (
    KINDS,
    LINES,
    MODULE,
    PAIR,
    TABLE,
    TORQUE,
    friction_values,
    loaded_values,
    machine_values,
    page_table,
    pair_alone,
)

STORED = pd.read_csv(TABLE).set_index("teeth")
RADIUS = 0.5e-3 * MODULE * PAIR["pinion_teeth"]


def test_every_kind_has_its_column_on_the_page():
    assert STORED.index.tolist() == list(KINDS)
    lines = page_table(STORED.reset_index()).splitlines()
    assert len(lines) == 2 + len(LINES)
    assert all(line.count("|") == 2 + len(KINDS) for line in lines)


@pytest.mark.parametrize("kind", ["spur", "tapered, 4 deg"])
def test_stored_contact_is_that_of_the_pair(kind):
    pair = pair_alone(kind)
    for name, value in {**loaded_values(pair), **friction_values(pair)}.items():
        assert value == pytest.approx(STORED.loc[kind, name], rel=1e-5), name


def test_stored_machine_is_that_of_the_pair():
    for name, value in machine_values("tapered, 4 deg").items():
        assert value == pytest.approx(STORED.loc["tapered, 4 deg", name], rel=1e-5), name


@pytest.mark.parametrize("kind", KINDS)
def test_axial_force_of_an_input_is_that_of_the_closed_form(kind):
    helix, taper = np.radians(KINDS[kind])
    slope = np.tan(np.radians(PAIR["pressure_angle_deg"])) * np.sin(taper) - np.tan(helix) * np.cos(taper)
    assert STORED.loc[kind, "axial_input_n"] == pytest.approx(2.0 * TORQUE / RADIUS * slope, rel=1e-6)


def test_backlash_of_tapered_teeth_follows_the_place_of_the_pinion():
    taper, pressure = np.radians([KINDS["tapered, 4 deg"][1], PAIR["pressure_angle_deg"]])
    normal = 2.0 * np.sin(taper) * np.sin(pressure)  # signed sines of both base helices, added
    assert STORED.loc["tapered, 4 deg", "backlash_by_pinion_axial"] == pytest.approx(normal, rel=1e-6)
    assert (STORED["backlash_by_pinion_axial"].drop("tapered, 4 deg").abs() < 1e-9).all()


def test_a_finer_mesh_ranks_the_transmission_errors_alike():
    ranks = [STORED[name].rank() for name in ("te_peak_to_peak_um", "finer_te_peak_to_peak_um")]
    assert ranks[0].equals(ranks[1])
