"""The bricks that CalculiX is given of a gear body, and what it made of them (docs/measured)."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from references import against, agrees

from facegear.parts.body_mesh import body_mesh
from facegear.parts.section import section_properties
from validation.gear_body.calculix import frequencies_of, revolve, section

MEASURED = Path(__file__).parents[2] / "docs" / "measured" / "calculix_body.csv"
SIGNS = np.array([[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1]])


def test_bricks_fill_the_volume_of_the_section_and_hold_its_bore():
    """By the determinant in the middle of every brick of straight edges."""
    shape = section()
    bricks = revolve(body_mesh(shape, 1, 2.0), 48)
    corners = bricks.points[bricks.bricks[:, :8]]
    local = np.concatenate([SIGNS, SIGNS * [1, 1, -1]]) / 8.0
    volumes = 8.0 * np.linalg.det(np.einsum("ni,bnj->bij", local, corners))
    assert (volumes > 0.0).all()
    mass, *_ = section_properties(shape)
    # The bricks' middles stand on chords: sin x / x of the circle.
    x = 2.0 * np.pi / 48
    assert 7850.0 * volumes.sum() == pytest.approx(mass * np.sin(x) / x, rel=1e-3)
    for first, last, middle in ((0, 1, 8), (2, 3, 10), (4, 5, 12), (6, 7, 14)):
        ends = 0.5 * (bricks.points[bricks.bricks[:, first]] + bricks.points[bricks.bricks[:, last]])
        np.testing.assert_allclose(bricks.points[bricks.bricks[:, middle]], ends, atol=1e-12)
    r = np.hypot(*bricks.points[bricks.bricks[:, 16:]].T[:2])
    np.testing.assert_allclose(r, np.hypot(*bricks.points[bricks.bricks[:, :4]].T[:2]), atol=1e-12)
    assert np.allclose(np.hypot(*bricks.points[bricks.fixed_points].T[:2]), 0.12)


def test_frequencies_are_read_from_what_calculix_writes():
    text = """
     E I G E N V A L U E   O U T P U T

 MODE NO    EIGENVALUE                       FREQUENCY
                                     REAL PART            IMAGINARY PART
                           (RAD/TIME)      (CYCLES/TIME     (RAD/TIME)

      1   0.1898205E+08   0.4356839E+04   0.6934124E+03   0.0000000E+00
      2   0.1898205E+08   0.4356839E+04   0.6934124E+03   0.0000000E+00

     P A R T I C I P A T I O N   F A C T O R S

MODE NO.   X-COMPONENT     Y-COMPONENT
      1   0.1E+00   0.2E+00   0.3E+00   0.4E+00
"""
    assert frequencies_of(text).tolist() == [693.4124, 693.4124]


@against(
    "third-party program",
    "CalculiX, bricks of 20 nodes of the whole body (docs/measured/calculix_body.csv, `make peers`)",
    capability="gear_bodies",
    module="facegear.parts.modes",
)
def test_first_frequencies_are_those_of_calculix_on_the_whole_body_in_space():
    table = pd.read_csv(MEASURED)
    finest = table[table["around"] == table["around"].max()]
    assert len(finest) == 6
    agrees("frequency, Hz", finest["ours_hz"], finest["calculix_hz"], relative=3e-3)
    assert (finest["pair_hz"] < 1e-3 * finest["calculix_hz"]).all()
