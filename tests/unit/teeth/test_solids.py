"""Whole teeth as closed surfaces, and the CAD files made of them."""

import gmsh
import meshio
import numpy as np
import pytest
from references import against, agrees

import facegear
from facegear.errors import NotConverged
from facegear.io.cad import write_step, write_stl
from facegear.quantities import BODIES
from facegear.teeth import face_gear
from facegear.teeth.flank_shapes import Relief
from facegear.teeth.solids import solid, triangles, volume
from facegear.teeth.surfaces import flank_points

TEETH = 2


def exact_volume(design, body):
    """Volume extrapolated from chords at 64 and 128 cells, whose error falls with the square of the cell."""
    coarse, fine = (volume(solid(design, body, TEETH, n + 1, n // 2 + 1)) for n in (64, 128))
    return fine + (fine - coarse) / 3


@pytest.fixture(scope="module", params=BODIES)
def body(request):
    return request.param


@pytest.mark.parametrize("teeth", [1, 2, 23])
def test_surfaces_close_and_face_outwards(pair, body, teeth):
    corners = np.round(1e9 * triangles(solid(pair(), body, teeth, profile=7, width=3)))
    _, points = np.unique(corners.reshape(-1, 3) + 0.0, axis=0, return_inverse=True)
    cells = points.reshape(-1, 3)
    edges = np.concatenate([cells[:, [a, b]] for a, b in ((0, 1), (1, 2), (2, 0))])
    forwards, backwards = ({tuple(edge) for edge in way.tolist()} for way in (edges, edges[:, ::-1]))
    assert len(forwards) == len(edges)
    assert forwards == backwards
    assert volume(solid(pair(), body, teeth, profile=7, width=3)) > 0


@against(
    "third-party program",
    "OpenCASCADE: volume of the solid and nearest points of its faces",
    capability="cad export",
    module="facegear.io.cad",
)
def test_step_has_the_volume_and_the_flanks_of_the_exact_teeth(pair, body, tmp_path):
    design = pair(tip_relief=Relief(20e-6, 0.0, 2e-3), thinning=1e-4)
    file = tmp_path / "teeth.step"
    message = write_step(file, solid(design, body, TEETH), body)
    agrees(
        "volume of the solid, m3", message, exact_volume(design, body), relative=5e-5
    )  # OpenCASCADE's quadrature
    agrees(
        "distance of exact flank points from the faces, m",
        _distance(file, _flank(design, body)),
        0.0,
        absolute=50e-9,
    )


def test_step_has_one_product_with_the_name_of_case_and_body_and_no_loose_points(tmp_path):
    for body, words in (("pinion", "pinion"), ("face_gear", "face gear")):
        file = facegear.example().export(tmp_path / f"{body}.step", body, teeth=1)
        gmsh.initialize(interruptible=False)
        try:
            gmsh.option.setNumber("General.Terminal", 0)
            gmsh.model.occ.importShapes(str(file), highestDimOnly=False)
            gmsh.model.occ.synchronize()
            ((_, solid_tag),) = gmsh.model.getEntities(3)
            assert gmsh.model.getEntityName(3, solid_tag).endswith(f"/example, {words}")
            corners = gmsh.model.getBoundary([(3, solid_tag)], recursive=True)
            assert len(gmsh.model.getEntities(0)) == len(corners)
        finally:
            gmsh.finalize()
        text = file.read_text()
        assert "translator" not in text and f"FILE_NAME('example, {words}'" in text


def _flank(design, body):
    """Points of the right flank of tooth 0, none of them on the grid that the file was made from."""
    share = np.linspace(0.03, 0.97, 6)[:, None]
    if body == "pinion":
        low = design.pinion_tip_roll - 0.3
        y = design.mean_radius + design.pinion.width * np.array([[-0.41, 0.13, 0.37]])
        return flank_points(design, low + 0.3 * share, y).position.reshape(-1, 3)
    radius = np.array([[0.2511, 0.2637, 0.2742]])
    top, _ = face_gear.tip_parameters(design, radius)
    roll = top + share * (design.shaper_tip_roll - top)
    return face_gear.flank_point(design, roll, face_gear.psi_at(design, radius, roll)).reshape(-1, 3)


def _distance(file, points):
    """Largest distance (m) of points from the surfaces in a STEP file."""
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.model.occ.importShapes(str(file))
        gmsh.model.occ.synchronize()
        assert len(gmsh.model.getEntities(3)) == 1
        flat = (1e3 * points).ravel()
        nearest = np.full(len(points), np.inf)
        for _, tag in gmsh.model.getEntities(2):
            closest, _ = gmsh.model.getClosestPoint(2, tag, flat)
            apart = np.linalg.norm((np.asarray(closest) - flat).reshape(-1, 3), axis=1)
            nearest = np.minimum(nearest, apart)
        return 1e-3 * nearest.max()
    finally:
        gmsh.finalize()


@against(
    "third-party program",
    "meshio reads the file",
    capability="cad export",
    module="facegear.io.cad",
)
def test_stl_holds_the_triangles_in_millimetres(pair, body, tmp_path):
    corners = triangles(solid(pair(), body, TEETH))
    write_stl(tmp_path / "teeth.stl", corners)
    read = meshio.read(tmp_path / "teeth.stl")
    agrees(
        "corners of the triangles, mm",
        read.points[read.cells_dict["triangle"]],
        1e3 * corners,
        relative=1e-7,
        absolute=2e-5,
    )


def test_patches_that_do_not_close_are_refused(pair, tmp_path):
    with pytest.raises(NotConverged, match="33 patches do not close"):
        write_step(tmp_path / "open.step", solid(pair(), "pinion", 1)[:-1], "pinion")
    assert not list(tmp_path.iterdir())
