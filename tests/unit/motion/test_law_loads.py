"""Where forces of meshes lie in the table of their law: each against the flank that carries it."""

import numpy as np
import pandas as pd
import pytest
from references import against, agrees

from facegear.motion.sweeps.sweep_tables import PER_MESH
from facegear.pipeline.stages.motion import law_loads

LEVELS = pd.DataFrame(
    [("upper", "drive", 10e3), ("upper", "drive", 30e3), ("upper", "back", 20e3), ("lower", "drive", 8e3)]
    + [("lower", "back", 25e3)],
    columns=["gear", "flank", "force_n"],
)


def swept(rows, motion="period-1"):
    found = pd.DataFrame(rows, columns=["quantity", "body_or_mesh", "value"])
    return found.assign(**{"class": motion})


def table(meshes, summary=(("residual", "machine", 0.0),), sweep=()):
    """Loads of meshes whose forces have their extremes between two samples."""
    cycles = np.arange(32) / 32
    wave = np.cos(2 * np.pi * (cycles + 1 / 64))
    forces = [
        pd.DataFrame({"mesh_cycle": cycles, "mesh": name, "elastic_force_n": mean + size * wave})
        for name, mean, size in meshes
    ]
    return law_loads(LEVELS, pd.concat(forces), swept(summary), swept(sweep))


@against(
    "manufactured",
    "forces of given mean and amplitude",
    capability="law_loads",
    module="facegear.motion.response_tables",
)
def test_a_mesh_is_set_beside_the_last_level_of_the_flank_that_carries_it():
    found = table([("input/upper", 24e3, 2e3), ("idler/lower", -6e3, 5e2)]).content["loads"]
    assert found["flank"].to_list() == ["drive", "back"]
    agrees("force at the last level, N", found["last_level_n"], [30e3, 25e3], relative=1e-15)
    agrees("mean force, N", found["mean_n"], [24e3, 6e3], relative=1e-12)
    agrees("smallest force, N", found["smallest_n"], [22e3, 5.5e3], relative=1e-6)
    agrees("largest force, N", found["largest_n"], [26e3, 6.5e3], relative=1e-6)


def test_what_lies_past_the_table_is_the_largest_fraction_of_the_sweep():
    sweep = [
        ("largest_elastic_force_n", "input/lower", 31e3),
        ("largest_elastic_force_n", "input/lower", 29e3),
        ("past_law_fraction", "input/lower", 0.25),
        ("past_law_fraction", "input/lower", 0.0),
    ]
    assert "largest_elastic_force_n" in PER_MESH
    found = table([("input/lower", 24e3, 2e3), ("input/upper", 1e3, 0.0)], sweep=sweep)
    first, second = found.content["loads"].itertuples()
    assert (first.sweep_largest_n, first.sweep_past_fraction, first.past_fraction) == (31e3, 0.25, 0.0)
    assert second.sweep_past_fraction == 0.0
    assert "past it for up to 25 % of the time" in found.summary


@pytest.mark.parametrize("side", ["upper", "lower"])
def test_one_gear_alone_has_the_table_of_the_upper(side):
    found = table([(f"input/{side}", 24e3, 2e3), (f"output/{side}", 9e3, 2e3)]).content["loads"]
    assert found["last_level_n"].to_list() == [30e3, 30e3]
