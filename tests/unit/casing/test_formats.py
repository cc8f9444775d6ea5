"""Each file format gives the matrices that were written, and bad files are refused in one line."""

from pathlib import Path

import numpy as np
import pytest
import scipy

from facegear.casing.files import read_casing
from facegear.casing.whole import require_free, require_mass
from facegear.errors import InvalidInput
from tests.helpers import casing_files as files

PROGRAMS = Path(__file__).with_name("programs")
SI = np.tile(np.repeat([1e3, 1.0], 3), 2)
SUBSTRUCTURE = """*USER ELEMENT,NODES=2,LINEAR
** ELEMENT NODES
** 101, 205
1,2,3,4,5,6
*MATRIX,TYPE=STIFFNESS
{stiffness}
*MATRIX,TYPE=MASS
{mass}
"""


def read(units="mm_t_s", **names):
    return read_casing(
        {key: names.get(key) for key in ("stiffness", "mass", "damping", "nodes", "dofs")}, units
    )


def by_label(casing, matrix):
    """A matrix with rows in the order of the beam."""
    order = [casing.rows_of_node[node][direction] for node, direction in files.rows()]
    return matrix.toarray()[np.ix_(order, order)]


def write(kind, folder):
    """Names of the beam's files in one format."""
    stiffness, mass = files.beam_matrices()
    nodes = files.write_nodes(folder)
    if kind == "csv":
        return {
            "stiffness": files.write_csv(folder / "k.csv", stiffness),
            "mass": files.write_csv(folder / "m.csv", mass),
            "dofs": files.write_dofs(folder),
            "nodes": nodes,
        }
    if kind == "npz":
        path = folder / "beam.npz"
        places = np.array([[101, 0, 0, 0], [205, files.LENGTH, 0, 0]])
        np.savez(path, stiffness=stiffness, mass=mass, dofs=np.array(files.rows()), nodes=places)
        return {"stiffness": str(path)}
    if kind == "coordinates":
        return {
            "stiffness": files.write_coordinates(folder / "k.mtx", stiffness),
            "mass": files.write_coordinates(folder / "m.mtx", mass),
            "nodes": nodes,
        }
    if kind == "substructure":
        path = folder / "beam.mtx"
        rows = np.tril_indices(12)
        texts = [",\n".join(f"{value:.17e}" for value in matrix[rows]) for matrix in (stiffness, mass)]
        path.write_text(SUBSTRUCTURE.format(stiffness=texts[0], mass=texts[1]))
        return {"stiffness": str(path), "nodes": nodes}
    if kind == "matrix_market":
        return {
            "stiffness": files.write_matrix_market(folder / "k.mtx", stiffness),
            "mass": files.write_matrix_market(folder / "m.mtx", mass),
            "dofs": files.write_dofs(folder),
            "nodes": nodes,
        }
    return {"stiffness": str(PROGRAMS / "beam_pynastran.pch"), "nodes": nodes}


@pytest.mark.parametrize(
    ("kind", "digits"),
    [
        ("csv", 1e-15),
        ("npz", 1e-15),
        ("coordinates", 1e-14),
        ("substructure", 1e-15),
        ("matrix_market", 1e-15),
        ("nastran", 2e-10),
    ],
)
def test_every_format_gives_the_beam_in_si(kind, digits, tmp_path):
    casing = read(**write(kind, tmp_path))
    for matrix, expected in zip((casing.stiffness, casing.mass), files.beam_matrices(), strict=True):
        expected = 1e-3 * expected * np.outer(SI, SI)
        size = np.sqrt(np.outer(np.diagonal(expected), np.diagonal(expected)))
        np.testing.assert_allclose(by_label(casing, matrix) / size, expected / size, rtol=0, atol=digits)


def test_matrices_in_si_give_the_same_casing(tmp_path):
    (tmp_path / "si").mkdir()
    stiffness, mass = (1e-3 * matrix * np.outer(SI, SI) for matrix in files.beam_matrices())
    names = {
        "stiffness": files.write_csv(tmp_path / "si" / "k.csv", stiffness),
        "mass": files.write_csv(tmp_path / "si" / "m.csv", mass),
        "dofs": files.write_dofs(tmp_path),
        "nodes": files.write_nodes(tmp_path),
    }
    first, second = read("si", **names), read(**write("csv", tmp_path))
    np.testing.assert_allclose(first.stiffness.toarray(), second.stiffness.toarray(), rtol=1e-14)
    np.testing.assert_allclose(first.mass.toarray(), second.mass.toarray(), rtol=1e-14)


def test_calculix_matrices_are_those_of_two_free_cubes(tmp_path):
    corners = [(x, y) for x, y in ((0, 0), (10, 0), (10, 10), (0, 10))]
    numbers = [1, 2, 3, 4, 5, 6, 7, 8, 11, 12, 13, 14]
    lines = [
        f"{number},{x},{y},{z}"
        for number, (x, y, z) in zip(
            numbers, [(x, y, z) for z in (0, 10, 20) for x, y in corners], strict=True
        )
    ]
    (tmp_path / "nodes.csv").write_text("\n".join(["node,x_mm,y_mm,z_mm", *lines]) + "\n")
    casing = read(stiffness=str(PROGRAMS / "box_calculix.sti"), nodes=str(tmp_path / "nodes.csv"))
    require_free(casing)
    require_mass(casing, 2700 * 2e-6)
    assert casing.size == 36
    assert casing.rigid_force() < 1e-13
    assert casing.total_mass == pytest.approx(2700 * 2e-6, rel=1e-12)


def test_substructures_of_calculix_are_strained_by_rigid_motions(tmp_path):
    # Version 2.20 writes the block of the retained rows without condensation.
    (tmp_path / "nodes.csv").write_text("node,x_mm,y_mm,z_mm\n1,0,0,0\n14,0,10,20\n")
    casing = read(stiffness=str(PROGRAMS / "box_substructure.mtx"), nodes=str(tmp_path / "nodes.csv"))
    assert casing.size == 6
    with pytest.raises(InvalidInput, match="free of its feet"):
        require_free(casing)


def test_rows_in_order_of_appearance_are_told_by_their_names(tmp_path):
    order = [row for pair in zip(files.rows()[:6], files.rows()[6:], strict=True) for row in pair]
    at = [files.rows().index(row) for row in order]
    stiffness, mass = (matrix[np.ix_(at, at)] for matrix in files.beam_matrices())
    names = {
        "stiffness": files.write_csv(tmp_path / "k2.csv", stiffness),
        "mass": files.write_csv(tmp_path / "m2.csv", mass),
        "dofs": files.write_dofs(tmp_path, order),
        "nodes": files.write_nodes(tmp_path),
    }
    casing = read(**names)
    require_free(casing)
    expected = 1e-3 * files.beam_matrices()[0] * np.outer(SI, SI)
    np.testing.assert_allclose(by_label(casing, casing.stiffness), expected, rtol=1e-14)


def test_rows_in_the_wrong_order_are_refused(tmp_path):
    names = write("csv", tmp_path)
    names["dofs"] = files.write_dofs(tmp_path, sorted(files.rows(), key=lambda row: row[::-1]))
    with pytest.raises(InvalidInput, match="free of its feet"):
        require_free(read(**names))


def test_nodes_in_another_unit_are_refused(tmp_path):
    names = write("csv", tmp_path)
    names["nodes"] = files.write_nodes(tmp_path, scale=1e-3)
    with pytest.raises(InvalidInput, match="free of its feet"):
        require_free(read(**names))


@pytest.mark.parametrize(("units", "likely"), [("si", "mm_t_s"), ("mm_t_s", "si")])
def test_a_mass_off_by_a_thousand_names_the_likely_unit(units, likely, tmp_path):
    casing = read(units, **write("csv", tmp_path))
    wrong = casing.total_mass * (1e3 if likely == "mm_t_s" else 1e-3)
    with pytest.raises(InvalidInput, match=f"units {likely}"):
        require_mass(casing, wrong)


def test_a_heavy_unit_is_doubted_without_a_known_mass(tmp_path):
    with pytest.raises(InvalidInput, match="units mm_t_s"):
        require_mass(read("si", **write("csv", tmp_path)), None)


def test_one_triangle_given_as_a_whole_matrix_is_refused(tmp_path):
    names = write("csv", tmp_path)
    files.write_csv(Path(names["stiffness"]), np.tril(files.beam_matrices()[0]))
    with pytest.raises(InvalidInput, match="symmetric to 1e-08: is one triangle of it missing"):
        read(**names)


def test_a_skew_part_above_rounding_is_refused(tmp_path):
    names, stiffness = write("csv", tmp_path), files.beam_matrices()[0]
    stiffness[1, 5] *= 1.0 + 1e-7
    files.write_csv(Path(names["stiffness"]), stiffness)
    with pytest.raises(InvalidInput, match="symmetric"):
        read(**names)


@pytest.mark.parametrize(
    ("key", "content", "reason"),
    [
        ("dofs", "node,dof\n101,1\n", "stiffness of the casing.*it has 12 rows and 12 columns, but 1 dof"),
        ("dofs", "row,dof\n101,1\n", "first line must be node,dof"),
        ("dofs", "node,dof\n101,x\n", "whole numbers"),
        ("dofs", "node,dof\n101\n", "two whole numbers"),
        ("nodes", "node,x_mm,y_mm,z_mm\n101,0,0,0\n205.5,1,0,0\n", "numbers of nodes must be whole numbers"),
        ("stiffness", "", "it is empty"),
        ("stiffness", "\n\n", "it is empty"),
        ("nodes", "node,x_mm,y_mm,z_mm\n101,0,0,0\n", "node 205"),
        ("nodes", "node,x,y,z\n101,0,0,0\n", "first line must be node,x_mm,y_mm,z_mm"),
        ("nodes", "node,x_mm,y_mm,z_mm\n101,0,0,0\n101,1,0,0\n", "node 101 stands twice"),
        ("stiffness", "1,2\n3\n", "not a table of numbers"),
        ("mass", "1,2\n2,1\n", "it has 2 rows"),
    ],
)
def test_lists_and_tables_that_do_not_fit_are_refused(key, content, reason, tmp_path):
    names = write("csv", tmp_path)
    Path(names[key]).write_text(content)
    with pytest.raises(InvalidInput, match=reason) as refusal:
        read(**names)
    assert "of the casing = " in str(refusal.value)
    assert "\n" not in str(refusal.value)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(
    ("name", "change", "reason"),
    [
        ("stiffness", lambda matrix: matrix * (1.0 + 0.01j), "real numbers, not complex128"),
        ("stiffness", lambda matrix: matrix.astype(str), "real numbers"),
        ("stiffness", lambda matrix: matrix[0, 0], "shape of a single number"),
        ("dofs", lambda rows: rows + 0.5, "nodes and dofs must be whole numbers"),
        ("dofs", lambda rows: np.where(rows == 3, np.nan, rows), "nodes and dofs must be whole numbers"),
        ("nodes", lambda table: table + [0.5, 0, 0, 0], "numbers of nodes must be whole numbers"),
    ],
)
def test_arrays_of_an_npz_that_are_not_real_or_whole_are_refused(name, change, reason, tmp_path):
    names = write("npz", tmp_path)
    with np.load(names["stiffness"]) as archive:
        arrays = dict(archive)
    arrays[name] = change(arrays[name])
    np.savez(names["stiffness"], **arrays)
    with pytest.raises(InvalidInput, match=reason):
        read(**names)


def test_an_empty_npz_and_a_single_array_are_refused(tmp_path):
    path = tmp_path / "k.npz"
    path.write_bytes(b"")
    with pytest.raises(InvalidInput, match="it is no npz file"):
        read(stiffness=str(path))
    np.save(tmp_path / "k.npy", np.eye(12))
    (tmp_path / "k.npy").replace(path)
    with pytest.raises(InvalidInput, match=r"use np\.savez"):
        read(stiffness=str(path))


def test_a_complex_matrix_market_file_is_refused(tmp_path):
    names = write("matrix_market", tmp_path)
    path = Path(names["stiffness"])
    scipy.io.mmwrite(path, scipy.io.mmread(path) * (1.0 + 0.01j))
    with pytest.raises(InvalidInput, match="real numbers"):
        read(**names)


def test_lists_and_tables_of_a_spreadsheet_are_read(tmp_path):
    names = write("csv", tmp_path)
    before = read(**names)
    for name in names.values():
        Path(name).write_text(Path(name).read_text(), "utf-8-sig")
    after = read(**names)
    np.testing.assert_array_equal(after.stiffness.toarray(), before.stiffness.toarray())


def test_a_patch_may_have_letters_of_any_language(tmp_path):
    names = write("csv", tmp_path)
    text = "node,x_mm,y_mm,z_mm,patch\n101,0,0,0,Gehäuse\n205,100,0,0,\n"
    Path(names["nodes"]).write_text(text, "utf-8")
    assert read(**names).patches == ["Gehäuse", ""]


def test_rows_by_direction_first_are_told_by_the_mass(tmp_path):
    names = write("csv", tmp_path)
    rows = sorted(files.rows(), key=lambda row: row[::-1])
    text = "".join(f"{node},{direction}\n" for node, direction in rows)
    Path(names["dofs"]).write_text("node,dof\n" + text)
    with pytest.raises(InvalidInput, match="rows in another order than the dofs"):
        require_mass(read(**names), None)


def test_numbers_alone_need_a_list_of_dofs(tmp_path):
    for kind in ("csv", "matrix_market"):
        names = write(kind, tmp_path)
        with pytest.raises(InvalidInput, match="dofs must name node and dof"):
            read(**{**names, "dofs": None})


def test_op4_is_refused_as_it_does_not_name_its_rows(tmp_path):
    (tmp_path / "k.op4").write_text("      12      12       6       2KAAX    1P,3E23.16\n")
    with pytest.raises(InvalidInput, match="op4 does not name its rows"):
        read(stiffness=str(tmp_path / "k.op4"), nodes=files.write_nodes(tmp_path))


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(InvalidInput, match="no such file"):
        read(stiffness=str(tmp_path / "none.pch"), nodes=files.write_nodes(tmp_path))


def test_scalar_points_of_nastran_are_modes(tmp_path):
    (tmp_path / "k.pch").write_text(
        "DMIG,KAAX,0,6,1,0,,,2\nDMIG,KAAX,7,1,,7,1,5.0\nDMIG,KAAX,9001,0,,9001,0,2.5+3\n"
    )
    casing = read(stiffness=str(tmp_path / "k.pch"), nodes=write_single_node(tmp_path))
    assert casing.node.tolist() == [7, 0]
    np.testing.assert_allclose(casing.stiffness.diagonal(), [5e3, 2.5])


def write_single_node(folder):
    path = folder / "single.csv"
    path.write_text("node,x_mm,y_mm,z_mm\n7,0,0,0\n")
    return str(path)
