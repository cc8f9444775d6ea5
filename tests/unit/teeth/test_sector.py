"""Sectors: copies of one tooth share their cut nodes, and the full ring closes."""

import numpy as np
import pytest

from facegear.errors import GeometryError
from facegear.teeth.mesh_quality import scaled_jacobians, volume
from facegear.teeth.tooth_mesh import sector


def test_three_teeth_share_two_cuts(tooth):
    merged = sector(tooth, 3, first=-1)
    assert len(merged.nodes) == 3 * len(tooth.nodes) - 2 * len(tooth.cut_left)
    assert volume(merged.nodes, merged.hexes) == pytest.approx(
        3 * volume(tooth.nodes, tooth.hexes), rel=1e-12
    )
    np.testing.assert_allclose(merged.nodes[merged.tooth_nodes[1]], tooth.nodes, atol=1e-15)
    assert scaled_jacobians(merged.nodes, merged.hexes).min() > 0


def test_full_ring_closes_without_duplicate_nodes(tooth):
    ring = sector(tooth, tooth.teeth)
    assert ring.is_closed
    assert len(ring.nodes) == tooth.teeth * (len(tooth.nodes) - len(tooth.cut_left))
    places = np.round(ring.nodes / 1e-9)
    in_order = places[np.lexsort(places.T)]
    assert (in_order[1:] != in_order[:-1]).any(axis=1).all()
    assert len(np.unique(ring.hexes)) == len(ring.nodes)
    assert len(ring.faces("cut_left")) == 0


def test_a_sector_has_between_one_tooth_and_all(tooth):
    for wrong in (0, tooth.teeth + 1):
        with pytest.raises(GeometryError, match="between 1 and"):
            sector(tooth, wrong)
