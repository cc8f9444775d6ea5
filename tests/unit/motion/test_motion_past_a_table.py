"""A sweep says for what share of the time a mesh is pressed in past the last level of its law."""

from dataclasses import replace

import numpy as np
import pytest
from force_tables import power_table
from lumped_machines import make_layout, make_machine

from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.layout import Role, Side
from facegear.machine.machine import FlankTables
from facegear.motion.plan import Settings
from facegear.motion.steady_state.simulate import build_model
from facegear.motion.sweeps.sweep import collect, run_speeds
from facegear.motion.sweeps.sweep_tables import sweep_table


@pytest.mark.parametrize(("torque", "share"), [(600.0, None), (6000.0, 1.0)])
def test_a_sweep_names_the_mesh_that_is_past_its_law_and_is_silent_where_none_is(torque, share):
    layout = make_layout((("engine", Role.INPUT, 0.0),), (Side.UPPER,), kinematics=GEOMETRIC)
    table = power_table(8, 0.02, 1e-6, 6e-5, 2.4e11)
    machine = replace(make_machine(layout, torque, 0.0, error=0.0), tables=(FlankTables(table, table),))
    model = build_model(machine)
    piece = collect(model, run_speeds(model, np.array([3000.0]), Settings(), None))
    swept = sweep_table(layout, "up", piece)
    past = swept[swept["quantity"] == "past_law_fraction"]
    if share is None:
        assert past.empty
    else:
        assert past["body_or_mesh"].tolist() == list(layout.mesh_names)
        assert past["value"].tolist() == [share]
