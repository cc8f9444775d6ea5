"""e(t) from contact: the series of the unloaded pair, zero where nothing is unloaded unevenly."""

import numpy as np
import pandas as pd
import pytest
from references import against, agrees

import facegear
from facegear.build.machine import MachineInputs
from facegear.build.plans import stiffness_request
from facegear.meshing.stiffness_source import stiffness_from_contact, stiffness_given, unloaded_error
from facegear.motion.plan import Settings
from facegear.motion.steady_state.simulate import simulate
from facegear.report.machine import machine_chapter
from facegear.schema.base import parse
from facegear.schema.stiffness import MeshStiffness

POSITIONS = np.arange(32) / 32
VALUES = facegear.example().with_values({"transmission.transmission_error": "from_contact"}).values


def contact_table(unloaded_um, swing):
    torque, position = (grid.ravel() for grid in np.meshgrid([300.0, 600.0], POSITIONS, indexing="ij"))
    average = 4e8 * (1.0 + swing * np.cos(2 * np.pi * position))
    columns = {"torque_n_m": torque, "position": position, "unloaded_ste_um": np.tile(unloaded_um, 2)}
    return pd.DataFrame(columns | {"k_average_n_per_m": average, "k_local_n_per_m": 1.3 * average})


def found_for(unloaded_um, kept=4, swing=0.1):
    section = parse(MeshStiffness, {"source": "fem", "torque_n_m": 600.0, "harmonics_kept": kept})
    return stiffness_from_contact(contact_table(unloaded_um, swing), stiffness_request(section))


def curve(positions):
    return 3.0 * np.cos(2 * np.pi * positions + 0.4) + 0.7 * np.sin(6 * np.pi * positions)


@against(
    "manufactured",
    "an unloaded error of two harmonics",
    capability="stiffness",
    module="facegear.meshing.stiffness_source",
)
def test_the_series_is_the_unloaded_error_without_its_mean():
    series = unloaded_error(found_for(curve(POSITIONS) - 44.8).harmonics)
    fine = np.linspace(0.0, 1.0, 101)
    agrees("unloaded transmission error, um", 1e6 * series(fine), curve(fine), relative=1e-7, absolute=1e-12)


def test_a_constant_error_is_exactly_zero_and_the_report_says_so():
    found = found_for(np.full(32, -44.8236) + 1e-6 * curve(POSITIONS))
    series = unloaded_error(found.harmonics)
    assert not series.sine.any() and not series.cosine.any()
    text = machine_chapter(VALUES, {"harmonics": found.harmonics}).text
    assert "Transmission error from contact, unloaded: constant, so e(t) from contact is zero." in text
    moving = machine_chapter(VALUES, {"harmonics": found_for(curve(POSITIONS)).harmonics}).text
    assert "unloaded: 5.74 µm peak to peak, the 4 orders kept" in moving


def test_given_harmonics_bring_no_error_of_a_pair():
    table = [{"order": 0, "cos_n_per_m": 4e8}]
    section = parse(MeshStiffness, {"source": "harmonics", "table": table})
    assert unloaded_error(stiffness_given(stiffness_request(section)).harmonics) is None


def test_what_the_orders_kept_miss_is_reported():
    step = np.where(POSITIONS < 0.25, 5.0, 0.0)
    table = found_for(step, kept=3).harmonics
    missed = np.abs(1e6 * unloaded_error(table)(POSITIONS) - (step - step.mean())).max()
    assert table["e_truncation_error_um"].iloc[0] == pytest.approx(missed, rel=1e-9)


def test_the_error_of_the_pair_drives_a_machine_that_would_stand_still_without():
    machine = MachineInputs.of_config(VALUES, found_for(curve(POSITIONS), swing=0.0).harmonics).build()
    np.testing.assert_allclose(1e6 * machine.error(POSITIONS), curve(POSITIONS), atol=1e-12)
    quiet = MachineInputs.of_config(VALUES, found_for(np.full(32, -3.0), swing=0.0).harmonics).build()
    driven, still = (
        np.ptp(simulate(one, 1000.0, Settings(tolerance=1e-8)).deflections, axis=0).max()
        for one in (machine, quiet)
    )
    assert driven > 1e-6 > 1e3 * still
