"""Files of the geometry and mesh stages, as users and later stages read them."""

import numpy as np
import pytest
from mesh_files import read_msh

from facegear.io import arrays, documents, tables

pytestmark = [pytest.mark.workflow, pytest.mark.xdist_group("workflow")]


@pytest.fixture
def results(quick):
    return quick.folder / "results" / "quick"


def test_pair_record_holds_radii_limits_path_and_gaps(results):
    record = documents.read(results / "geometry" / "pair.json", ["radii_mm", "limits_mm", "contact_ratio"])
    assert record["limits_mm"]["inner_undercut"] < record["radii_mm"]["gear_inner"]
    assert record["limits_mm"]["outer_pointing"] > record["radii_mm"]["gear_outer"]
    assert 1 < record["contact_ratio"] < 3
    assert record["interference"] is None
    assert record["smallest_gap"]["gap_um"] > 0
    for side in ("drive", "back"):
        path = np.array(record["unloaded"][side]["path_pinion_y_mm"])
        assert np.ptp(path) < 1e-2
    assert record["backlash_um"]["smallest"] == pytest.approx(
        1e6 * record["design_si"]["pinion"]["thinning"], abs=1e-3
    )


def test_flank_grids_are_points_in_space(results):
    grids = arrays.read(
        results / "geometry" / "flanks.npz",
        dict.fromkeys(("pinion_flank", "pinion_fillet", "gear_flank", "gear_fillet"), (None, None, 3)),
    )
    design = documents.read(results / "geometry" / "pair.json")["design_si"]
    radius = np.hypot(grids["gear_flank"][..., 0], grids["gear_flank"][..., 1])
    assert radius.min() == pytest.approx(design["face_gear"]["inner_radius"], abs=1e-12)
    assert radius.max() == pytest.approx(design["face_gear"]["outer_radius"], abs=1e-12)


def test_mesh_files_agree_with_the_quality_table(results):
    table = tables.read(results / "mesh" / "quality.csv", ["body", "quantity", "statistic", "value"])
    for body in ("pinion", "face_gear"):
        rows = table[table["body"] == body].set_index(["quantity", "statistic"])["value"]
        nodes, hexes, groups = read_msh(results / "mesh" / f"{body}.msh")
        assert len(hexes) == rows["elements", "count"]
        assert len(nodes) == rows["nodes", "count"]
        assert rows["scaled_jacobian", "quantile_0"] > 0
        assert {"flank_left", "flank_right", "fillet_left", "cut_left", "cut_right"} <= set(groups)
        assert (results / "mesh" / f"{body}.vtu").stat().st_size > 0
        assert (results / "mesh" / f"{body}.inp").read_text().startswith("*HEADING")


def test_picture_of_the_pair_is_written_as_svg_alone(results):
    assert (results / "figures" / "tooth_pair.svg").read_text().startswith("<?xml")
    assert not list((results / "figures").glob("*.png"))
