"""Meshes of helical, tapered, offset and asymmetric teeth: exact on both sides, right side out, closed."""

from functools import cache

import numpy as np
import pytest
from family_pairs import public_pair, random_pairs
from public_teeth import NAMES
from references import against, agrees
from scipy.spatial import cKDTree

from facegear.teeth.generated_fillet import gear_fillet
from facegear.teeth.generated_flank import gear_flank
from facegear.teeth.helicoid import PinionFlank, pinion_fillet
from facegear.teeth.mesh_quality import require_right_side_out, scaled_jacobians, volume
from facegear.teeth.mesh_sizes import named_sizes, thin_fillet
from facegear.teeth.placement import mirror_teeth
from facegear.teeth.tooth_family import turn_about_axis
from facegear.teeth.tooth_mesh import CORNERS, gear_tooth, pinion_tooth, sector

RANDOM = 10
CASES = (*NAMES, *range(RANDOM))
BUILDERS = {"pinion": pinion_tooth, "face_gear": gear_tooth}
BODIES = tuple(BUILDERS)
SIDES = {"pinion": {"right": 1, "left": -1}, "face_gear": {"left": 1, "right": -1}}
"""Signs of the flanks on the sides of a tooth: +1 drive, -1 coast."""
WORST = 0.05
"""Smallest scaled Jacobian; shipped spur gears have 0.053 (sharp edge) to 0.084, at their fillets."""


@cache
def pairs():
    return {name: public_pair(name) for name in NAMES} | dict(enumerate(random_pairs(RANDOM)))


@cache
def mesh_of(case, body, level="coarse"):
    design = pairs()[case]
    return BUILDERS[body](design, thin_fillet(named_sizes(level, design.module), level))


def closed_form(family, body, name, sign, grid):
    """Return points and parameters' surface of a side: the family's own function of its sign."""
    if body == "pinion":
        helicoid = family.pinion_flanks[0 if sign > 0 else 1]
        if name == "flank":
            return PinionFlank(helicoid).point(helicoid.base_radius * grid.u, grid.v)
        return pinion_fillet(family, sign).point(grid.u, grid.v)
    if name == "flank":
        flank = gear_flank(family, sign)
        return flank.point(grid.v, flank.shaper.base_radius * grid.u)
    points = gear_fillet(family, sign).at_slope(grid.v, grid.u)
    return turn_about_axis(points.turn, points.position)


@against(
    "analytic",
    "closed forms of the family's flanks and fillets, either side by its own sign",
    capability="mesh",
    module="facegear.teeth.tooth_mesh",
)
@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("case", CASES)
def test_nodes_of_both_sides_lie_on_the_closed_forms(case, body):
    design, mesh = pairs()[case], mesh_of(case, body)
    for side, sign in SIDES[body].items():
        for name in ("flank", "fillet"):
            grid = mesh.surfaces[f"{name}_{side}"]
            exact = closed_form(design.family, body, name, sign, grid)
            agrees("distance of nodes from the surface, m", mesh.nodes[grid.nodes], exact, absolute=1e-12)


@pytest.mark.parametrize("case", CASES)
def test_pinion_nodes_of_ends_tip_root_and_bore_lie_on_their_surfaces(case):
    design, mesh = pairs()[case], mesh_of(case, "pinion")
    family, middle, half = design.family, design.middle, design.pinion.width / 2
    radius, y = np.hypot(mesh.nodes[:, 0], mesh.nodes[:, 2]), mesh.nodes[:, 1]
    root = family.pinion_pitch_radius - family.pinion_dedendum + family.shift(y)
    tip = family.pinion_pitch_radius + family.pinion_addendum + family.shift(y)
    assert np.abs(y[mesh.faces["end_inner"]] - (middle - half)).max() < 1e-15
    assert np.abs(y[mesh.faces["end_outer"]] - (middle + half)).max() < 1e-15
    assert np.abs((radius - tip)[mesh.faces["tip"]]).max() < 1e-15
    for side in ("left", "right"):
        assert np.abs((radius - root)[mesh.faces[f"root_land_{side}"]]).max() < 1e-15
    assert np.abs(radius[mesh.faces["bore"]] - design.pinion.bore_radius).max() < 1e-15


@pytest.mark.parametrize("case", CASES)
def test_gear_nodes_of_ends_tip_root_and_back_lie_on_their_surfaces(case):
    design, mesh = pairs()[case], mesh_of(case, "face_gear")
    family, z = design.family, mesh.nodes[:, 2]
    radius = np.hypot(mesh.nodes[:, 0], mesh.nodes[:, 1])
    assert np.abs(radius[mesh.faces["end_inner"]] - family.inner_radius).max() < 1e-15
    assert np.abs(radius[mesh.faces["end_outer"]] - family.outer_radius).max() < 1e-15
    tip = mesh.faces["tip"]
    assert np.abs(z[tip] - family.gear_tip.height(radius[tip])).max() < 1e-15
    for side in ("left", "right"):
        land = mesh.faces[f"root_land_{side}"]
        assert np.abs(z[land] - lowest_of_the_shaper(family, radius[land])).max() < 1e-12
    back = z[mesh.faces["rim_back"]]
    assert np.ptp(back) < 1e-15
    ends = lowest_of_the_shaper(family, np.array([family.inner_radius, family.outer_radius]))
    assert ends.min() - design.face_gear.rim_thickness == pytest.approx(back[0, 0], abs=1e-12)


def lowest_of_the_shaper(family, radius):
    """Return the lowest height at gear radii of the shaper's tip cone, by a search about its axis."""
    motion, shape = family.cutting_motion, radius.shape
    radius, angle = radius.ravel(), np.zeros(radius.size)

    def height(angle):
        """Return z of the cone's point at a radius and an angle about the shaper's axis from its bottom."""
        y = radius / motion.sine
        for _ in range(30):
            tip = family.shaper_tip_radius + (y - family.middle) * family.taper
            x = family.offset + tip * np.sin(angle)
            w = family.lift - tip * np.cos(angle)
            y = (np.sqrt(radius**2 - x**2) - w * motion.cosine) / motion.sine
        tip = family.shaper_tip_radius + (y - family.middle) * family.taper
        w = family.lift - tip * np.cos(angle)
        return w * motion.sine - y * motion.cosine

    for _ in range(4):
        step = 1e-4
        low, at, high = (height(angle + shift) for shift in (-step, 0.0, step))
        angle = angle - step * (high - low) / 2 / (high - 2 * at + low)
    return height(angle).reshape(shape)


@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("case", CASES)
def test_meshes_are_right_side_out_and_as_good_as_those_of_spur_gears(case, body):
    mesh = mesh_of(case, body)
    require_right_side_out(mesh)
    corners = mesh.nodes[mesh.hexes[:, CORNERS]]
    assert np.all(np.linalg.det(corners[:, [1, 2, 4]] - corners[:, [0]]) > 0)
    assert scaled_jacobians(mesh.nodes, mesh.hexes).min() > WORST


@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("case", CASES)
def test_a_turn_by_a_pitch_brings_one_cut_onto_the_other(case, body):
    mesh = mesh_of(case, body)
    turned = mesh.rotated(mesh.nodes[mesh.cut_left], mesh.pitch)
    assert np.abs(turned - mesh.nodes[mesh.cut_right]).max() < 1e-15
    ring = sector(mesh, 3, first=-1)
    assert volume(ring.nodes, ring.hexes) == pytest.approx(3 * volume(mesh.nodes, mesh.hexes), rel=1e-12)


@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("case", CASES)
def test_the_mirror_image_of_a_mesh_is_the_mesh_of_the_mirrored_teeth(case, body):
    design, mesh = pairs()[case], mesh_of(case, body)
    other = BUILDERS[body](mirror_teeth(design), thin_fillet(named_sizes("coarse", design.module), "coarse"))
    image = mesh.nodes * [-1.0, 1.0, 1.0]
    apart, number = cKDTree(other.nodes).query(image)
    assert apart.max() < 1e-14
    assert len(np.unique(number)) == len(number) == len(other.nodes)
    for name in ("flank", "fillet"):
        for side, opposite in (("left", "right"), ("right", "left")):
            first, second = mesh.surfaces[f"{name}_{side}"], other.surfaces[f"{name}_{opposite}"]
            np.testing.assert_array_equal(number[first.nodes], second.nodes)
            assert np.abs(first.u - second.u).max() < 1e-13
            assert np.abs(first.v - second.v).max() < 1e-13
    elements = [{tuple(row) for row in np.sort(hexes, axis=1)} for hexes in (number[mesh.hexes], other.hexes)]
    assert elements[0] == elements[1]


@against(
    "own convergence",
    "volume of the next finer level",
    capability="mesh",
    module="facegear.teeth.tooth_mesh",
)
@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("case", NAMES)
def test_the_volume_converges_with_the_level(case, body):
    found = [
        volume(mesh.nodes, mesh.hexes)
        for mesh in (mesh_of(case, body, level) for level in ("coarse", "medium", "fine"))
    ]
    assert abs(found[2] - found[1]) < abs(found[1] - found[0]) / 4
    agrees("volume of a tooth, m3", found[2], found[1], relative=1e-6)
