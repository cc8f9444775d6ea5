"""The pair cut out that three programs are given, and how their displacements are read; no run."""

import numpy as np
import pytest
from contact_bodies import STEEL, pair_design

from facegear.teeth.mesh_sizes import MeshSizes
from facegear.teeth.tooth_mesh import CORNERS
from validation.contact.pair_bodies import PairBodies, held_nodes, peak_pressure
from validation.contact.pair_peer import POSITION, middle

TURN = 1e-3


@pytest.fixture(scope="module")
def cut_out():
    sizes = MeshSizes(3e-3, 5e-3, 4e-3)
    return PairBodies(middle(pair_design()), sizes, (STEEL, STEEL), POSITION)


def volumes(nodes, cubes):
    """Volumes of hexahedra (c, 8), by the six pyramids from each one's middle over its faces."""
    corner = nodes[cubes]
    centre = corner.mean(axis=1)
    faces = ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))
    total = 0.0
    for face in faces:
        a, b, c, d = (corner[:, node] - centre for node in face)
        total = total + np.sum(np.cross(c - a, d - b) * (a + b + c + d), axis=1) / 24.0
    return total


def test_linear_hexahedra_fill_the_quadratic_ones_of_both_bodies(cut_out):
    bodies = cut_out.linear(TURN)
    shift = 0
    for tooth, cubes in zip(cut_out.teeth.values(), bodies.cubes, strict=True):
        parts = volumes(bodies.nodes, cubes)
        assert parts.min() > 0.0
        ring = np.array([0, 1, 3, 2, 4, 5, 7, 6])
        whole = volumes(1e3 * tooth.nodes, tooth.hexes[:, CORNERS[ring]])
        # curved surfaces are met by four faces in place of one
        assert parts.sum() == pytest.approx(whole.sum(), rel=0.02)
        assert np.unique(cubes).size == len(tooth.nodes) and cubes.min() == shift
        shift += len(tooth.nodes)


def test_flanks_of_the_pair_look_at_each_other(cut_out):
    bodies = cut_out.linear(TURN)
    means = []
    for faces in bodies.faces:
        a, b, c, d = (bodies.nodes[faces[:, corner]] for corner in range(4))
        means.append(np.cross(c - a, d - b).sum(axis=0))
    one, two = means / np.linalg.norm(means, axis=1)[:, None]
    assert one @ two < -0.9


def test_only_the_supports_are_moved_and_the_pinions_turns_about_its_axis_towards_the_gear(cut_out):
    bodies = cut_out.linear(TURN)
    pinion, gear = cut_out.teeth.values()
    count = len(pinion.nodes)
    held = np.concatenate([held_nodes(pinion), count + held_nodes(gear)])
    assert (np.flatnonzero(~np.isnan(bodies.support_displacement[:, 0])) == np.sort(held)).all()
    assert (bodies.support_displacement[count + held_nodes(gear)] == 0.0).all()
    x, _, z = bodies.nodes[held_nodes(pinion)].T
    u, v, w = bodies.support_displacement[held_nodes(pinion)].T
    np.testing.assert_allclose(x * u + z * w, 0.0, atol=1e-12)
    np.testing.assert_allclose(np.hypot(u, w), TURN * np.hypot(x, z), rtol=1e-12)
    assert (v == 0.0).all()
    # the flank that is loaded moves the way its normal points
    faces = bodies.faces[0]
    a, b, c, d = (bodies.nodes[faces[:, corner]] for corner in range(4))
    x, _, z = ((a + b + c + d) / 4.0).T
    push = np.stack([-TURN * z, 0.0 * x, TURN * x], axis=1)
    assert np.sum(np.cross(c - a, d - b) * push) > 0.0


@pytest.mark.parametrize("body", ["pinion", "face_gear"])
def test_a_small_rigid_motion_stresses_no_fillet_and_a_growing_body_does(cut_out, body):
    points = cut_out.node_positions(body)
    rigid = 1e-6 * np.array([1.0, -2.0, 3.0]) + np.cross([1e-4, 2e-4, -3e-4], points)
    assert abs(cut_out.root_stress(body, rigid)) < 1e-4 * STEEL.young_modulus * 1e-4
    grown = cut_out.root_stress(body, 1e-4 * points)
    assert grown == pytest.approx(1e-4 * STEEL.young_modulus / (1.0 - STEEL.poisson_ratio), rel=1e-9)


def test_the_pressure_compared_is_the_largest_in_the_middle_third_of_the_contact_line():
    pair = PairBodies(middle(pair_design()), MeshSizes(3e-3, 1e-3, 4e-3), (STEEL, STEEL), POSITION)
    tooth, design = pair.teeth["pinion"], pair.design
    grid = tooth.surfaces["flank_right"].nodes
    y = tooth.nodes[grid][..., 1].mean(axis=0)
    inside = design.pinion.width / 2 - np.abs(y - design.middle) > 0.333 * design.pinion.width
    np.testing.assert_array_equal(pair.is_in_middle(y), inside)
    assert 3 < np.count_nonzero(inside) < inside.size - 4
    first, last = np.flatnonzero(inside)[[0, -1]]
    row, count = grid[grid.shape[0] // 2], inside.size

    def largest(of_planes):
        pressure = np.zeros(len(tooth.nodes))
        pressure[row] = of_planes
        return pair.largest_pressure(pressure)

    # what stands beyond the neighbours does not count, what alternates from plane to plane cancels out
    far = np.abs(np.arange(count) - (first + last) / 2) > (last - first) / 2 + 1
    assert largest(np.where(far, 5.0, 2.0)) == pytest.approx(2.0, rel=1e-12)
    assert largest(2.0 + 0.1 * (-1.0) ** np.arange(count)) == pytest.approx(2.0, rel=1e-12)
    assert largest(np.arange(count) + 1.0) == pytest.approx(last + 1.0, rel=1e-12)


@pytest.mark.parametrize("beside", np.linspace(-0.5, 0.5, 5))
def test_the_peak_of_hertz_pressure_is_found_between_nodes(beside):
    half, step, largest = 0.4e-3, 0.18e-3, 1.2e9
    at = step * (np.arange(-4.0, 5.0) + beside)
    pressure = largest * np.sqrt(np.maximum(1.0 - (at / half) ** 2, 0.0))
    assert peak_pressure(at, pressure) == pytest.approx(largest, rel=1e-12)
    # a program that has no node in places
    gaps = np.where(np.arange(9) % 4 == 3, np.nan, pressure)
    assert 0.8 * largest < peak_pressure(at, gaps) < largest * (1.0 + 1e-12)


def test_where_a_neighbour_carries_nothing_the_peak_is_that_of_the_node():
    at = np.arange(5.0)
    assert peak_pressure(at, np.array([0.0, 0.0, 3.0, 2.0, 0.0])) == 3.0
    assert peak_pressure(at, np.array([3.0, 2.0, 0.0, 0.0, 0.0])) == 3.0
    assert peak_pressure(at, np.zeros(5)) == 0.0
