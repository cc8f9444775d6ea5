"""Mesh files: what is written is what was meshed, in each program's own node order."""

import re
import shutil
import subprocess

import gmsh
import meshio
import numpy as np
import pandas as pd
import pytest
from mesh_files import read_msh
from references import against, agrees

from facegear.io.cad import gmsh_session
from facegear.teeth.mesh_files import SERENDIPITY20, VTK27, write_files
from facegear.teeth.mesh_quality import volume
from facegear.teeth.tooth_mesh import sector


@pytest.fixture(scope="module")
def written(tooth, tmp_path_factory):
    folder = tmp_path_factory.mktemp("mesh")
    merged = sector(tooth, 2)
    files = [folder / f"body.{suffix}" for suffix in ("msh", "vtu", "inp")]
    return merged, files, write_files(merged, *files)


def test_msh_keeps_volume_and_named_groups(written):
    merged, (msh, _, _), _ = written
    nodes, hexes, groups = read_msh(msh)
    inverse = np.argsort(VTK27)
    assert volume(nodes, hexes[:, inverse]) == pytest.approx(volume(merged.nodes, merged.hexes), rel=1e-12)
    for name in merged.tooth.faces:
        assert len(groups[name]) == len(merged.faces(name))
    middle = nodes[groups["flank_left"][:, 8]]
    expected = merged.nodes[merged.faces("flank_left")[:, 4]]
    np.testing.assert_allclose(np.sort(middle, axis=0), np.sort(expected, axis=0), atol=1e-15)


@against(
    "third-party program",
    "gmsh: volume of all elements of the file",
    capability="mesh",
    module="facegear.teeth.mesh_files",
)
def test_gmsh_measures_the_same_volume_and_no_inverted_element(written):
    merged, (msh, _, _), table = written
    with gmsh_session("read"):
        gmsh.open(str(msh))
        tags, _ = gmsh.model.mesh.getElementsByType(12)
        volumes = gmsh.model.mesh.getElementQualities(tags, "volume")
        smallest = gmsh.model.mesh.getElementQualities(tags, "minDetJac").min()
    agrees("volume of the mesh, m3", volumes.sum(), volume(merged.nodes, merged.hexes), relative=1e-10)
    assert smallest > 0
    worst = table.query("quantity == 'min_sicn' and statistic == 'quantile_0'")["value"].item()
    assert worst > 0


@against(
    "third-party program",
    "meshio reads the file",
    capability="mesh",
    module="facegear.teeth.mesh_files",
)
def test_vtu_holds_the_same_cells(written):
    merged, (_, vtu, _), _ = written
    mesh = meshio.read(vtu)
    np.testing.assert_array_equal(mesh.cells_dict["hexahedron27"], merged.hexes[:, VTK27])
    agrees("nodes of the mesh, m", mesh.points, merged.nodes, relative=1e-7, absolute=1e-15)
    assert mesh.cell_data_dict["scaled_jacobian"]["hexahedron27"].min() > 0


def test_inp_holds_nodes_elements_sets_and_surfaces(written):
    merged, (_, _, inp), _ = written
    text = inp.read_text()
    blocks = dict(re.findall(r"\*(NODE, NSET=ALL_NODES|ELEMENT[^\n]*)\n([^*]*)", text))
    # a line of an element that goes on ends with a comma
    joined = blocks["ELEMENT, TYPE=C3D20, ELSET=BODY"].replace(",\n", ",")
    elements = np.array([line.split(",") for line in joined.splitlines()], dtype=int)
    np.testing.assert_array_equal(elements[:, 1:] - 1, merged.hexes[:, SERENDIPITY20])
    for name in merged.tooth.faces:
        assert f"*NSET, NSET={name.upper()}\n" in text
        surface = text.split(f"*SURFACE, NAME={name.upper()}_SURFACE, TYPE=ELEMENT\n")[1].split("*")[0]
        assert len(surface.split("\n")) - 1 == len(merged.faces(name))


def test_inp_surfaces_name_the_right_sides(written):
    merged, (_, _, inp), _ = written
    sides = {
        "S1": (0, 1, 2, 3),
        "S2": (4, 7, 6, 5),
        "S3": (0, 4, 5, 1),
        "S4": (1, 5, 6, 2),
        "S5": (2, 6, 7, 3),
        "S6": (3, 7, 4, 0),
    }
    text = inp.read_text().split("*SURFACE, NAME=FLANK_RIGHT_SURFACE, TYPE=ELEMENT\n")[1].split("*")[0]
    flank = {tuple(sorted(face[[0, 2, 6, 8]])) for face in merged.faces("flank_right")}
    for line in text.split("\n")[:-1]:
        element, side = line.split(", ")
        corners = merged.hexes[int(element) - 1, SERENDIPITY20][list(sides[side])]
        assert tuple(sorted(corners)) in flank


@pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX is not installed")
def test_calculix_reads_the_deck(written, tmp_path):
    """It makes the matrix of every element, and solves for displacements along the axis alone."""
    _, (_, _, inp), _ = written
    deck = inp.read_text() + (
        "*MATERIAL, NAME=STEEL\n*ELASTIC\n2.06E11, 0.3\n*SOLID SECTION, ELSET=BODY, MATERIAL=STEEL\n"
        "*BOUNDARY\nALL_NODES, 1, 2\nCUT_LEFT, 3, 3\n*STEP\n*STATIC\n*CLOAD\n1, 3, 1.\n*END STEP\n"
    )
    (tmp_path / "deck.inp").write_text(deck)
    run = subprocess.run(["ccx", "deck"], cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert "Job finished" in run.stdout


def test_quality_table_counts_what_is_there(written):
    merged, _, table = written
    assert isinstance(table, pd.DataFrame)
    values = table.set_index(["quantity", "statistic"])["value"]
    assert values["elements", "count"] == len(merged.hexes)
    assert values["volume_mm3", "sum"] == pytest.approx(1e9 * volume(merged.nodes, merged.hexes))
    quantiles = values["scaled_jacobian"].to_numpy()
    assert np.all(np.diff(quantiles) >= 0)
    assert quantiles[0] > 0
