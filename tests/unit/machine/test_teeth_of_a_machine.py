"""Contribution of single teeth to the errors of a machine's meshes, beside equivalent pitch deviations."""

from dataclasses import replace

import numpy as np
import pytest
from lumped_machines import make_layout, make_machine
from references import against, agrees

import facegear
from facegear.errors import ConfigErrors
from facegear.machine.flank_errors import slow_errors, teeth_in_mesh
from facegear.machine.imperfections import ToothErrors, perfect
from facegear.machine.kinematics import GEOMETRIC
from facegear.sharing.hunting import hunting_length

POSITIONS, EARLY = 8, 5e-6


def one_tooth(count, tooth):
    """A tooth that comes early about where it is counted, falling to nothing at its neighbours."""
    places = np.arange(count * POSITIONS) / POSITIONS
    away = np.abs((places - tooth + count / 2) % count - count / 2)
    return EARLY * np.clip(1.0 - away, 0.0, None)


@against(
    "second implementation",
    "cumulative pitch deviations of the same teeth",
    capability="hunting",
    module="facegear.machine.imperfections",
)
@pytest.mark.parametrize("body", ["pinion", "gear"])
def test_a_tooth_that_comes_early_is_met_where_its_pitch_deviation_is(body):
    layout = make_layout(kinematics=GEOMETRIC)
    count = layout.pinion_teeth if body == "pinion" else layout.gear_teeth
    flat = np.zeros(POSITIONS)
    curves = one_tooth(count, 7), flat
    pairs = {"pinion": (flat, flat), "gear": (flat, flat)} | {body: curves}
    plain = perfect(layout)
    with_teeth = make_machine(layout, imperfections=replace(plain, teeth=ToothErrors(**pairs)))
    pitch = np.zeros(count)
    pitch[7] = EARLY / np.cos(layout.pressure_angle) * (1.0 if body == "pinion" else -1.0)
    bodies = range(len(layout.pinions if body == "pinion" else layout.gears))
    deviations = replace(plain, **{f"{body}_pitch": dict.fromkeys(bodies, pitch)})
    cycles = np.arange(2 * count) / 2.0
    drive = slice(0, len(layout.meshes))
    found = slow_errors(with_teeth, cycles)[:, drive]
    expected = slow_errors(make_machine(layout, imperfections=deviations), cycles)[:, drive]
    lags = np.round(with_teeth.phases, 12) % 1.0
    aligned = []
    for mesh, lag in enumerate(lags):
        apart = float((-lag - teeth_in_mesh(layout, mesh, np.zeros(1))[body == "gear"])[0])
        aligned.append(abs(apart - round(apart)) < 1e-9)
    assert any(aligned)
    agrees("error of drive flanks, m", found[:, aligned], expected[:, aligned], absolute=1e-18)
    for mesh in range(len(layout.meshes)):
        assert found[:, mesh].min() < -0.5 * EARLY, mesh
    assert hunting_length(with_teeth) == count


def test_pitch_is_not_given_twice():
    flat = {"face_mm": [-14, 14], "profile_mm": [8, 25], "deviation_um": [[0, 0], [0, 0]]}
    grids = [{**flat, "flank": "right", "tooth": tooth} for tooth in (None, 3)]
    changes = {
        "tooth_pair.pinion.flanks": {"grids": grids},
        "transmission.single_pinions": {"tail idler": {"cumulative_pitch_um": [0.0] * 23}},
    }
    with pytest.raises(ConfigErrors, match=r"cumulative_pitch_um = .given.: must be left out"):
        facegear.example().with_values(changes)
