"""Nominal points and normals for a measuring machine, in a file that is read back as it is."""

import numpy as np
import pytest
from kinds_of_teeth import public_section
from public_teeth import NAMES
from references import against, agrees

import facegear
from facegear.build.tooth_pair import pair_design
from facegear.teeth import face_gear, pinion
from facegear.teeth.generated_flank import gear_flank


@against(
    "analytic",
    "points, which close the equations of involute and generated flank",
    capability="topography export",
    module="facegear.teeth.surfaces",
)
def test_nominal_points_lie_on_the_flanks_with_normals_across_them():
    machine = facegear.example()
    design, table = pair_design(machine.config.tooth_pair), machine.topography().table()
    for body, rows in table.groupby("body"):
        points = 1e-3 * rows[["x_mm", "y_mm", "z_mm"]].to_numpy()
        normals = rows[["nx", "ny", "nz"]].to_numpy()
        side = np.where(rows["flank"] == "right", 1.0, -1.0)
        agrees("length of a normal", np.linalg.norm(normals, axis=1), 1.0, absolute=1e-12)
        if body == "pinion":
            # a normal of an involute touches its base circle, one half tooth ahead by its length of roll
            arm = points[:, 0] * normals[:, 2] - points[:, 2] * normals[:, 0]
            agrees("arm of a normal, m", side * arm, design.pinion_base_radius, absolute=1e-12)
            roll = 1e-3 * rows["profile_mm"].to_numpy() / design.pinion_base_radius
            radius, _ = pinion.involute_point(design, roll, design.middle)
            agrees("radius, m", np.hypot(points[:, 0], points[:, 2]), radius, absolute=1e-12)
        else:
            agrees(
                "gear radius, mm", 1e3 * np.hypot(points[:, 0], points[:, 1]), rows["face_mm"], absolute=1e-9
            )
            depth = face_gear.tip_height(design, design.mean_radius) - points[:, 2]
            agrees("depth, mm", 1e3 * depth, rows["profile_mm"], absolute=1e-9)
            places = face_gear.roll_and_psi_at_height(design, 1e-3 * rows["face_mm"], points[:, 2])
            tangents = face_gear.flank_tangents(design, *places)
            mirror = np.stack([side, np.ones_like(side), np.ones_like(side)], axis=1)
            for tangent in tangents:
                across = np.einsum(
                    "ij,ij->i", tangent / np.linalg.norm(tangent, axis=1)[:, None], mirror * normals
                )
                agrees("normal along a tangent", across, 0.0, absolute=1e-9)
        assert (side * normals[:, 0] > 0.5).all()


def test_the_file_for_a_measuring_machine_is_read_back_as_flanks_without_deviations(tmp_path):
    machine = facegear.example()
    path = str(machine.export(tmp_path / "nominal_points.csv"))
    read = machine.with_values({f"tooth_pair.{body}.flanks.file": path for body in ("pinion", "face_gear")})
    design = pair_design(read.config.tooth_pair)
    assert design.pinion.flanks.right.zero and design.face_gear.flanks.left.zero
    assert not design.deviates


def test_a_factor_on_deviations_may_vary_in_tolerances_and_search(tmp_path):
    from facegear.schema.changes import WITHOUT_MESHING, add_changes, movable

    machine = facegear.example()
    path = str(machine.export(tmp_path / "nominal_points.csv"))
    values = machine.with_values({"tooth_pair.face_gear.flanks.file": path}).values
    key = "tooth_pair.face_gear.flanks.amplitude"
    start = movable({"tooth_pair": values["tooth_pair"]}, [key], WITHOUT_MESHING)
    assert add_changes(start, {key: 0.5})["tooth_pair"]["face_gear"]["flanks"]["amplitude"] == 1.5
    key = "tooth_pair.face_gear.modifications.lead_slope_um"
    assert movable({"tooth_pair": values["tooth_pair"]}, [key], WITHOUT_MESHING)


@pytest.mark.parametrize("name", NAMES)
def test_the_file_of_every_kind_of_teeth_is_read_back_as_flanks_without_deviations(name, tmp_path):
    """Points of the left pinion and of the right gear flank were reflections of the opposite ones."""
    values = {"case": "kind", "tooth_pair": public_section(name)}
    machine = facegear.load(values, results=None)
    path = str(machine.export(tmp_path / "nominal_points.csv"))
    read = machine.with_values({f"tooth_pair.{body}.flanks.file": path for body in ("pinion", "face_gear")})
    design, table = pair_design(read.config.tooth_pair), machine.topography().table()
    assert design.pinion.flanks.left.zero and design.face_gear.flanks.right.zero
    for side, sign in (("left", 1), ("right", -1)):
        rows = table[(table["body"] == "face_gear") & (table["flank"] == side)]
        points = 1e-3 * rows[["x_mm", "y_mm", "z_mm"]].to_numpy()
        flank = gear_flank(design.family, sign)
        place = flank.parameters_at(np.hypot(points[:, 0], points[:, 1]), points[:, 2])
        assert np.abs(flank.point(*place) - points).max() < 1e-9
        assert np.abs(flank.normal(*place) - rows[["nx", "ny", "nz"]].to_numpy()).max() < 1e-7
