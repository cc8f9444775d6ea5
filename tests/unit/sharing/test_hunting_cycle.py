"""Quasi-static load sharing over the hunting cycle: length, balance, slow limit of the dynamics."""

from dataclasses import replace

import numpy as np
import pytest
from lumped_machines import make_layout, make_machine
from references import against, agrees

from facegear.machine.imperfections import Runout, perfect
from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.layout import Role
from facegear.machine.torques import balanced_torques
from facegear.motion.plan import Settings
from facegear.motion.steady_state.simulate import simulate
from facegear.sharing import sensitivity
from facegear.sharing.hunting import (
    bearing_table,
    cycle_table,
    group_table,
    hunting_cycle,
    hunting_length,
    mesh_table,
)
from facegear.sharing.sensitivity import bearing_scan, sensitivities

LAYOUT = make_layout(kinematics=GEOMETRIC)


def machine_with(torque=1500.0, **errors):
    flaws = replace(perfect(LAYOUT), **errors)
    return make_machine(LAYOUT, torque, tail_share=0.05, error=4e-6, imperfections=flaws)


RUNOUTS = {"pinion_runout": (Runout(8e-6, 0.4),) * 5, "gear_runout": (Runout(15e-6, 1.0),) * 2}
CONSTANT = {
    "error": 1e-6 * np.array([4.0, -3, 6, 0, 2, -5, 1, 3, 0, -2]),
    "position": 1e-6 * np.array([[3.0, 2], [-4, 1], [0, 5], [6, -2], [1, 1]]),
}


@against(
    "analytic",
    "least common multiple of the tooth numbers",
    capability="hunting",
    module="facegear.sharing.hunting",
)
def test_the_pattern_repeats_after_the_teeth_in_common():
    agrees("mesh cycles without runout", hunting_length(machine_with(**CONSTANT)), 1)
    agrees(
        "mesh cycles with pinions that run out",
        hunting_length(machine_with(pinion_runout=RUNOUTS["pinion_runout"])),
        23,
    )
    agrees(
        "mesh cycles with gears that run out",
        hunting_length(machine_with(gear_runout=RUNOUTS["gear_runout"])),
        143,
    )
    agrees("mesh cycles of the hunting cycle", hunting_length(machine_with(**RUNOUTS)), 23 * 143)
    whole = machine_with(gear_pitch={1: np.zeros(143)}, pinion_pitch={0: np.zeros(23)})
    agrees("mesh cycles with pitch deviations", hunting_length(whole), 3289)


def test_paths_that_carry_nothing_have_no_ratio_and_a_mesh_load_factor_of_zero():
    """At a small torque no idler's backlash closes: the run ended in figures that could not read this."""
    idle = make_machine(LAYOUT, 100.0, tail_share=0.0, error=0.0)
    found = hunting_cycle(idle, 2)
    groups = group_table(found).set_index("kind")
    assert groups.loc["idlers", "k_gamma"] == 0.0 and np.isnan(groups.loc["idlers", "group_ratio"])
    meshes = mesh_table(found)
    idlers = meshes[meshes["mesh"].str.contains("idler/")]
    assert (idlers["open_fraction"] == 1.0).all() and (idlers["drive_fraction"] == 0.0).all()


def test_meshes_without_an_even_share_have_no_mesh_load_factor_in_tables(monkeypatch):
    """An engine that is out gives no torque to share: it works as an idler, of no nominal load."""
    layout = make_layout((("out", Role.INPUT, 0.0), ("idler", Role.IDLER, 35.5)), kinematics=GEOMETRIC)
    torques = balanced_torques(layout, np.zeros(2), -800.0)
    machine = replace(make_machine(layout, 1.0, 0.0), torques=torques)
    groups = group_table(hunting_cycle(machine, 2))
    assert groups["k_gamma"].isna().all() and groups["group_ratio"].notna().all()
    monkeypatch.setattr(sensitivity, "BEARINGS", np.array([1e8]))
    assert bearing_scan(machine).empty


@against(
    "analytic",
    "balance of torques",
    capability="hunting",
    module="facegear.sharing.hunting",
)
def test_the_hunting_cycle_balances_every_torque_to_rounding():
    run = hunting_cycle(machine_with(bearing_clearance=np.full(5, 20e-6), **RUNOUTS, **CONSTANT), 16, 100)
    agrees("residual of the statics, relative", run.at_rest.residual.max(), 0.0, absolute=1e-12)
    net = run.at_rest.forces.reshape(len(run.cycles), 2, 5).sum(axis=1)
    torques = np.broadcast_to(run.machine.torques[:5], net.shape)
    agrees(
        "torque of a pinion, N m",
        net * LAYOUT.pinion_arm,
        torques,
        relative=1e-7,
        absolute=2e-12 * np.abs(torques).max(),
    )


def unloaded_part(seed):
    """A random machine between stiff bearings without tail torque, whose gears run out: idlers are free."""
    random = np.random.default_rng(seed)
    count = int(random.integers(2, 8))
    angles = np.sort(random.choice(np.arange(0, 286, 12), count, replace=False)) / 2
    roles = [Role.INPUT, *(Role.INPUT if random.random() < 0.5 else Role.IDLER for _ in range(count - 1))]
    places = tuple(
        (f"p{i}", role, float(angle)) for i, (role, angle) in enumerate(zip(roles, angles, strict=True))
    )
    bearings = 10.0 ** random.uniform(8, 11), 10.0 ** random.uniform(9, 12)
    layout = make_layout(places, pinion_bearing=bearings[0], gear_bearing=bearings[1], kinematics=GEOMETRIC)
    runout = tuple(Runout(random.uniform(5e-6, 4e-5), random.uniform(0.0, 6.28)) for _ in range(2))
    position = random.normal(0.0, 1e-5, (count, 2)) * (seed % 2)
    flaws = replace(perfect(layout), gear_runout=runout, position=position)
    torque, backlash = random.uniform(100.0, 2000.0), random.uniform(5e-5, 2e-4)
    return make_machine(layout, torque, 0.0, backlash=backlash, error=0.0, imperfections=flaws)


@pytest.mark.parametrize("seed", range(20))
def test_free_idlers_between_stiff_bearings_come_to_rest_to_rounding_in_every_position(seed):
    """A flank that closes by less than its place can be told once kept the search where it was."""
    found = hunting_cycle(unloaded_part(seed), 8).at_rest
    assert (found.residual <= 2e-13).all()


@against(
    "analytic",
    "a sine of pitch deviations is an eccentric gear",
    capability="hunting",
    module="facegear.sharing.hunting",
)
def test_a_pitch_curve_that_is_a_runout_gives_the_runouts_shares():
    """A gear's teeth displaced by e sin(angle) along the pitch circle are an eccentric gear."""
    eccentric = hunting_cycle(machine_with(gear_runout=(Runout(), Runout(15e-6, 0.0))), 4)
    teeth = np.arange(143)
    curve = 15e-6 * np.sin(2.0 * np.pi * teeth / 143)
    pitched = hunting_cycle(machine_with(gear_pitch={1: curve}), 4)
    whole = slice(None, None, 4)
    agrees(
        "mesh force, N",
        pitched.at_rest.forces[whole],
        eccentric.at_rest.forces[whole],
        relative=1e-7,
        absolute=1e-3 * eccentric.loads.max(),
    )


@against(
    "analytic",
    "periodicity of the hunting cycle",
    capability="hunting",
    module="facegear.machine.statics",
)
def test_the_same_pattern_returns_after_the_hunting_cycle():
    from facegear.machine.statics import equilibria

    machine = machine_with(**RUNOUTS)
    first = equilibria(machine, np.array([0.3, 11.7])).flank_forces
    again = equilibria(machine, np.array([0.3, 11.7]) + 3289).flank_forces
    agrees("flank force, N", first, again, relative=1e-9, absolute=1e-9 * first.max())


def test_statics_is_the_slow_limit_of_the_dynamics():
    machine = machine_with(**CONSTANT)
    samples = 32
    still = hunting_cycle(machine, samples).at_rest.forces
    gaps = []
    for speed in (320.0, 80.0):
        settings = Settings(samples=samples, dwell=2, settle=2, window=1, refine=False)
        response = simulate(machine, speed, settings)
        moving = response.forces[: response.per_period : response.per_period // samples]
        gaps.append(np.abs(moving - still).max() / np.abs(still).max())
    assert gaps[1] < 1e-3 and gaps[1] < 0.5 * gaps[0]


@against(
    "analytic",
    "balance of axial and tangential forces",
    capability="hunting",
    module="facegear.sharing.hunting",
)
def test_tables_tell_loads_factors_and_bearings_of_every_part():
    run = hunting_cycle(machine_with(**CONSTANT), 8)
    meshes, groups, bearings = mesh_table(run), group_table(run), bearing_table(run)
    assert list(meshes["mesh"]) == list(LAYOUT.mesh_names)
    assert list(bearings["body"]) == list(LAYOUT.body_names)
    assert (
        meshes["drive_fraction"] + meshes["back_fraction"] + meshes["open_fraction"]
    ).to_numpy() == pytest.approx(1)
    inputs = groups[groups["kind"] == "inputs"]
    assert ((inputs["largest"] >= 1.0) & (inputs["largest"] <= 2.0)).all()
    mean = cycle_table(run).drop(columns="cycle").to_numpy()[0]
    np.testing.assert_allclose(mean, meshes["mean_n"])
    # All axial and tangential forces on the bearings come from the torques' meshes and close in themselves.
    agrees(
        "sum of the axial bearing forces, N",
        bearings["mean_z_n"].sum(),
        -bearings["mean_y_n"][:5].sum(),
        relative=1e-9,
    )


def test_sharing_falls_with_torque_and_floats_only_with_true_signs():
    factors = [group_table(hunting_cycle(machine_with(t), 4))["k_gamma"].max() for t in (1500.0, 6000.0)]
    assert factors[1] < factors[0]
    scan = bearing_scan(machine_with(**CONSTANT)).set_index(["kinematics", "varied", "kind"])["k_gamma"]
    assert np.ptp(scan["printed", "inputs", "inputs"]) < 1e-9
    soft_to_stiff = scan["geometric", "inputs", "inputs"].to_numpy()
    assert (np.diff(soft_to_stiff) > -1e-9).all() and soft_to_stiff[-1] > soft_to_stiff[0] + 0.3


@against(
    "analytic",
    "a pinion out of place closes a mesh by twice its normal part",
    capability="hunting",
    module="facegear.sharing.sensitivity",
)
def test_a_sensitivity_is_the_closed_forms_slope():
    """Between held gears K = 1 + |F_u - F_l| / (F_u + F_l) and d(F_u - F_l)/dm = k / (1 + 2 k / k_in)."""
    table = sensitivities(hunting_cycle(machine_with(6000.0))).set_index(["error", "group"])["per_um"]
    own = abs(table["error right input/lower", "right input"])
    total = 6000.0 / LAYOUT.pinion_arm
    closed = 1e-6 * 4.1e8 / (1.0 + 2.0 * 4.1e8 / 6.5e7) / total
    assert 0.3 * closed < own < 1.2 * closed
    agrees(
        "slope of K_gamma, 1/um",
        table["position x right input", "right input"],
        2.0 * np.cos(np.radians(25)) * table["error right input/lower", "right input"],
        relative=1e-3,
    )
