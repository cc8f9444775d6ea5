"""How matrices of coordinates that are coupled beside the meshes are stored: whole, and every entry once."""

from dataclasses import replace

import gear_bodies
import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from lumped_machines import make_layout, make_machine

from facegear.dynamics.integrator.blocks import blocks_of, coupled_of, strips_of
from facegear.dynamics.integrator.compiled import pack
from facegear.dynamics.steady_state.simulate import build_model
from facegear.machine_code.memory import LANES
from facegear.transmission.elastic_gears import ElasticGears
from facegear.transmission.teeth import GEOMETRIC

SIZES = st.integers(1, 5)
SEEDS = st.integers(0, 2**32 - 1)
FRACTIONS = st.floats(0.0, 1.0)


def sparse(seed, rows, columns, fraction):
    """A matrix of so many vectors of rows and of columns, a fraction of whose entries is not zero."""
    random = np.random.default_rng(seed)
    shape = LANES * rows, LANES * columns
    return random.normal(size=shape) * (random.random(shape) < fraction)


def of_strips(strips, columns):
    """The matrix that strips hold."""
    matrix = np.zeros((LANES * (strips.starts.size - 1), columns))
    for k, (begin, end) in enumerate(zip(strips.starts, strips.starts[1:], strict=False)):
        for column, values in zip(strips.columns[begin:end], strips.values[begin:end], strict=True):
            matrix[LANES * k : LANES * (k + 1), column] += values
    return matrix


@given(SEEDS, SIZES, SIZES, FRACTIONS)
def test_strips_hold_their_matrix_and_are_even_in_number(seed, rows, columns, fraction):
    matrix = sparse(seed, rows, columns, fraction)
    strips = strips_of(matrix)
    assert (np.diff(strips.starts) % 2 == 0).all()
    np.testing.assert_array_equal(of_strips(strips, LANES * columns), matrix)


@given(SEEDS, SIZES, FRACTIONS)
def test_coupling_by_velocity_and_displacement_is_stored_whole(seed, size, fraction):
    velocity, displacement = (sparse(seed + i, size, size, fraction) for i in range(2))
    stored = coupled_of(blocks_of(np.zeros((LANES, LANES * size))), velocity, displacement)
    n, lane = LANES * size, np.arange(LANES)
    matrix = of_strips(stored.strips, 2 * n)
    for k in range(size):
        for j in range(LANES):
            at = LANES * k + lane, LANES * k + (lane ^ j)
            matrix[at] += stored.own[k, j]
            matrix[at[0], n + at[1]] += stored.own[k, LANES + j]
    np.testing.assert_array_equal(matrix, np.hstack([velocity, displacement]))


@given(SEEDS, SIZES, SIZES, FRACTIONS)
def test_every_entry_of_a_mesh_jacobian_is_in_one_block_and_in_one_tile(seed, rows, columns, fraction):
    matrix = sparse(seed, rows, columns, fraction)
    blocks = blocks_of(matrix)
    in_blocks, in_tiles = np.zeros((2, *matrix.shape), int)
    for b, (first, last) in enumerate(zip(blocks.first, blocks.last, strict=True)):
        in_blocks[blocks.rows[blocks.starts[b] : blocks.starts[b + 1]], first:last] += 1
    for k in range(rows):
        for c in blocks.columns[blocks.tiles[k] : blocks.tiles[k + 1]]:
            in_tiles[LANES * k : LANES * (k + 1), c : c + LANES] += 1
    assert max(in_blocks.max(), in_tiles.max()) <= 1
    assert (in_blocks[matrix != 0.0] == 1).all() and (in_tiles[matrix != 0.0] == 1).all()


def test_coordinates_of_a_gear_that_bends_stand_together_by_their_order():
    """So that a flank takes no product with modes of the other gear, and few with zeros."""
    layout = make_layout(kinematics=GEOMETRIC)
    gears = tuple(replace(gear, body=replace(gear.body, mass=31.0, inertia=1.3)) for gear in layout.gears)
    layout = replace(layout, gears=gears)
    elastic = ElasticGears(layout, {gear: gear_bodies.small_body(gear + 1) for gear in range(2)})
    system = build_model(replace(make_machine(layout), bodies=elastic)).system
    coupled = pack(system, 1e4).coupled
    felt = np.abs(system.mesh_jacobian) > 1e-12 * np.abs(system.mesh_jacobian).max()
    gear = np.array([number for _, number in layout.meshes] * 2)
    of_one = felt[gear == 0].any(axis=0) != felt[gear == 1].any(axis=0)
    assert of_one[: of_one.sum()].all() and coupled.blocks.first.size <= 6
    assert (coupled.own != 0.0).sum() > (coupled.strips.values != 0.0).sum()
