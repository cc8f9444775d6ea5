"""Gear ratio, torques and powers: kinematics and statics agree for any layout."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lumped_machines import make_layout, make_machine
from references import against, agrees

from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.layout import Role, Side
from facegear.machine.ratings import body_table, compute_ratings, mesh_table

ROLES = st.lists(st.sampled_from([Role.INPUT, Role.IDLER, Role.TAIL]), min_size=0, max_size=4)
SIDES = st.sampled_from([(Side.LOWER, Side.UPPER), (Side.UPPER,), (Side.LOWER,)])


def geometric(roles, sides, torque, tail_share):
    places = [(f"p{i}", role, 10.5 * i) for i, role in enumerate(roles)]
    return make_machine(
        make_layout(places, sides, kinematics=GEOMETRIC), torque=torque, tail_share=tail_share
    )


@against(
    "analytic",
    "balance of power of rigid gears",
    capability="ratings",
    module="facegear.machine.ratings",
)
@settings(max_examples=25, deadline=None)
@given(ROLES, SIDES, st.floats(10.0, 5000.0), st.floats(0.0, 0.5), st.floats(100.0, 20000.0))
def test_power_in_is_power_out_for_any_layout_of_geometric_meshes(more, sides, torque, tail_share, speed):
    machine = geometric([Role.INPUT, *more], sides, torque, tail_share)
    found = compute_ratings(machine, speed)
    assert found.power_in > 0.0
    agrees("power out less power in over power in", found.imbalance, 0.0, absolute=1e-14)
    assert found.ratio == pytest.approx(found.pinion_speed / found.gear_speed, rel=1e-14) == 143 / 23
    agrees("mesh frequency, Hz", found.mesh_frequency, 143 * found.gear_speed / 60.0, relative=1e-6)


@against(
    "analytic",
    "balance of power of every body",
    capability="ratings",
    module="facegear.machine.ratings",
)
@settings(max_examples=15, deadline=None)
@given(ROLES, SIDES, st.floats(0.0, 0.5))
def test_what_statics_send_through_the_meshes_is_what_every_body_brings_or_takes(more, sides, tail_share):
    machine = geometric([Role.INPUT, *more], sides, 800.0, tail_share)
    bodies, meshes = body_table(machine, 3000.0), mesh_table(machine, 3000.0)
    scale = bodies["power_kw"].abs().max()
    sent = meshes["power_kw"].to_numpy().reshape(len(sides), -1)
    own = bodies["power_kw"].to_numpy()
    agrees(
        "power of a pinion's meshes less its own, kW",
        sent.sum(axis=0),
        own[: sent.shape[1]],
        absolute=1e-8 * scale,
    )
    agrees(
        "power of a gear's meshes and its own, kW",
        sent.sum(axis=1) + own[sent.shape[1] :],
        0.0,
        absolute=1e-8 * scale,
    )


@against(
    "analytic",
    "tooth ratio",
    capability="ratings",
    module="facegear.machine.ratings",
)
def test_the_output_torque_is_the_sum_of_the_pinions_times_the_tooth_ratio():
    machine = geometric([Role.INPUT, Role.INPUT, Role.TAIL], (Side.LOWER, Side.UPPER), 1000.0, 0.1)
    torques = body_table(machine, 1.0).set_index("body")["torque_n_m"]
    agrees("output torque, N m", torques["upper face gear"], -0.9 * 2000.0 * 143 / 23, relative=1e-6)
    assert torques["lower face gear"] == 0.0


@against(
    "analytic",
    "ratio of the lever arms of the paper's equation 13",
    capability="ratings",
    module="facegear.machine.ratings",
)
def test_equation_13_as_printed_misses_the_balance_by_the_ratio_of_its_lever_arms():
    machine = make_machine(make_layout(), torque=1000.0, tail_share=0.0)
    layout = machine.layout
    expected = 1.0 - layout.gear_radius / layout.pinion_radius * 23 / 143
    found = compute_ratings(machine, 5000.0)
    agrees(
        "missing share of the power",
        (found.power_in - found.power_out) / found.power_in,
        expected,
        relative=1e-6,
    )
