"""Which resolution the benchmark calls the cheapest that is accurate enough."""

import pandas as pd
import pytest

from facegear.build.plans import contact_plan
from facegear.errors import NotConverged
from facegear.schema.contact import Contact, Mesh
from validation.contact.benchmark import cheapest, with_errors
from validation.contact.refinement_levels import CUTS, DEFAULT, FINEST, LEVELS


def measured(**rows):
    """Levels with total time (s), mean and first harmonic (N/m) at two torques."""
    parts = [
        {
            "level": level,
            "torque_n_m": torque,
            "total_s": seconds,
            "mean_n_per_m": mean * factor,
            "amplitude_1_n_per_m": harmonic * factor,
            "local_mean_n_per_m": 1.3 * mean * factor,
            "local_amplitude_1_n_per_m": harmonic * factor,
        }
        for level, (seconds, mean, harmonic) in rows.items()
        for torque, factor in ((100.0, 1.0), (600.0, 1.5))
    ]
    return pd.DataFrame(parts)


def test_cheapest_resolution_is_the_quickest_within_half_a_percent_and_three():
    table = measured(
        rough=(1.0, 4.03e8, 4.0e7), wavy=(2.0, 4.0e8, 4.2e7), good=(3.0, 4.01e8, 4.1e7), best=(9.0, 4e8, 4e7)
    )
    assert cheapest(with_errors(table, "best")) == "good"


def test_one_torque_beyond_the_limits_rules_a_resolution_out():
    table = measured(good=(3.0, 4.01e8, 4.0e7), best=(9.0, 4e8, 4e7))
    table.loc[(table["level"] == "good") & (table["torque_n_m"] == 600.0), "mean_n_per_m"] *= 1.01
    assert cheapest(with_errors(table, "best")) == "best"


def test_levels_without_an_accurate_level_is_refused():
    table = with_errors(measured(rough=(1.0, 4.1e8, 4e7), best=(9.0, 4e8, 4e7)), "best")
    with pytest.raises(NotConverged):
        cheapest(table[table["level"] == "rough"])


def test_levels_holds_the_default_and_the_finest():
    assert {DEFAULT, FINEST} <= set(CUTS)
    assert set(CUTS) < set(LEVELS)


def test_config_without_a_refinement_gets_the_default_rung():
    assert CUTS[DEFAULT] == (Mesh().resolution, contact_plan(Contact()).refinement)
