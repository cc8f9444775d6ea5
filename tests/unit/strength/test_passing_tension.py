"""Root stress over a passage that is only superposed where it may be the largest."""

from types import SimpleNamespace

import numpy as np
import pytest

from facegear.contact.nodal_loads import loads_by_tooth
from facegear.errors import InvalidInput
from facegear.strength.passage import PassingTension
from facegear.strength.root_stress import RootStress, down_the_fillet, root_stress

TORQUES, POSITIONS, ROWS, COLUMNS = np.array([200.0, 500.0, 1000.0]), np.arange(4) / 4, 5, 6
FLANK_ROWS, REACH, DOWN, ALONG = 4, 2, 4, 3


def flank(draw, gauges=True):
    """Contact surface and readings that are random."""
    shape = 2 * REACH + 1, 2 * DOWN * ALONG, ROWS * COLUMNS
    readings = draw.normal(size=shape) * 0.3 ** np.abs(np.arange(-REACH, REACH + 1))[:, None, None]
    return SimpleNamespace(
        side=SimpleNamespace(flank_rows=FLANK_ROWS, shape=(ROWS, COLUMNS)),
        compliance=SimpleNamespace(readings=readings),
        gauges=SimpleNamespace(tangent_angle=np.ones((2, DOWN, ALONG))) if gauges else None,
    )


def forces(draw):
    """LOAD_ARRAYS of a few teeth, with forces of either sign on some nodes at some positions."""
    size, cases = 120, len(TORQUES) * len(POSITIONS)
    case = np.sort(draw.integers(0, cases, size))
    torque = np.repeat(TORQUES, len(POSITIONS))
    return {
        "variant": np.zeros(cases, int),
        "torque_n_m": torque,
        "position": np.tile(POSITIONS, len(TORQUES)),
        "pinion_case": case,
        "pinion_tooth": draw.integers(-1, 2, size),
        "pinion_node": draw.integers(0, ROWS * COLUMNS, size),
        "pinion_force_n": torque[case] * draw.uniform(-0.2, 1.0, size),
        "nodes": np.array([ROWS * COLUMNS, 1]),
    }


def whole(given, loads) -> RootStress:
    """The stress at all gauges."""
    on_teeth = loads_by_tooth(loads, "pinion", FLANK_ROWS * COLUMNS)
    readings, angle = given.compliance.readings, given.gauges.tangent_angle
    return root_stress(readings, on_teeth, TORQUES, POSITIONS, np.arange(ALONG), angle)


@pytest.mark.parametrize("seed", range(8))
def test_the_largest_stress_is_that_of_all_gauges_superposed_at_any_torque(seed):
    draw = np.random.default_rng(seed)
    given, loads = flank(draw), forces(draw)
    found, full = PassingTension.of_flank("pinion", given).under(loads), whole(given, loads)
    for torque in (50.0, 200.0, 333.0, 500.0, 800.0, 1000.0, 1500.0):
        expected = down_the_fillet(full.at_torque(torque)).max()
        assert found(torque) == pytest.approx(expected, rel=1e-12)


def test_of_a_single_torque_stress_is_that_of_the_gauges_too():
    draw = np.random.default_rng(3)
    given, loads = flank(draw), forces(draw)
    only = loads["pinion_case"] < len(POSITIONS)
    one = {name: values[only] if name.startswith("pinion") else values for name, values in loads.items()}
    one |= {name: loads[name][: len(POSITIONS)] for name in ("variant", "torque_n_m", "position")}
    on_teeth = loads_by_tooth(one, "pinion", FLANK_ROWS * COLUMNS)
    readings, angle = given.compliance.readings, given.gauges.tangent_angle
    full = root_stress(readings, on_teeth, TORQUES[:1], POSITIONS, np.arange(ALONG), angle)
    found = PassingTension.of_flank("pinion", given).under(one)
    for torque in (100.0, 200.0, 400.0):
        assert found(torque) == pytest.approx(down_the_fillet(full.at_torque(torque)).max(), rel=1e-12)


def test_loads_of_another_flank_with_more_nodes_beside_change_nothing():
    draw = np.random.default_rng(4)
    given, loads = flank(draw), forces(draw)
    count = len(loads["variant"])
    both = loads | {name: np.tile(loads[name], 2) for name in ("torque_n_m", "position")}
    both |= {"variant": np.repeat([0, 1], count), "pinion_case": loads["pinion_case"] + count}
    both |= {"nodes": np.asarray(loads["nodes"]) + 7}
    tension = PassingTension.of_flank("pinion", given)
    for torque in (200.0, 333.0):
        assert tension.under(both, 1)(torque) == tension.under(loads)(torque)


def test_a_unit_force_makes_no_more_than_its_bound_anywhere_in_the_plane():
    given = flank(np.random.default_rng(5))
    tension = PassingTension.of_flank("pinion", given)
    for sign, bounds in zip((-1.0, 1.0), tension.bounds, strict=True):
        stress = sign * np.moveaxis(tension.readings, -1, 1)
        every = np.maximum(stress.max(axis=-2), down_the_fillet(stress).max(axis=-2))
        assert (every.reshape(bounds.shape) <= bounds + 1e-12).all()
        assert bounds.min() >= 0.0


def test_fillets_without_gauges_have_no_stress():
    with pytest.raises(InvalidInput):
        PassingTension.of_flank("pinion", flank(np.random.default_rng(0), gauges=False))
