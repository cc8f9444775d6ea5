"""The mesh of Hertz's contact that Kratos is given, read back; no run."""

import numpy as np
import pytest

from validation.contact.kratos import write
from validation.contact.kratos_hertz import RADIUS, cylinder_on_block, hertz


@pytest.fixture(scope="module")
def blocks(tmp_path_factory):
    """Nodes (n, 3), and the nodes of each block of elements and conditions, as written."""
    folder = tmp_path_factory.mktemp("kratos")
    write(folder, cylinder_on_block(0.1)[0], (1.0,), None)
    tables, lines = [], iter((folder / "pair.mdpa").read_text().splitlines())
    for line in lines:
        if line.startswith(("Begin Nodes", "Begin Elements", "Begin Conditions")):
            end = "End " + line.split()[1]
            tables.append(np.array([row.split() for row in iter(lambda: next(lines), end)], dtype=float))
    nodes, *others = tables
    assert (nodes[:, 0] == np.arange(1, len(nodes) + 1)).all()
    return nodes[:, 1:], [table[:, 2:].astype(int) - 1 for table in others]


def test_every_hexahedron_is_the_right_way_round(blocks):
    nodes, (upper, lower, *_) = blocks
    for cubes in (upper, lower):
        corner = nodes[cubes[:, [1, 3, 4]]] - nodes[cubes[:, :1]]
        assert np.linalg.det(corner).min() > 0.0


def test_contact_faces_look_at_each_other_and_touch_along_one_line(blocks):
    nodes, (*_, slave, master) = blocks
    for faces, outward in ((slave, -1.0), (master, 1.0)):
        one, two = (nodes[faces[:, corner]] - nodes[faces[:, 0]] for corner in (1, 3))
        assert (outward * np.cross(one, two)[:, 1]).min() > 0.0
    x, y, _ = nodes[np.unique(slave)].T
    np.testing.assert_allclose(y, x**2 / (2.0 * RADIUS), rtol=1e-12)
    assert np.abs(nodes[np.unique(master), 1]).max() == 0.0


def test_pressure_of_hertz_carries_the_load():
    pressure, half_width = hertz(1000.0)
    assert 0.5 * np.pi * pressure * half_width == pytest.approx(1000.0, rel=1e-12)
