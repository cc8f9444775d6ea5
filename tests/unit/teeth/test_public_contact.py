"""Unloaded contact of four public designs has the numbers that were computed outside the package.

Stated errors: 1e-9 mm, 1e-11 rad, 1e-9 relative, 1e-8 for Hertz, 2e-8 um for the crowned pinion.
"""

import numpy as np
import pytest
from public_teeth import CROWNING_UM, ERRORS, MM, NAMES, crowning, public_design, public_numbers
from references import against, agrees
from scipy.optimize import minimize_scalar

from facegear.contact.hertz import contact_ellipse, contact_modulus
from facegear.teeth.bounded_contact import contact_path, modified_contact
from facegear.teeth.design import AssemblyErrors, Material
from facegear.teeth.family_contact import contact_line
from facegear.teeth.unloaded_contact import gear_backlash

SIDES = {"drive": 1, "coast": -1}
CASES = pytest.mark.parametrize(("name", "side"), [(name, side) for name in NAMES for side in SIDES])
TORQUE = 500.0


def nominal_path(name, side):
    """Return the path of a public design without errors."""
    family = public_design(name)
    return contact_path(family, contact_line(family, SIDES[side]))


def mesh_force(path):
    """Return the mesh force (N) of the public torque on one pair."""
    return TORQUE / path.line.base_pitch


@CASES
def test_path_ends_and_edges_are_the_public_ones(name, side):
    path, numbers = nominal_path(name, side), public_numbers(name)
    for which, s, edge in (("first", path.first, path.first_edge), ("last", path.last, path.last_edge)):
        *point, expected_edge = numbers[f"{side} path {which} xyz mm"]
        assert edge == expected_edge
        assert np.abs(path.line.point(s) - np.array(point) * MM).max() < 1e-12
    lengths = np.array([path.first, path.last]) + path.line.pinion_lead
    expected = np.array(numbers[f"{side} pinion radius of curvature first, last mm"]) * MM
    assert np.abs(lengths - expected).max() < 1e-12


@against(
    "second implementation",
    "public designs of the family",
    capability="geometry",
    module="facegear.teeth.bounded_contact",
)
@CASES
def test_contact_ratios_are_the_public_ones(name, side):
    path, numbers = nominal_path(name, side), public_numbers(name)
    agrees("contact ratio", path.contact_ratio, numbers[f"{side} contact ratio"], relative=1e-9)
    family = public_design(name)
    posed = contact_path(family, contact_line(family, SIDES[side], ERRORS))
    expected = numbers[f"{side} with errors: contact ratio"]
    agrees("contact ratio with errors of assembly", posed.contact_ratio, expected, relative=1e-9)


@CASES
def test_relative_curvatures_are_the_public_ones(name, side):
    path, numbers = nominal_path(name, side), public_numbers(name)
    large, small, angle = path.line.curvatures(path.middle)
    expected = numbers[f"{side} relative curvatures at the middle of the path 1/m"]
    assert [large, small] == pytest.approx(expected, rel=1e-9)
    assert abs(angle - numbers[f"{side} long axis against the generator rad"]) < 1e-11


@CASES
def test_sliding_is_the_public_one(name, side):
    path = nominal_path(name, side)
    expected = public_numbers(name)[f"{side} sliding first, middle, last mm per rad of pinion"]
    speeds = path.line.sliding(np.array([path.first, path.middle, path.last]))
    assert np.abs(speeds - np.array(expected) * MM).max() < 1e-12


@CASES
def test_force_and_moment_on_the_gear_are_the_public_ones(name, side):
    path, numbers = nominal_path(name, side), public_numbers(name)
    wrench = mesh_force(path) * path.line.frame(path.middle).wrench()
    force, moment = (
        next(numbers[key] for key in numbers if key.startswith(f"{side} {part} on gear"))
        for part in ("force", "moment")
    )
    assert wrench[:3] == pytest.approx(force, rel=1e-9)
    assert wrench[3:] == pytest.approx(moment, rel=1e-9)
    on_pinion = -public_design(name).motion.basis @ wrench[:3]
    expected = numbers[f"{side} force on pinion along its axis, along u N"]
    assert on_pinion[1:] == pytest.approx(expected, rel=1e-9, abs=1e-9)


@against(
    "second implementation",
    "public designs of the family",
    capability="geometry",
    module="facegear.teeth.family_contact",
)
@CASES
def test_contact_under_errors_of_assembly_is_the_public_one(name, side):
    family, numbers = public_design(name), public_numbers(name)
    line = contact_line(family, SIDES[side], ERRORS)
    error = numbers[f"{side} with errors: te along the normal um"] * 1e-6
    agrees("transmission error by errors of assembly, m", line.transmission_error, error, absolute=1e-15)
    psi, turn = numbers[f"{side} with errors: psi rad, turn e rad"]
    assert abs(line.psi - psi) < 1e-11
    assert abs(line.turn - turn) < 1e-11
    y = numbers[f"{side} with errors: middle of path on the pinion y mm"]
    assert abs(line.pinion_y(contact_path(family, line).middle) - y * MM) < 1e-12


@CASES
def test_the_middle_of_the_path_on_the_pinion_is_the_public_one(name, side):
    path = nominal_path(name, side)
    expected = public_numbers(name)[f"{side} nominal: middle of path on the pinion y mm"] * MM
    assert abs(path.line.pinion_y(path.middle) - expected) < 1e-12


@against(
    "second implementation",
    "public designs of the family",
    capability="geometry",
    module="facegear.teeth.unloaded_contact",
)
@pytest.mark.parametrize("name", NAMES)
def test_backlash_and_its_change_with_the_axial_place_are_the_public_ones(name):
    family, numbers = public_design(name), public_numbers(name)
    backlash = gear_backlash(family)
    agrees("backlash, um", backlash * 1e6, numbers["backlash at gear pitch circle um"], absolute=1e-9)
    change = gear_backlash(family, AssemblyErrors(pinion_axial=1 * MM)) - backlash
    expected = numbers["its change by 1 mm outwards um"]
    agrees("its change by 1 mm outwards, um", change * 1e6, expected, absolute=1e-9)


@pytest.mark.parametrize("name", NAMES)
def test_the_contact_ellipse_is_the_public_one(name):
    path, numbers = nominal_path(name, "drive"), public_numbers(name)
    large, small, _ = path.line.curvatures(path.middle)
    modulus = contact_modulus((Material(206e9, 0.3), Material(206e9, 0.3)))
    ellipse = contact_ellipse(mesh_force(path), float(large), float(small), modulus)
    computed = [ellipse.long * 1e3, ellipse.short * 1e3, ellipse.pressure * 1e-6, ellipse.approach * 1e6]
    key = "drive Hertz at the middle, 500 N m on one pair: half axes mm, pressure MPa, approach um"
    assert computed == pytest.approx(numbers[key], rel=1e-8)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize(("errors", "words"), [(AssemblyErrors(), "nominal"), (ERRORS, "with errors")])
def test_the_crowned_pinions_transmission_error_is_the_public_one(name, errors, words):
    family = public_design(name)
    removal, pitch = crowning(family, CROWNING_UM[name]), 2 * np.pi / family.pinion_teeth

    def contact(angle):
        return modified_contact(family, 1, angle, removal, errors)

    angle = np.linspace(0.0, pitch, 25)
    error = contact(angle).transmission_error
    highest, step = angle[np.argmax(error)], angle[1]
    largest = -minimize_scalar(
        lambda at: -contact(at).transmission_error[0],
        bounds=(highest - step, highest + step),
        method="bounded",
        options={"xatol": 1e-8},
    ).fun
    low, high = angle[np.argmin(error)] + np.array([-step, step])
    before = contact(low).pair[0]
    for _ in range(45):
        middle = (low + high) / 2
        low, high = (middle, high) if contact(middle).pair[0] == before else (low, middle)
    smallest = contact(low).transmission_error[0]
    expected = public_numbers(name)[f"crowned pinion, drive, {words}: te largest, peak to peak um"]
    assert abs(largest * 1e6 - expected[0]) < 2e-8
    assert abs((largest - smallest) * 1e6 - expected[1]) < 2e-8
