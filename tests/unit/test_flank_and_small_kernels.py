"""Bindings of the small kernels, from flanks to bearings, refuse what does not fit, and never crash."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from facegear._kernels import bearings, flanks, samples, statics, strength
from facegear.machine.block_statics import Springs
from facegear.meshing.law import LinearHeld, LoadDependentHeld
from facegear.teeth.rays import Blank, Guess, Shaper


def make_blank():
    """A gear of ones."""
    sides, lines = ("flank", "back"), ("tip", "root", "middle")
    blank = SimpleNamespace(**dict.fromkeys({*Blank._fields} - {*sides, *lines}, 1.0))
    for name in sides:
        guess = SimpleNamespace(**dict.fromkeys(Guess._fields, 1.0))
        guess.roll, guess.psi, guess.edge, guess.fillet = (np.ones(count) for count in (6, 6, 3, 17))
        side = SimpleNamespace(shaper=SimpleNamespace(**dict.fromkeys(Shaper._fields, 1.0)), guess=guess)
        setattr(blank, name, side)
    for name in lines:
        setattr(blank, name, SimpleNamespace(height=1.0, slope=1.0))
    return blank


def make_rays():
    """Two rays at a gear of ones with a sample of four points."""
    points = np.ones((4, 3))
    sample = {"points": points, "normals": points, "rolls": np.ones(4), "psis": np.ones(4)}
    sample |= {"inner": np.ones(4, bool), "spacing": 1.0, "radii": np.ones(2)}
    rays = np.ones((2, 3))
    return {
        "blank": make_blank(),
        "sample": SimpleNamespace(**sample),
        "starts": rays,
        "ways": rays,
        "search_radius": 1.0,
        "found": np.zeros((5, 2)),
        "part": np.zeros(2, np.int8),
    }


def make_placement():
    points = np.ones((3, 3))
    return {
        "matrix": np.ones((2, 3, 3)),
        "shift": np.ones((2, 3)),
        "motion": np.array([0, 1]),
        "point": np.array([2, 0]),
        "points": points,
        "normals": points,
        "starts": np.zeros((2, 3)),
        "ways": np.zeros((2, 3)),
    }


def make_springs():
    """One pinion and one gear of two unknowns, joined by two flanks."""
    return Springs(
        jacobian=np.ones((2, 5)),
        pinion=np.zeros(2, int),
        gear=np.full(2, 3),
        pinion_bearing=np.array([[1.0, 0.0, 1.0]]),
        clearance=np.zeros(1),
        core_row=np.array([0, 1]),
        core_column=np.array([0, 1]),
        core_value=np.ones(2),
        loads=np.ones(5),
    )


def make_statics(law=None):
    return {
        "springs": make_springs(),
        "law": law or LinearHeld(np.ones((3, 2))),
        "gap": np.zeros((3, 2)),
        "tolerance": 1e-12,
        "start": np.zeros(5),
        "displacements": np.zeros((3, 5)),
        "forces": np.zeros((3, 2)),
        "residuals": np.zeros(3),
    }


def make_law():
    cosine, levels = np.ones((3, 4)), np.array([[0.0, 1.0]])
    return LoadDependentHeld(
        np.ones((3, 2)), cosine, cosine, np.ones((1, 2, 4, 2, 4)), levels, np.zeros(2, int)
    )


def make_rings():
    return {
        "displacement": np.ones((2, 2, 5)),
        "speed": np.ones((2, 2, 5)),
        "stiffness": np.ones(2),
        "clearance": np.ones(2),
        "lag": 1.0,
        "body": np.array([0, 2]),
        "forces": np.zeros((3, 3, 5)),
    }


def make_deflections():
    return {
        "deflections": np.ones((2, 3, 4)),
        "errors": np.ones((4, 2)),
        "lower": np.ones(2),
        "upper": np.ones(2),
    }


def make_loads():
    return {"forces": np.ones((2, 4)), "rounding": 0.0, "loads": np.zeros((4, 4))}


def make_cubics():
    return {
        "levels": np.array([[0.0, 1.0]]),
        "kind": np.zeros(3, int),
        "coefficients": np.ones((1, 2, 5, 4)),
        "amounts": np.ones((3, 2, 5)),
        "slopes": False,
        "values": np.zeros((3, 2, 5)),
    }


def make_tally():
    counted = {"mean": np.zeros(4), "largest": np.zeros(4), "largest_mean": np.zeros(2)}
    return {
        "forces": np.ones((4, 6)),
        "per_cycle": 3,
        "starts": np.array([0, 2]),
        "members": np.array([0, 1]),
        "counted": SimpleNamespace(**counted, coefficients=np.zeros(1)),
    }


def make_passage():
    return {
        "starts": np.array([0, 1, 2]),
        "nodes": np.array([0, 3]),
        "force": np.ones(2),
        "teeth": np.array([0, 1]),
        "readings": np.ones((3, 2, 4, 5, 6)),
        "places": np.array([[0, 0, 9], [3, 0, 0]]),
        "stress": np.zeros((2, 4)),
    }


def make_bearing(*numbers, **arrays):
    """Four elements, every number 1."""
    turn = np.arange(4.0)
    return SimpleNamespace(cosine=np.cos(turn), sine=np.sin(turn), **arrays, **dict.fromkeys(numbers, 1.0))


def make_balls():
    lengths = ("arm", "height", "rest_radial", "rest_axial", "inner_length", "outer_length")
    springs = ("inner_stiffness", "outer_stiffness", "stiffness", "centrifugal", "free_energy")
    return make_bearing(*lengths, *springs)


def make_rollers():
    lengths = ("radius", "normal_radial", "normal_axial", "direction", "clearance", "stiffness")
    slices = {"positions": np.array([-1.0, 0.0, 1.0]), "drops": np.array([1.0, 0.0, 1.0])}
    return make_bearing(*lengths, "centrifugal", "free_position", "free_energy", **slices)


def make_response(bearing):
    written = {"energy": np.zeros(2), "force": np.zeros((2, 5)), "stiffness": np.zeros((2, 5, 5))}
    return {"bearing": bearing, "motion": np.ones((2, 5)), **written}


def make_ball_loads():
    return {"bearing": make_balls(), "motion": np.ones((2, 5)), "loads": np.zeros((2, 4, 4))}


def make_roller_loads():
    return {"bearing": make_rollers(), "motion": np.ones((2, 5)), "loads": np.zeros((2, 4, 3, 2))}


CASES = {
    "cut_rays": (flanks.cut_rays, make_rays),
    "place": (flanks.place, make_placement),
    "settle_linear": (statics.settle_linear, make_statics),
    "settle_load_dependent": (statics.settle_load_dependent, lambda: make_statics(make_law())),
    "write_ring_forces": (samples.write_ring_forces, make_rings),
    "press_in": (samples.press_in, make_deflections),
    "split_loads": (samples.split_loads, make_loads),
    "evaluate": (samples.evaluate, make_cubics),
    "tally": (samples.tally, make_tally),
    "superpose": (strength.superpose, make_passage),
    "respond_balls": (bearings.respond_balls, lambda: make_response(make_balls())),
    "respond_rollers": (bearings.respond_rollers, lambda: make_response(make_rollers())),
    "write_ball_loads": (bearings.write_ball_loads, make_ball_loads),
    "write_roller_loads": (bearings.write_roller_loads, make_roller_loads),
}
WRITTEN = (
    "found",
    "part",
    "displacements",
    "residuals",
    "deflections",
    "loads",
    "values",
    "stress",
    "energy",
)


def arrays_of(arguments):
    """Holder and name of every array among the arguments and in their records."""
    for name, value in arguments.items():
        if isinstance(value, np.ndarray):
            yield arguments, name
        elif isinstance(value, SimpleNamespace):
            yield from arrays_of(vars(value))
        elif isinstance(value, tuple):
            fields = value._asdict()
            arguments[name] = record = SimpleNamespace(**fields)
            yield from ((vars(record), inner) for inner in fields)


def changed_shapes(array):
    """The array with one more, one less and no entry along each axis, flat, and with one more axis."""
    for axis in range(array.ndim):
        yield np.concatenate([array, array.take([0], axis)], axis)
        yield np.delete(array, 0, axis)
        yield array.take([], axis)
    yield array[None]
    if array.ndim > 1:
        yield array.ravel()


@pytest.mark.parametrize("case", CASES)
def test_arrays_that_fit_are_taken(case):
    kernel, make = CASES[case]
    kernel(**make())


@pytest.mark.parametrize("case", CASES)
def test_one_array_of_another_shape_raises_or_is_a_smaller_case(case):
    """Radii, places, entries of the core and bodies may be fewer or more: all other changes are refused."""
    kernel, make = CASES[case]
    refused = 0
    for number, (right, name) in enumerate(list(arrays_of(make()))):
        for changed in changed_shapes(right[name]):
            arguments = make()
            list(arrays_of(arguments))[number][0][name] = changed
            try:
                kernel(**arguments)
            except (ValueError, TypeError):
                refused += 1
    assert refused


@pytest.mark.parametrize("case", CASES)
def test_an_index_out_of_range_raises(case):
    kernel, make = CASES[case]
    free = ("part",) if case == "cut_rays" else ("teeth",)
    for number, (holder, name) in enumerate(arrays_of(make())):
        if holder[name].dtype.kind != "i" or name in free:
            continue
        for wrong in (-1, 10**12, -(10**12)):
            arguments = make()
            holder, name = list(arrays_of(arguments))[number]
            if name == "places":
                holder[name][0, 1] = wrong
            else:
                holder[name][0] = wrong
            with pytest.raises(ValueError, match="must"):
                kernel(**arguments)


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, 0.0, 1e308])
def test_numbers_that_are_none_do_not_crash(case, value):
    kernel, make = CASES[case]
    for number, (holder, name) in enumerate(arrays_of(make())):
        if holder[name].dtype.kind == "f":
            arguments = make()
            holder, name = list(arrays_of(arguments))[number]
            holder[name][...] = value
            kernel(**arguments)


@pytest.mark.parametrize("case", CASES)
def test_an_output_that_would_be_copied_is_refused(case):
    kernel, make = CASES[case]
    for name in WRITTEN:
        arguments = make()
        if name not in arguments or not isinstance(arguments[name], np.ndarray):
            continue
        for other in (arguments[name].astype(np.float32), np.repeat(arguments[name], 2, axis=-1)[..., ::2]):
            with pytest.raises(TypeError):
                kernel(**(arguments | {name: other}))


def test_a_record_without_a_field_is_refused():
    arguments = make_rays()
    del arguments["blank"].flank.shaper.base
    with pytest.raises(AttributeError, match="base"):
        flanks.cut_rays(**arguments)


@given(st.integers(0, 2**32 - 1))
def test_strided_and_transposed_arrays_count_like_their_copies(seed):
    forces = np.random.default_rng(seed).uniform(0.0, 2.0, (6, 8))
    counts = []
    for given_forces in (forces[:, ::2].T, np.ascontiguousarray(forces[:, ::2].T)):
        arguments = make_tally() | {"forces": given_forces}
        counts.append((samples.tally(**arguments), arguments["counted"].mean.tolist()))
    assert counts[0] == counts[1]
