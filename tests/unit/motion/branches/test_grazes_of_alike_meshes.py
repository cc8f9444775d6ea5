"""Grazes of meshes that symmetry moves alike are one, whatever their rounding."""

from types import SimpleNamespace

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from facegear.motion.branches.grazes import grazes
from facegear.motion.branches.locate import _join
from facegear.motion.branches.special import Kind, Special

EDGE = 1.0


def make_point(heights):
    extrema = np.stack([EDGE + np.asarray(heights), np.full(len(heights), -EDGE)], axis=1)[:, :, None]
    return SimpleNamespace(extrema=extrema, u=0.0)


def find_grazes(before, after):
    edges = np.full(len(before), np.nan), np.full(len(before), EDGE)
    return grazes(SimpleNamespace(edges=lambda u: edges), make_point(before), make_point(after))[0]


@given(height=st.integers(1, 10**6), rounding=st.floats(1e-15, 1e-10))
def test_two_alike_meshes_make_one_graze_on_either_side_of_a_seventh_digit(height, rounding):
    border = (height + 0.5) * 1e-7
    (graze,) = find_grazes([-border, -border - rounding], [border, border + rounding])
    assert graze.meshes == (0, 1)


def test_meshes_that_do_not_move_alike_graze_by_themselves():
    assert [graze.meshes for graze in find_grazes([-0.1, -0.2, -0.1], [0.1, 0.1, 0.1])] == [(0, 2), (1,)]


def test_grazes_at_the_border_of_two_halves_are_one_of_all_their_meshes():
    at = SimpleNamespace(u=0.0)
    graze = [
        Special(Kind.GRAZE, at, 1.0, "", 0.5 + shift, (mesh,), -1) for mesh, shift in ((4, 0.0), (1, 1e-13))
    ]
    (joined,) = _join(graze[:1], graze[1:])
    assert joined.meshes == (1, 4)
    elsewhere = Special(Kind.GRAZE, at, 1.0, "", 0.6, (1,), -1)
    other_edge = Special(Kind.GRAZE, at, 1.0, "", 0.5, (1,), 1)
    assert len(_join(graze[:1], [elsewhere, other_edge])) == 3
