"""Spur teeth at ninety degrees are a limit of the family, and keep the values of their former formulas.

`spur.npz` was written by `tests/helpers/spur_values.py` while spur teeth had formulas of their own.
"""

from dataclasses import replace
from functools import cache
from math import pi

import numpy as np
import pytest
from spur_values import ERRORS, STORED, shipped_designs, spur_values

from facegear.teeth.bounded_contact import contact_path
from facegear.teeth.family_contact import contact_line
from facegear.teeth.family_limits import family_limits, tip_land
from facegear.teeth.generated_fillet import gear_fillet
from facegear.teeth.generated_flank import gear_flank
from facegear.teeth.helicoid import PinionFlank, pinion_fillet, pinion_land, pinion_start

NAMES = sorted({key.split("/")[0] for key in np.load(STORED).files})
STEPS = (1e-8, 1e-6, 1e-4)


@cache
def stored_values(name):
    """Return the stored values of a design."""
    with np.load(STORED) as arrays:
        return {key.split("/")[1]: arrays[key] for key in arrays.files if key.split("/")[0] == name}


@cache
def design_of(name):
    """Return a shipped design."""
    return shipped_designs()[name]


@pytest.mark.parametrize("name", NAMES)
def test_spur_teeth_keep_the_values_of_their_former_formulas(name):
    values, stored = spur_values(design_of(name)), stored_values(name)
    assert values.keys() == stored.keys()
    for quantity, expected in stored.items():
        scale = np.maximum(np.abs(expected), 1.0)
        assert np.all(np.abs(values[quantity] - expected) < 1e-12 * scale), quantity


@pytest.mark.parametrize("name", NAMES)
def test_the_familys_flank_is_the_spur_flank(name):
    design, stored = design_of(name), stored_values(name)
    flank = gear_flank(design.family, -1)
    roll, psi = stored["flank"]
    s = design.shaper_base_radius * roll
    assert np.abs(flank.point(psi, s) - stored["flank points"]).max() < 1e-12
    assert np.abs(flank.normal(psi, s) - stored["flank normals"]).max() < 1e-12
    points = stored["flank points"]
    place = flank.parameters_at(np.hypot(points[..., 0], points[..., 1]), points[..., 2])
    assert np.abs(place[0] - psi).max() < 1e-11
    by_psi, by_s = flank.tangents(psi, s)
    assert np.abs(design.shaper_base_radius * by_s - stored["flank tangents"][0]).max() < 1e-12
    assert np.abs(by_psi - stored["flank tangents"][1]).max() < 1e-12


@pytest.mark.parametrize("name", NAMES)
def test_the_familys_limits_are_the_spur_limits(name):
    design, stored = design_of(name), stored_values(name)
    limits = family_limits(design.family)
    inner, outer = stored["limits"][:2]
    assert [start.reason for start in limits.starts] == ["undercut", "undercut"]
    assert max(abs(start.radius - inner) for start in limits.starts) < 1e-12
    assert abs(limits.pointing - outer) < 1e-12


@pytest.mark.parametrize("name", NAMES)
def test_the_familys_fillet_is_the_spur_fillet(name):
    design, stored = design_of(name), stored_values(name)
    gear, fillet = design.face_gear, gear_fillet(design.family, -1)
    radius = np.linspace(gear.inner_radius, gear.outer_radius, 5)
    angle, height = stored["fillet"]
    for part, column in ((0.0, 0), (1.0, -1)):
        point = fillet.point(fillet.y_at(radius, part), part)
        assert np.abs(np.arctan2(point[:, 0], point[:, 1]) - angle[:, column]).max() < 1e-12
        assert np.abs(point[:, 2] - height[:, column]).max() < 1e-12


@pytest.mark.parametrize("name", NAMES)
def test_the_familys_pinion_is_the_spur_pinion(name):
    design, stored = design_of(name), stored_values(name)
    family, y = design.family, design.mean_radius + 1e-3
    helicoid = family.pinion_flanks[0]
    flank, root = PinionFlank(helicoid), pinion_fillet(family, 1)
    start, tip_angle, _ = stored["pinion"]
    assert abs(pinion_start(family, 1, y) / helicoid.base_radius - start) < 1e-12
    rolls = np.linspace(max(start, 0.0), design.pinion_tip_roll, 5) * helicoid.base_radius
    gamma = np.linspace(design.pressure_angle, pi / 2, 5)
    for points, normals, name_of in (
        (flank.point(rolls, y), flank.normal(rolls, y), "involute"),
        (root.point(gamma, y), root.normal(gamma, y), "trochoid"),
    ):
        radius, angle = stored[name_of]
        assert np.abs(np.hypot(points[:, 0], points[:, 2]) - radius).max() < 1e-12
        assert np.abs(np.arctan2(points[:, 0], -points[:, 2]) - angle).max() < 1e-12
        assert np.abs(normals[:, [0, 2]].T - stored[f"{name_of} normals"]).max() < 1e-12
        assert np.abs(normals[:, 1]).max() == 0.0
    assert abs(pinion_land(family, y) - 2 * tip_angle * design.pinion_tip_radius) < 1e-12


CONTACT_LINES = [
    (name, case) for name in NAMES for case in range(len(ERRORS)) if f"path {case}" in stored_values(name)
]
"""Pairs and errors with a contact path; teeth that touch along lines have none."""


@pytest.mark.parametrize(("name", "case"), CONTACT_LINES)
def test_the_familys_contact_line_is_the_spur_one(name, case):
    design, stored = design_of(name), stored_values(name)
    line = contact_line(design.family, 1, ERRORS[case])
    psi, turn, error, y, _ = stored[f"path {case}"]
    assert abs(line.psi - psi) < 1e-11
    assert abs(line.turn + turn) < 1e-11
    assert abs(line.transmission_error - error) < 1e-14
    assert abs(line.pinion_place - y) < 1e-12 if case == 0 else abs(line.pinion_place - y) < 1e-10
    by_error, by_place = line.error_slopes()
    order = [0, 1, 2]
    expected_error, expected_place = stored[f"path slopes {case}"][:, order]
    assert np.abs(by_error[:3][order] - expected_error).max() < 1e-11
    assert np.abs(by_place[:3][order] / expected_place - 1.0).max() < 1e-8


def family_measures(family):
    """Return numbers of a family that a small helix, taper or offset may move only in proportion."""
    numbers = []
    mean = (family.inner_radius + family.outer_radius) / 2
    for side in (1, -1):
        flank, fillet = gear_flank(family, side), gear_fillet(family, side)
        psi, s = flank.parameters_at(mean, family.gear_tip.height(mean) - 0.8 * family.rack.normal_module)
        numbers += [psi, s, *flank.point(psi, s), *flank.normal(psi, s)]
        numbers += [*fillet.point(fillet.y_at(mean, 0.5), 0.5), fillet.y_at(mean, 1.0)]
        y = family.middle + 0.3 * family.width
        numbers += [*pinion_fillet(family, side).point(1.1, y), float(pinion_start(family, side, y))]
        line = contact_line(family, side, replace(ERRORS[2], pinion_axial=1e-4))
        path = contact_path(family, line)
        numbers += [line.psi, line.turn, line.transmission_error, line.pinion_place]
        numbers += [path.first, path.last, *line.curvatures(path.middle)[:2], float(line.sliding(path.last))]
        numbers += [*line.frame(path.middle).wrench(), family_limits(family).starts[side < 0].radius]
    numbers += [family_limits(family).pointing, float(tip_land(family, mean)), float(pinion_land(family, y))]
    return np.array(numbers)


def changed(family, key, step):
    """Return a family with a small helix, taper, offset (5 mm at 1 rad), shaft angle or asymmetry."""
    rack, angles = family.rack, family.rack.pressure_angles
    sharper = angles[1] + step
    return {
        "helix": lambda: replace(family, rack=replace(rack, helix_angle=step)),
        "taper": lambda: replace(family, rack=replace(rack, taper_angle=step)),
        "offset": lambda: replace(family, offset=0.005 * step),
        "shaft angle": lambda: replace(family, shaft_angle=pi / 2 + step),
        "asymmetry": lambda: replace(family, rack=replace(rack, pressure_angles=(angles[0], sharper))),
    }[key]()


@pytest.mark.parametrize("key", ["helix", "taper", "offset", "shaft angle", "asymmetry"])
def test_numbers_move_in_proportion_to_a_small_departure_from_spur(key):
    family = design_of("strength_only").family
    spur = family_measures(family)
    slopes = [(family_measures(changed(family, key, step)) - spur) / step for step in STEPS]
    size = np.maximum(np.abs(slopes[1]), np.abs(spur))
    assert np.all(np.abs(slopes[0] - slopes[1]) < 3e-6 * size + 1e-6)
    assert np.all(np.abs(slopes[2] - slopes[1]) < 2e-2 * size + 1e-6)
    assert np.abs(slopes[1]).max() > 1e-3
