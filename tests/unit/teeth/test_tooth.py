"""A tooth's mesh: on the exact surface, valid everywhere, mirror symmetric, matching across its cuts."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from references import against, agrees
from skfem import ElementHex2, FacetBasis

from facegear.errors import InvalidInput
from facegear.teeth import face_gear, face_gear_fillet, pinion
from facegear.teeth.curvature import smallest_radius
from facegear.teeth.mesh_quality import hex_mesh, require_right_side_out, scaled_jacobians, volume
from facegear.teeth.mesh_sizes import RESOLUTIONS, named_sizes, thin_fillet
from facegear.teeth.tooth_mesh import CORNERS, gear_tooth, pinion_tooth


def surface_points(design, body, name, grid):
    if body == "pinion":
        section = pinion.involute_point if name == "flank" else pinion.trochoid_point
        return pinion.cartesian(*section(design, grid.u, grid.v), grid.v)
    if name == "flank":
        return face_gear.flank_point(design, grid.u, grid.v)
    return face_gear.cylindrical(grid.v, *face_gear_fillet.fillet_section(design, grid.v, grid.u))


@against(
    "analytic",
    "equations of flank and fillet",
    capability="mesh",
    module="facegear.teeth.tooth_mesh",
)
@pytest.mark.parametrize("level", RESOLUTIONS)
@pytest.mark.parametrize("build", [pinion_tooth, gear_tooth])
def test_flank_and_fillet_nodes_lie_on_the_analytic_surface_at_every_level(design, build, level):
    mesh = build(design, named_sizes(level, design.module))
    for name in ("flank", "fillet"):
        for side, sign in (("right", 1), ("left", -1)):
            grid = mesh.surfaces[f"{name}_{side}"]
            exact = surface_points(design, mesh.body, name, grid) * [sign, 1, 1]
            agrees("distance of nodes from the surface, m", mesh.nodes[grid.nodes], exact, absolute=1e-12)
    assert scaled_jacobians(mesh.nodes, mesh.hexes).min() > 0


def test_a_mesh_with_an_element_turned_inside_out_is_refused(design):
    mesh = pinion_tooth(design, named_sizes("coarse", design.module))
    require_right_side_out(mesh)
    nodes = mesh.nodes.copy()
    nodes[mesh.hexes[0, 13]] = nodes[mesh.hexes[-1, 13]]
    with pytest.raises(InvalidInput, match=r"element size = '1 elements of the pinion turned inside out'"):
        require_right_side_out(replace(mesh, nodes=nodes))


@pytest.mark.parametrize("level", ["coarse", "medium"])
@pytest.mark.parametrize("build", [pinion_tooth, gear_tooth])
def test_a_thin_fillet_changes_no_surface_and_its_first_row_is_as_deep_as_its_sharpness_allows(
    design, build, level
):
    sizes = thin_fillet(named_sizes(level, design.module), level)
    plain, thin = (build(design, one) for one in (replace(sizes, fillet_depth=None), sizes))
    assert scaled_jacobians(thin.nodes, thin.hexes).min() > 0
    moved = np.linalg.norm(thin.nodes - plain.nodes, axis=1) > 1e-12
    for name in ("flank_right", "fillet_right"):
        assert not moved[thin.surfaces[name].nodes].any()
    fillet = thin.surfaces["fillet_right"].nodes[len(thin.surfaces["fillet_right"].nodes) // 2]
    below = np.isin(thin.hexes, fillet).any(axis=1)
    inner = [np.setdiff1d(one.hexes[below], one.surfaces["fillet_right"].nodes) for one in (thin, plain)]
    depths = [
        np.linalg.norm(one.nodes[rows][:, None] - one.nodes[fillet], axis=2).min(axis=0).mean()
        for one, rows in zip((thin, plain), inner, strict=True)
    ]
    sharpest = 0.6 * smallest_radius(design, thin.body)
    wanted = min(sizes.fillet_depth, max(sharpest, 0.5 * sizes.fillet_depth))
    assert depths[0] == pytest.approx(wanted / sizes.profile * depths[1], rel=0.3)


def test_opposite_side_is_the_exact_mirror(tooth):
    mirrored = tooth.nodes * [-1, 1, 1]
    order = np.lexsort(np.round(tooth.nodes / 1e-10).T)
    mirrored_order = np.lexsort(np.round(mirrored / 1e-10).T)
    np.testing.assert_allclose(tooth.nodes[order], mirrored[mirrored_order], atol=1e-15)


def test_one_cut_face_turned_by_a_pitch_is_the_other(tooth):
    turned = tooth.rotated(tooth.nodes[tooth.cut_left], tooth.pitch)
    assert np.max(np.abs(turned - tooth.nodes[tooth.cut_right])) < 1e-15
    assert set(np.unique(tooth.faces["cut_left"])) == set(tooth.cut_left)
    assert set(np.unique(tooth.faces["cut_right"])) == set(tooth.cut_right)


@against(
    "analytic",
    "Gauss' theorem: closed surface and volume",
    capability="mesh",
    module="facegear.teeth.tooth_mesh",
)
def test_boundary_groups_close_the_tooth(tooth):
    """Every boundary face belongs to exactly one group, and the outward area vectors of all cancel."""
    faces = np.concatenate(list(tooth.faces.values()))
    sides = tooth.hexes[:, [4, 10, 12, 14, 16, 22]].ravel()
    middle, count = np.unique(sides, return_counts=True)
    assert set(middle[count == 1]) == set(faces[:, 4])
    assert len(np.unique(faces[:, 4])) == len(faces)
    mesh, number = hex_mesh(tooth.nodes, tooth.hexes)
    outside = mesh.boundary_facets()
    assert set(number[faces[:, 4]]) == set(mesh.dofs.facet_dofs[0, outside])
    # Small elements far from the origin have coordinates of fewer digits than scikit-fem asks for.
    mapping = mesh.mapping()
    mapping.invF = partial(mapping.invF, newton_tol=1e-7)
    basis = FacetBasis(mesh, ElementHex2(), mapping=mapping, facets=outside, intorder=5)
    flux = (basis.normals * basis.dx).sum(axis=(1, 2))
    agrees("sum of the area vectors, m2", np.linalg.norm(flux), 0.0, absolute=1e-15)
    position = np.asarray(basis.global_coordinates())
    agrees(
        "volume of a tooth, m3",
        (position * basis.normals * basis.dx).sum() / 3,
        volume(tooth.nodes, tooth.hexes),
        relative=1e-9,
    )


def test_elements_are_conforming(tooth):
    """Two elements that share four corners share the nine nodes of the face between them."""
    sides = [
        np.array([i + 3 * j + 9 * k for i, j, k in np.ndindex(3, 3, 3) if (i, j, k)[axis] == end])
        for axis in range(3)
        for end in (0, 2)
    ]
    seen = {}
    for side in sides:
        for face in tooth.hexes[:, side]:
            corners = tuple(sorted(face[[0, 2, 6, 8]]))
            assert seen.setdefault(corners, sorted(face)) == sorted(face)


@against(
    "own convergence",
    "volume of the next finer level",
    capability="mesh",
    module="facegear.teeth.tooth_mesh",
)
def test_volume_error_falls_eightfold_or_more_from_level_to_rung(design):
    """Only the profile size halves, width and thickness fall less: short of the O(h^4) of the geometry."""
    for build in (pinion_tooth, gear_tooth):
        found = [
            volume(mesh.nodes, mesh.hexes)
            for mesh in (
                build(design, named_sizes(level, design.module)) for level in ("coarse", "medium", "fine")
            )
        ]
        assert abs(found[2] - found[1]) < abs(found[1] - found[0]) / 8
        agrees("volume of a tooth, m3", found[2], found[1], relative=1e-6)


def test_straight_corner_view_is_right_handed(tooth):
    corners = tooth.nodes[tooth.hexes[:, CORNERS]]
    edges = corners[:, [1, 2, 4]] - corners[:, [0]]
    assert np.all(np.linalg.det(edges) > 0)
    mesh, _ = hex_mesh(tooth.nodes, tooth.hexes)
    assert (mesh.mapping().detDF(np.full((3, 1), 0.5)) > 0).all()


@against(
    "analytic",
    "area between involute and chamfer times the width",
    capability="mesh",
    module="facegear.teeth.tooth_mesh",
)
def test_tip_chamfer_is_part_of_the_outline(design):
    chamfered = replace(design, pinion=replace(design.pinion, tip_chamfer=0.3e-3))
    mesh, plain = (pinion_tooth(d, named_sizes("coarse", design.module)) for d in (chamfered, design))
    assert scaled_jacobians(mesh.nodes, mesh.hexes).min() > 0
    radius = np.linspace(chamfered.pinion_tip_radius - 0.3e-3, chamfered.pinion_tip_radius, 2001)
    roll = np.sqrt((radius / design.pinion_base_radius) ** 2 - 1)
    involute = pinion.involute_point(design, roll, design.middle)[1]
    chamfer = np.linspace(involute[0], pinion.tip_half_angle(chamfered, chamfered.middle), 2001)
    expected = 2 * np.trapezoid((involute - chamfer) * radius, radius) * design.pinion.width
    removed = volume(plain.nodes, plain.hexes) - volume(mesh.nodes, mesh.hexes)
    agrees("volume that the chamfer takes away, m3", removed, expected, relative=1e-2)
