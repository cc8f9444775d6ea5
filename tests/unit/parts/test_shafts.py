"""Shafts on two bearings: closed forms, steps, reactions, and what cannot stand."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from references import against, agrees

from facegear.errors import InvalidInput
from facegear.parts.shafts import Bearing, Elasticity, Segment, Shaft, condense_shaft, deflections
from facegear.rigid_body import carry_motion

STEEL = Elasticity(206e9, 0.3)
THRUST = 1e8


def bearing(position, radial, axial=0.0):
    return Bearing(position, np.diag([radial, radial, axial, 0.0, 0.0]))


def between(pieces=1):
    """Pinion between its bearings, on a solid shaft of 40 mm cut into pieces."""
    segments = (Segment(0.12 / pieces, 0.04),) * pieces
    return Shaft(segments, STEEL, (bearing(0.0, 1.5e8, THRUST), bearing(0.12, 2.5e8)), 0.05)


def overhung():
    return Shaft((Segment(0.135, 0.036),), STEEL, (bearing(0.0, 2e8, THRUST), bearing(0.09, 3e8)), 0.135)


@against(
    "analytic",
    "notes of the project, bodies.md 6: two bearings, pinion between them and overhung",
    capability="shafts",
    module="facegear.parts.shafts",
)
def test_compliance_of_a_pinion_between_two_bearings_and_overhung_has_its_known_numbers():
    inside, outside = condense_shaft(between()), condense_shaft(overhung())
    compliance, stiffness = inside.compliance, inside.stiffness
    digits = {"relative": 5e-7}
    agrees("deflection by force between, m/N", compliance[0, 0], 4.60795e-9, **digits)
    agrees("slope by force between, rad/N", compliance[4, 0], -1.10072e-8, relative=5e-6)
    agrees("slope by moment between, rad/(N m)", compliance[4, 4], 1.253659e-6, **digits)
    agrees("K_x,x between, N/m", stiffness[0, 0], 2.216652e8, **digits)
    agrees("K_x,ty between, N/rad", stiffness[0, 4], 1.946227e6, **digits)
    agrees("K_y,tx between, N/rad", stiffness[1, 3], -1.946227e6, **digits)
    agrees("K_t,t between, N m/rad", stiffness[3, 3], 8.147529e5, **digits)
    agrees("bearing without tilts between, N/m", inside.square[0, 0], 2.170162e8, **digits)
    agrees("deflection by force overhung, m/N", outside.compliance[0, 0], 1.505954e-8, **digits)
    agrees("slope by force overhung, rad/N", outside.compliance[4, 0], 2.294273e-7, **digits)
    agrees("slope by moment overhung, rad/(N m)", outside.compliance[3, 3], 5.600093e-6, **digits)
    agrees("bearing without tilts overhung, N/m", outside.square[1, 1], 6.640309e7, **digits)


def closed_form(length, reach, diameter, bore, first, second):
    """ff, fm, mm of bodies.md 6 for a pinion at `reach` from bearing A, between the two or overhung."""
    piece = Segment(length, diameter, bore)
    bending = STEEL.young * piece.second_moment
    shear = piece.shear_coefficient(STEEL.poisson) * STEEL.shear * piece.area
    across = (1.0 / first + 1.0 / second) / length**2
    if reach <= length:
        a, b = reach, length - reach
        return (
            a**2 * b**2 / (3 * bending * length)
            + a * b / (length * shear)
            + (b / length) ** 2 / first
            + (a / length) ** 2 / second,
            a * b * (b - a) / (3 * bending * length) + (a / second - b / first) / length**2,
            (a**3 + b**3) / (3 * length**2 * bending) + 1 / (length * shear) + across,
        )
    a = reach - length
    return (
        a**2 * (length + a) / (3 * bending)
        + a / shear
        + a**2 / (length * shear)
        + ((length + a) / length) ** 2 / second
        + (a / length) ** 2 / first,
        a * length / (3 * bending)
        + a**2 / (2 * bending)
        + a / (length * shear)
        + (length + a) / (length**2 * second)
        + a / (length**2 * first),
        length / (3 * bending) + a / bending + 1 / (length * shear) + across,
    )


@against(
    "analytic",
    "a beam on two springs, bodies.md 6",
    capability="shafts",
    module="facegear.parts.shafts",
)
@given(
    st.floats(0.05, 0.4),
    st.floats(0.05, 1.8),
    st.floats(0.02, 0.08),
    st.floats(0.0, 0.9),
    st.floats(1e7, 1e10),
    st.floats(1e7, 1e10),
)
def test_every_even_shaft_follows_the_closed_form(length, fraction, diameter, hollow, first, second):
    reach = fraction * length
    segments = (Segment(2.0 * length, diameter, hollow * diameter),)
    shaft = Shaft(segments, STEEL, (bearing(0.0, first, THRUST), bearing(length, second)), reach)
    found = condense_shaft(shaft).compliance
    ff, fm, mm = closed_form(length, reach, diameter, hollow * diameter, first, second)
    size = np.sqrt(ff * mm)
    agrees("deflection by force, m/N", found[[0, 1], [0, 1]], ff, relative=1e-8)
    agrees("slope by force, rad/N", [found[0, 4], -found[1, 3]], fm, absolute=1e-8 * size)
    agrees("slope by moment, rad/(N m)", found[[3, 4], [3, 4]], mm, relative=1e-8)


def test_cutting_a_shaft_into_elements_changes_nothing():
    whole = condense_shaft(between())
    for pieces in (2, 3, 24):
        cut = condense_shaft(between(pieces))
        size = np.sqrt(np.outer(whole.compliance.diagonal(), whole.compliance.diagonal()))
        assert (np.abs(cut.compliance - whole.compliance) < 1e-9 * size).all()
        np.testing.assert_allclose(cut.reactions, whole.reactions, atol=1e-8)


def test_a_stepped_shaft_approaches_the_cone_that_its_steps_inscribe():
    """Deflection of a cone clamped at its thick end by a force on the other, by quadrature."""

    def steps(count):
        middles = (np.arange(count) + 0.5) / count
        segments = tuple(Segment(0.2 / count, 0.06 - 0.03 * float(at)) for at in middles)
        return condense_shaft(Shaft(segments, STEEL, (Bearing(0.0, 1e16 * np.eye(5)),), 0.2)).compliance[0, 0]

    z, weight = np.polynomial.legendre.leggauss(40)
    z, weight = 0.1 * (z + 1.0), 0.1 * weight
    pieces = [Segment(1.0, 0.06 - 0.15 * float(at)) for at in z]
    bending = STEEL.young * np.array([piece.second_moment for piece in pieces])
    shear = STEEL.shear * np.array([piece.shear_coefficient(0.3) * piece.area for piece in pieces])
    exact = weight @ ((0.2 - z) ** 2 / bending + 1.0 / shear)
    errors = np.array([abs(steps(count) / exact - 1.0) for count in (10, 20, 40)])
    np.testing.assert_allclose(errors[:-1] / errors[1:], 4.0, rtol=0.1)
    assert errors[-1] < 5e-4


@given(st.lists(st.floats(-1e4, 1e4), min_size=5, max_size=5), st.floats(0.0, 0.3), st.floats(0.5, 1.0))
def test_forces_and_moments_of_all_bearings_balance_the_pinions_load(load, pinion, far):
    matrix = np.diag([3e8, 1e8, 2e8, 2e5, 1e5]) + 0.0
    matrix[0, 1] = matrix[1, 0] = 5e7
    matrix[2, 3] = matrix[3, 2] = 1e6
    segments = (Segment(0.1, 0.05, 0.02), Segment(0.08, 0.06), Segment(0.12, 0.04, 0.01))
    positions = (0.02, 0.3 * far)
    bearings = (Bearing(positions[0], matrix), bearing(positions[1], 2e8))
    found = condense_shaft(Shaft(segments, STEEL, bearings, pinion)).bearing_loads(np.array(load))
    # A load at a distance along z is one at the pinion: virtual work with the rigid motions of the shaft.
    total = sum(carry_motion(at - pinion).T @ own for at, own in zip(positions, found, strict=True))
    np.testing.assert_allclose(total, load, atol=1e-8 * (1.0 + np.abs(load).max()))


def test_a_bearing_matrix_that_couples_all_motions_is_felt_in_all():
    coupled = np.diag([2e8, 2e8, 1e8, 1e5, 1e5]) + 0.0
    coupled[2, 4] = coupled[4, 2] = 1e6
    shaft = Shaft((Segment(0.12, 0.04),), STEEL, (Bearing(0.0, coupled), bearing(0.12, 2.5e8)), 0.05)
    found = condense_shaft(shaft)
    assert abs(found.compliance[0, 2]) > 1e-3 * found.compliance[0, 0]
    np.testing.assert_allclose(found.stiffness @ found.compliance, np.eye(5), atol=1e-7)


def test_a_stiff_shaft_leaves_its_bearings_alone():
    away = []
    for factor in (1.0, 1e4):
        stiff = Elasticity(factor * STEEL.young, STEEL.poisson)
        own = between()
        found = condense_shaft(Shaft(own.segments, stiff, own.bearings, own.pinion)).compliance
        rigid = (7 / 12) ** 2 / 1.5e8 + (5 / 12) ** 2 / 2.5e8
        away.append(found[0, 0] / rigid - 1.0)
    assert away[0] > 0.1
    assert away[1] == pytest.approx(1e-4 * away[0], rel=1e-4)


def test_cowper_s_coefficient_of_a_thin_tube_and_of_a_solid_shaft():
    assert Segment(0.1, 0.04).shear_coefficient(0.3) == pytest.approx(6 * 1.3 / 8.8)
    assert Segment(0.1, 0.04, 0.03999999).shear_coefficient(0.3) == pytest.approx(2 * 1.3 / (4 + 3 * 0.3))


@pytest.mark.parametrize(
    ("change", "line"),
    [
        (lambda: Segment(-0.1, 0.04), "length of a shaft's segment = -0.1: must be above 0 m"),
        (lambda: Segment(0.1, -0.04), "diameter of a shaft's segment = -0.04: must be above 0 m"),
        (lambda: Segment(0.1, 0.04, 0.05), "must be from 0 to below the diameter of 0.04 m"),
        (
            lambda: Shaft((Segment(0.1, 0.04),), STEEL, (bearing(0.2, 1e8),), 0.05),
            "position of a shaft's bearing = 0.2: must be on the shaft, from 0 to 0.1 m",
        ),
        (
            lambda: condense_shaft(Shaft((Segment(0.1, 0.04),), STEEL, (bearing(0.05, 1e8, 1e8),), 0.05)),
            "must be such that they hold it along its axis and against tilting",
        ),
    ],
)
def test_a_shaft_that_cannot_be_is_refused(change, line):
    with pytest.raises(InvalidInput, match=line):
        change()


@pytest.mark.parametrize("shaft", [between(), between(3), overhung()])
def test_a_deflected_shaft_rests_on_its_springs_and_carries_its_pinion_where_that_stands(shaft):
    load = np.array([3000.0, -800.0, 200.0, 0.0, 40.0])
    sits = condense_shaft(shaft)
    at = [bearing.position for bearing in shaft.bearings]
    springs = [bearing.stiffness for bearing in shaft.bearings]
    moved = deflections(shaft, np.array([*at, shaft.pinion])) @ load
    for spring, motion, force in zip(springs, moved, sits.bearing_loads(load), strict=False):
        np.testing.assert_allclose(spring @ motion, force, rtol=1e-9, atol=1e-7)
    np.testing.assert_allclose(moved[-1], sits.compliance @ load, rtol=1e-9, atol=1e-15)


@against(
    "analytic",
    "rigid line beyond the last load",
    capability="shafts",
    module="facegear.parts.shafts",
)
def test_beyond_its_last_load_a_shaft_is_straight():
    at = np.array([0.12, 0.13, 0.15])
    longer = Shaft((Segment(0.15, 0.04),), STEEL, between().bearings, 0.05)
    first, middle, last = deflections(longer, at)[:, 0, 0]
    agrees("deflection of the free end, m/N", last, first + 3.0 * (middle - first), relative=1e-9)
