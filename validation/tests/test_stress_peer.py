"""Root stress under a line load: convergence of the default mesh, and CalculiX on the same one."""

import shutil
from dataclasses import replace

import numpy as np
import pytest
from contact_bodies import STEEL, pair_design
from references import against, agrees

from facegear.errors import FacegearError
from facegear.strength.root_stress import down_the_fillet
from facegear.teeth.mesh_sizes import MeshSizes, named_sizes, thin_fillet
from validation.contact.line_load import loaded_tooth
from validation.contact.stress_benchmark import stress_convergence
from validation.contact.stress_peer import outer_end, read_nodes, stress_peer_study

NOMINAL = pair_design()
M = NOMINAL.module
END = outer_end(NOMINAL)
SHARP = replace(
    END,
    face_gear=replace(END.face_gear, rim_thickness=4e-3),
    pinion=replace(END.pinion, bore_radius=0.034),
)
"""The paper's pair with the outer end of its face alone, where the gear's fillet is sharp, on thin rims."""


def largest(body, sizes):
    """Largest tension at the loaded fillet."""
    return down_the_fillet(loaded_tooth(SHARP, body, sizes, STEEL, 3).stress[0]).max()


@against(
    "own convergence",
    "mesh twice as fine",
    capability="root_stress",
    module="facegear.strength.root_stress",
)
def test_default_mesh_gives_the_gears_root_stress_of_one_twice_as_fine_within_three_percent():
    # as many elements along the fillet as the whole face has, whose inner end sets their number
    default, finer = (
        largest("face_gear", thin_fillet(replace(named_sizes(name, M), width=4e-3, fillet=along), name))
        for name, along in (("coarse", 0.1 * M), ("medium", 0.05 * M))
    )
    agrees("largest tension at the fillet, Pa", default, finer, relative=0.03)


def test_line_load_is_one_newton_along_the_normals():
    tooth = loaded_tooth(SHARP, "pinion", MeshSizes(3e-3, 8e-3, 4e-3), STEEL, 3, on_corners=True)
    assert np.linalg.norm(tooth.load, axis=-1).sum() == pytest.approx(1.0)


@against(
    "third-party program",
    "CalculiX on the same mesh",
    capability="root_stress",
    module="facegear.contact.root_gauges",
)
@pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX is not installed")
def test_fillet_stress_agrees_with_calculix_on_the_same_mesh(tmp_path):
    sizes = thin_fillet(MeshSizes(0.2 * M, 4e-3, 0.6 * M, 0.1 * M))
    table = stress_peer_study(SHARP, {"small": sizes}, (STEEL, STEEL), tmp_path, 1)
    agrees(
        "largest tension at the fillet less CalculiX', percent",
        table["difference_percent"].abs().max(),
        0.0,
        absolute=1.0,
    )
    agrees(
        "nodal stress less CalculiX', percent",
        table["nodal_difference_percent"].abs().max(),
        0.0,
        absolute=5.0,
    )


def test_a_result_without_stress_is_refused(tmp_path):
    (tmp_path / "deck.frd").write_text(" -4  DISP        4    1\n -3\n")
    with pytest.raises(FacegearError, match="no STRESS"):
        read_nodes(tmp_path / "deck.frd", "STRESS", 6)


def test_convergence_compares_the_same_places_of_both_meshes():
    sizes = thin_fillet(MeshSizes(0.6 * M, 3e-3, 1.5 * M))
    (row,) = stress_convergence(SHARP, "pinion", sizes, STEEL, ["width"])
    assert row["fine_dof"] > 1.5 * row["dof"]
    assert abs(row["error_percent"]) <= row["largest_error_percent"] < 5.0
    assert row["stress_mpa"] == pytest.approx(1e-3 * largest("pinion", sizes), rel=0.2)
