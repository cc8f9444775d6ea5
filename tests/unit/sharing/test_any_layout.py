"""Any layout that the schema accepts goes through modes, dynamics and load sharing to its tables."""

from math import atan, degrees
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, example, given, settings
from hypothesis import strategies as st

from facegear.build.cases import expand_cases
from facegear.build.config import Config
from facegear.build.load import load_config
from facegear.build.machine import MachineInputs
from facegear.build.plans import settings as accuracy
from facegear.build.plans import sharing_options
from facegear.machine.loaded_modes import frequency_table, shape_table, vibrating_machine
from facegear.machine.modes import name_modes
from facegear.motion.response_tables import response_table
from facegear.schema.base import parse
from facegear.schema.motion import Dynamics, LoadSharing
from facegear.schema.stiffness import MeshStiffness, given_series
from facegear.sharing import reference
from facegear.sharing.groups import split_groups
from facegear.sharing.reference import REFERENCE_COLUMNS, SPEED_COLUMNS, reference_table, speed_range_table
from facegear.sharing.run import load_sharing
from facegear.sharing.tables import (
    CURVE_COLUMNS,
    NOMINAL,
    SUMMARY_COLUMNS,
    collect_tables,
    curve_table,
    summary_table,
)

CONFIG = Path(__file__).parents[3] / "config" / "harmonics_only.yaml"
SHORT = {"dwell_periods": 16, "settle_periods": 16, "window_periods": 16, "extensions": 0}
TEETH = 143
APART = degrees(2 * atan(23 / TEETH)) + 360.0 / TEETH


@pytest.fixture(scope="module", autouse=True)
def _few_positions():
    """Four positions of the mesh cycle at rest instead of 64: whether they run, not how fine they are."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(reference, "POSITIONS", 4)
        yield


def values(places, gears, tail_share):
    own = load_config(CONFIG).model_dump(mode="json")
    own["transmission"] |= {"pinions": places, "face_gears": gears}
    own["transmission"]["torque"] = {"per_input_n_m": 500.0, "tail_share": tail_share}
    own["dynamics"]["accuracy"] |= SHORT
    own["load_sharing"] |= {"cycles": 20, "starts": 2, "samples_per_cycle": 32, "quasi_static_rpm": 500.0}
    own["load_sharing"]["speed_range"] |= {"from_rpm": 3000.0, "points": 2}
    return parse(Config, own).model_dump(mode="json")


def chain(own):
    """Modes, nominal response, load sharing: what the stages of the workflow compute and write."""
    (case,) = expand_cases(parse(Config, own)).values()
    machine = MachineInputs.of_config(
        case, given_series(parse(MeshStiffness, case["mesh_stiffness"]))
    ).build()
    vibrating = vibrating_machine(machine)
    modes = vibrating.modes
    frequencies = frequency_table(vibrating, name_modes(machine.layout, machine.linear, modes))
    assert len(frequencies) == 4 * len(machine.layout.bodies)
    assert len(shape_table(machine.linear.labels, modes)) == len(frequencies) ** 2
    settings = accuracy(parse(Dynamics, case["dynamics"]).accuracy)
    options = sharing_options(parse(LoadSharing, case["load_sharing"]))
    sharing = load_sharing(machine, case["dynamics"]["speed_rpm"], settings, options)
    assert len(response_table(machine.layout, sharing.response))
    tables = {
        CURVE_COLUMNS: curve_table(sharing),
        SUMMARY_COLUMNS: summary_table(sharing),
        REFERENCE_COLUMNS: reference_table(machine, settings, options),
        SPEED_COLUMNS: speed_range_table(machine, settings, options),
    }
    for columns, table in tables.items():
        assert tuple(table.columns) == columns
    groups = split_groups(machine.layout)
    found = collect_tables({(NOMINAL, NOMINAL): tables[SUMMARY_COLUMNS]})
    assert found["group"].to_list() == [group.name for group in groups]
    return sharing, found


@pytest.mark.parametrize(
    ("roles", "gears"),
    [(["input"], ["upper"]), (["input"], ["lower"]), (["input", "idler", "input"], ["upper"])],
)
def test_where_no_meshes_share_a_load_the_tables_have_no_rows(roles, gears):
    """The plainest machines ended in `No objects to concatenate`, after all the contact work."""
    places = [{"name": f"{i}", "role": role, "angle_deg": 90.0 * i} for i, role in enumerate(roles)]
    sharing, found = chain(values(places, gears, 0.0))
    assert found.empty
    assert np.isfinite(sharing.response.forces).all()


OWN_TORQUES = {True: [None, None, -50.0], False: [None, None, 0.0, -50.0]}
"""Torques of inputs and of other pinions: inputs that bring nothing would leave the machine without load."""


@st.composite
def layouts(draw):
    count = draw(st.integers(1, 8))
    roles = [draw(st.sampled_from(["input", "idler", "tail"])) for _ in range(count)]
    if "input" not in roles:
        roles[0] = "input"
    free = 360.0 / count - APART
    gears = draw(st.sampled_from([["upper"], ["lower"], ["lower", "upper"]]))
    angles = [360.0 * i / count + draw(st.floats(0.0, free)) for i in range(count)]
    if len(gears) == 2:  # between two gears the teeth fit at whole pitches from the first pinion
        angles = [int(angle * TEETH / 360.0) * 360.0 / TEETH for angle in angles]
    places = [
        {
            "name": f"p{i}",
            "role": role,
            "angle_deg": angles[i],
            "torque_n_m": draw(st.sampled_from(OWN_TORQUES[role == "input"])) if i else None,
        }
        for i, role in enumerate(roles)
    ]
    return places, gears, draw(st.sampled_from([0.0, 0.3])) if "tail" in roles else 0.0


@settings(
    max_examples=4,
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow],
    phases=[Phase.explicit, Phase.reuse, Phase.generate],
)
@example(
    (
        [
            {"name": "p0", "role": "input", "angle_deg": 128.962295982284, "torque_n_m": None},
            {"name": "p1", "role": "input", "angle_deg": 330.5954349305716, "torque_n_m": None},
        ],
        ["upper"],
        0.0,
    )
).via("the line search of the static equilibrium ended in a RuntimeError of scipy")
@given(layouts())
def test_any_layout_runs_to_its_tables(layout):
    sharing, found = chain(values(*layout))
    assert np.isfinite(sharing.response.forces).all()
    means = found["mean"].dropna()
    assert (means >= 1.0 - 1e-9).all() and (means <= 8.0).all()
