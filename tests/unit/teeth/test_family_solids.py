"""Solids of helical, tapered, offset and asymmetric teeth: closed, as large as their meshes, alike in the
mirror."""

from functools import cache

import numpy as np
import pytest
from family_pairs import public_pair, random_pairs
from measured_flanks import constant, sampled, with_grid
from public_teeth import NAMES
from references import against, agrees
from scipy.spatial import cKDTree

from facegear.io.cad import write_step
from facegear.quantities import BODIES
from facegear.teeth.flank_shapes import Relief
from facegear.teeth.mesh_quality import volume as mesh_volume
from facegear.teeth.mesh_sizes import named_sizes
from facegear.teeth.placement import mirror_teeth
from facegear.teeth.solids import solid, triangles, volume
from facegear.teeth.tooth_mesh import gear_tooth, pinion_tooth

RANDOM = 3
CASES = (*NAMES, *range(RANDOM))
BUILDERS = {"pinion": pinion_tooth, "face_gear": gear_tooth}


@cache
def pairs():
    return {name: public_pair(name) for name in NAMES} | dict(enumerate(random_pairs(RANDOM)))


def exact_volume(design, body):
    """Volume of a tooth, m3, extrapolated from chords at 64 and 128 cells, whose error falls with their
    square."""
    coarse, fine = (volume(solid(design, body, 1, n + 1, n // 2 + 1)) for n in (64, 128))
    return fine + (fine - coarse) / 3


def assert_closed(patches):
    corners = np.round(1e9 * triangles(patches))
    _, points = np.unique(corners.reshape(-1, 3) + 0.0, axis=0, return_inverse=True)
    cells = points.reshape(-1, 3)
    edges = np.concatenate([cells[:, [a, b]] for a, b in ((0, 1), (1, 2), (2, 0))])
    forwards, backwards = ({tuple(edge) for edge in way.tolist()} for way in (edges, edges[:, ::-1]))
    assert len(forwards) == len(edges)
    assert forwards == backwards


@pytest.mark.parametrize("teeth", [1, 3])
@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("case", CASES)
def test_patches_close_and_face_outwards(case, body, teeth):
    patches = solid(pairs()[case], body, teeth, profile=7, width=5)
    assert_closed(patches)
    assert volume(patches) > 0


@pytest.mark.parametrize("body", BODIES)
def test_patches_of_a_whole_helical_gear_close(body):
    assert_closed(solid(public_pair("P1"), body, profile=5, width=3))


@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("case", ["spur", "P1"])
def test_patches_close_where_one_flank_deviates_and_the_other_does_not(case, body, pair):
    design = pair() if case == "spur" else pairs()[case]
    flank = "right" if body == "pinion" else "left"
    deviation = constant(-12.3e-6)
    design = with_grid(design, body, sampled(design, body, deviation), flank)
    assert_closed(solid(design, body, 2, profile=7, width=5))


@pytest.mark.parametrize("body", BODIES)
def test_patches_close_around_reliefs_and_a_chamfer(body):
    design = public_pair("P2", tip_relief=Relief(20e-6, 0.0, 1e-3), tip_chamfer=0.3e-3)
    assert_closed(solid(design, body, 2, profile=7, width=5))


@against(
    "analytic",
    "Gauss' theorem: volume within the patches and of the finite elements",
    capability="mesh",
    module="facegear.teeth.solids",
)
@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("case", CASES)
def test_a_closed_tooth_is_as_large_as_its_mesh(case, body):
    design = pairs()[case]
    mesh = BUILDERS[body](design, named_sizes("fine", design.module))
    agrees(
        "volume of a tooth, m3",
        exact_volume(design, body),
        mesh_volume(mesh.nodes, mesh.hexes),
        relative=2e-7,
    )


@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("case", CASES)
def test_a_solid_seen_in_a_mirror_is_that_of_the_mirrored_teeth(case, body):
    design = pairs()[case]
    here, there = (solid(one, body, 1, 9, 5) for one in (design, mirror_teeth(design)))
    points, others = (np.concatenate([part.reshape(-1, 3) for part in parts]) for parts in (here, there))
    assert cKDTree(others).query(points * [-1.0, 1.0, 1.0])[0].max() < 1e-15
    assert len(points) == len(others)


@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("case", NAMES)
def test_the_ends_of_a_meshs_flanks_are_edges_of_the_patches(case, body):
    """The solid takes its flanks as made, the mesh as generated."""
    design = pairs()[case]
    mesh = BUILDERS[body](design, named_sizes("coarse", design.module))
    patches = solid(design, body, 1, 17, len(mesh.surfaces["flank_right"].nodes[0]))
    points = np.concatenate([part.reshape(-1, 3) for part in patches])
    for side in ("left", "right"):
        ends = mesh.nodes[mesh.surfaces[f"flank_{side}"].nodes[[0, -1]]].reshape(-1, 3)
        apart = np.linalg.norm(points[:, None] - ends, axis=-1).min(axis=0)
        assert apart.max() < 1e-12


@against(
    "third-party program",
    "OpenCASCADE: volume of the solid",
    capability="cad export",
    module="facegear.io.cad",
)
@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("case", ["P1", "P2", "P4"])
def test_a_step_file_has_the_volume_of_the_exact_teeth(case, body, tmp_path):
    design = pairs()[case]
    message = write_step(tmp_path / "tooth.step", solid(design, body, 1), body)
    agrees("volume of the solid, m3", message, exact_volume(design, body), relative=5e-5)
