"""One sector of a whole gear with its real teeth, and the layer that stands for them (docs/measured)."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from references import against, agrees

from facegear.parts.body_mesh import body_mesh
from validation.gear_body.cyclic_teeth import bare_sector, fourier, frequencies, second

GEARS = ("paper", "second")
RATIOS = (("fitted", "without_teeth"), ("sector", "sector_without_teeth"))
MEASURED = Path(__file__).parents[2] / "docs" / "measured" / "cyclic_teeth.csv"


def finest(gear):
    table = pd.read_csv(MEASURED)
    return table[(table["gear"] == gear) & (table["fineness"] == table["fineness"].max())]


def test_sector_without_its_tooth_has_the_frequencies_of_fourier_elements():
    """On a mesh so coarse that both are too stiff, by less than 1 %."""
    gear = second()
    sector = frequencies(bare_sector(gear, 1, 6e-3), (0, 2, 4))[:, 0]
    waves = fourier(gear, None, body_mesh(gear.section(), 1, 2.0))[[0, 2, 4]]
    assert np.abs(sector / waves - 1.0).max() < 1e-2


@against(
    "second implementation",
    "one sector of the whole gear, bricks of 27 nodes (docs/measured/cyclic_teeth.csv, `make peers`)",
    capability="gear_bodies",
    module="facegear.parts.tooth_layer",
)
@pytest.mark.parametrize(("gear", "stated"), [("paper", 0.005), ("second", 0.008)])
def test_fitted_layer_gives_a_gear_the_frequencies_of_its_real_teeth(gear, stated):
    """The second gear has other teeth, rim and web; the waves of the fit were chosen without it."""
    table = finest(gear)
    assert table["nodal_diameters"].tolist() == list(range(7))
    agrees(f"frequency of the {gear} gear, Hz", table["fitted_hz"], table["sector_hz"], relative=stated)
    # By how much the teeth lower a frequency, without what both meshes are too stiff by.
    ours, theirs = (table[f"{a}_hz"] / table[f"{b}_hz"] for a, b in RATIOS)
    agrees(f"frequency of the {gear} gear over that without teeth", ours, theirs, relative=0.006)


def test_layer_of_common_teeth_is_off_by_percents_for_teeth_that_are_not_common():
    off = [(finest(gear)["common_hz"] / finest(gear)["sector_hz"] - 1.0).abs().max() for gear in GEARS]
    assert off[0] < 0.006 and 0.03 < off[1] < 0.06
