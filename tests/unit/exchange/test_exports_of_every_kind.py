"""STEP, STL, glTF and mesh files of helical, tapered, offset and asymmetric teeth, from a config."""

import gmsh
import pytest
import trimesh
from kinds_of_teeth import public_section
from public_teeth import NAMES
from references import against, agrees

import facegear
from facegear.build.tooth_pair import pair_design
from facegear.pipeline.stages.tooth_bodies import mesh
from facegear.quantities import BODIES
from facegear.schema.contact import Mesh
from facegear.teeth.mesh_quality import volume as mesh_volume
from facegear.teeth.mesh_sizes import named_sizes
from facegear.teeth.tooth_mesh import gear_tooth, pinion_tooth

BUILDERS = {"pinion": pinion_tooth, "face_gear": gear_tooth}


def gearbox_of(name):
    return facegear.load({"case": "kind", "tooth_pair": public_section(name)}, results=None)


def step_volume(path):
    """Volume (m3) of the solid in a STEP file, as OpenCASCADE reads it."""
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.model.occ.importShapes(str(path))
        gmsh.model.occ.synchronize()
        ((_, tag),) = gmsh.model.getEntities(3)
        return 1e-9 * gmsh.model.occ.getMass(3, tag)
    finally:
        gmsh.finalize()


@against(
    "third-party program",
    "OpenCASCADE and trimesh: volume of the files' solids beside the finite elements",
    capability="cad export",
    module="facegear.teeth.solids",
)
@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("name", NAMES)
def test_step_and_stl_hold_the_volume_of_the_mesh(name, body, tmp_path):
    gearbox = gearbox_of(name)
    design = pair_design(gearbox.config.tooth_pair)
    tooth = BUILDERS[body](design, named_sizes("medium", design.module))
    expected = 2 * mesh_volume(tooth.nodes, tooth.hexes)
    step, stl = (gearbox.export(tmp_path / f"teeth.{ending}", body, teeth=2) for ending in ("step", "stl"))
    agrees("volume of the STEP file's solid, m3", step_volume(step), expected, relative=5e-5)
    shape = trimesh.load(stl)
    assert shape.is_watertight
    agrees("volume of the STL file's triangles, m3", 1e-9 * shape.volume, expected, relative=1e-3)


@pytest.mark.parametrize("name", NAMES)
def test_a_scene_is_written_from_the_config(name, tmp_path):
    scene = trimesh.load(gearbox_of(name).export(tmp_path / "pair.glb"))
    assert set(scene.geometry) == set(BODIES)


@pytest.mark.parametrize("name", NAMES)
def test_the_mesh_stage_takes_every_kind(name):
    outcome = mesh(gearbox_of(name).config.tooth_pair, Mesh())
    quality = outcome.content["quality"].set_index(["body", "quantity", "statistic"])["value"]
    for body in BODIES:
        assert quality[body, "scaled_jacobian", "quantile_0"] > 0.1
        assert len(outcome.content[f"{body}_msh"]) > 0
