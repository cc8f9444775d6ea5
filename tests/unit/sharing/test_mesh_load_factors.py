"""The mesh load factor counts from the nominal even share of the torques, whatever is made of them."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from lumped_machines import make_layout, make_machine
from references import against, agrees

from facegear.machine.imperfections import perfect
from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.layout import Role, Side
from facegear.machine.torques import balanced_torques
from facegear.sharing.even_shares import even_shares
from facegear.sharing.hunting import group_table, hunting_cycle, mesh_table

LAYOUT = make_layout(kinematics=GEOMETRIC)
ARM = LAYOUT.pinion_arm
torques = st.floats(50.0, 5000.0)


@against(
    "analytic",
    "an engine alone on its mesh carries its own torque",
    capability="hunting",
    module="facegear.sharing.hunting",
)
def test_three_engines_of_unequal_torque_that_share_nothing_have_a_mesh_load_factor_of_one():
    places = tuple((name, Role.INPUT, 30.0 * i) for i, name in enumerate("abc"))
    layout = make_layout(places, (Side.UPPER,), kinematics=GEOMETRIC)
    given = balanced_torques(layout, np.array([400.0, 800.0, 1200.0]))
    machine = replace(make_machine(layout, 800.0, 0.0), torques=given)
    table = mesh_table(hunting_cycle(machine, 8))
    agrees("mesh load factor", table["k_gamma"], 1.0, relative=1e-9)
    agrees("torque of a mesh, N m", table["torque_n_m"], [400.0, 800.0, 1200.0], relative=1e-7)
    assert table["group_ratio"].max() == pytest.approx(1.5), "the ratio within the group has its own name"


@against(
    "analytic",
    "balance of torques with even shares, by hand",
    capability="hunting duty_loads",
    module="facegear.sharing.even_shares",
)
@given(per_input=torques, tail_share=st.floats(0.0, 0.3), lower=st.floats(-500.0, 0.0))
def test_even_shares_hold_every_body_in_balance(per_input, tail_share, lower):
    base = make_machine(LAYOUT, per_input, tail_share)
    machine = replace(base, torques=balanced_torques(LAYOUT, base.torques[:5], lower))
    shares = even_shares(machine)
    low, high = np.nan_to_num(shares.reshape(2, 5))
    inputs = np.array([False, False, True, True, False])
    passed = (2.0 * per_input / 2.0 / ARM) + lower / LAYOUT.gear_arm
    agrees("even share of an input's lower mesh, N", low[inputs], 0.5 * per_input / ARM, relative=1e-7)
    agrees("even share of an input's upper mesh, N", high[inputs], 0.5 * per_input / ARM, relative=1e-7)
    agrees("even share of an idler, N", low[~inputs], abs(passed) / 3.0, relative=1e-7)
    tail = base.torques[0] / ARM
    agrees(
        "even share at the tail, N", high[0], abs(passed / 3.0 + tail), relative=1e-7, absolute=1e-6 * passed
    )


def test_more_load_on_an_idler_is_a_larger_factor_whatever_the_others_carry():
    """With the group's own mean below it, a machine whose idlers carry more could show a better idler."""
    loose, tight = (make_machine(LAYOUT, 1328.0, 0.034, backlash=b, error=0.0) for b in (100e-6, 1e-6))
    tables = [
        mesh_table(hunting_cycle(one, 8)).set_index("mesh").loc["tail idler/lower"] for one in (loose, tight)
    ]
    assert tables[1]["mean_n"] > tables[0]["mean_n"]
    assert tables[1]["k_gamma"] > tables[0]["k_gamma"]
    assert tables[1]["group_ratio"] < tables[0]["group_ratio"]


def test_the_torque_stands_beside_every_factor():
    run = hunting_cycle(make_machine(LAYOUT, 1000.0, 0.05, imperfections=perfect(LAYOUT)), 4)
    meshes, groups = mesh_table(run), group_table(run)
    np.testing.assert_allclose(meshes["torque_n_m"], meshes["even_share_n"] * ARM)
    assert (groups["torque_n_m"] == 1000.0).all()
    assert groups["k_gamma"].max() == meshes["k_gamma"].max()
