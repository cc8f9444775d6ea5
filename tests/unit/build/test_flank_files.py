"""Files of measured flanks: what they mean, and one clear line for each that is not of this gear."""

import numpy as np
import pytest

import facegear
from facegear.build.tooth_pair import pair_design
from facegear.errors import ConfigErrors
from facegear.teeth.modifications import deviation
from facegear.teeth.surfaces import flank_face, nominal_points

HEAD = "# pitch and thickness: included\nbody,tooth,flank,face_mm,profile_mm,deviation_um"
FACES, PROFILES = (251.0, 257.0, 263.0, 269.0, 274.0), (0.2, 2.0, 3.75, 5.0)


def rows(
    tooth="all",
    flank="left",
    body="face_gear",
    faces=FACES,
    profiles=PROFILES,
    value=lambda r, d: r - d - 260,
):
    return [f"{body},{tooth},{flank},{r},{d},{value(r, d):.6f}" for r in faces for d in profiles]


def written(folder, lines, head=HEAD):
    path = folder / "flanks.csv"
    path.write_text("\n".join([head, *lines]) + "\n")
    return path


def machine(path, body="face_gear", **more):
    return facegear.example().with_values({f"tooth_pair.{body}.flanks": {"file": str(path), **more}})


def refusal(path, body="face_gear", **more):
    with pytest.raises(ConfigErrors) as caught:
        machine(path, body, **more)
    (line,) = caught.value.lines
    assert line.startswith(f"tooth_pair.{body}.flanks") and "must" in line
    return line


def test_a_file_is_read_into_the_config_so_that_an_edit_changes_what_stages_take(tmp_path):
    path = written(tmp_path, rows())
    before = machine(path).values["tooth_pair"]["face_gear"]["flanks"]
    assert before["file"] is None and before["grids"][0]["deviation_um"][1][2] == pytest.approx(
        257 - 3.75 - 260
    )
    written(tmp_path, rows(value=lambda r, d: 1.0))
    assert machine(path).values["tooth_pair"]["face_gear"]["flanks"] != before


def test_deviations_count_along_the_outward_normal_on_the_flank_that_is_named(tmp_path):
    design = pair_design(machine(written(tmp_path, rows()), amplitude=0.5).config.tooth_pair)
    assert design.face_gear.flanks.right is None
    found = deviation(design.face_gear.flanks.left, 0.263, [0.002, 0.00375])
    np.testing.assert_allclose(found, [0.5e-6, -0.375e-6], atol=1e-12)


def test_without_pitch_and_thickness_a_tooth_counts_from_the_middle_of_its_flank(tmp_path):
    left_out = written(tmp_path, rows(), HEAD.replace("included", "left out"))
    design = pair_design(machine(left_out).config.tooth_pair)
    assert deviation(design.face_gear.flanks.left, *flank_face(design, "face_gear").middle) == pytest.approx(
        0, abs=1e-15
    )


def test_the_contact_takes_the_mean_of_all_teeth(tmp_path):
    path = written(tmp_path, rows(value=lambda r, d: 0.0) + rows(tooth=7, value=lambda r, d: 14.3))
    design = pair_design(machine(path).config.tooth_pair)
    assert deviation(design.face_gear.flanks.left, 0.26, 0.002) == pytest.approx(0.1e-6)


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        (rows()[:-1], "no row at face_mm = 274, profile_mm = 5"),
        (rows() + rows()[:1], "line 23: the same place stands in line 3"),
        (rows(value=lambda r, d: 6000.0), "deviation_um = 6000"),
        (rows(value=lambda r, d: 0.004), "are they in mm?"),
        (rows(faces=[0.251, 0.263, 0.274]), "face_mm = 0.251: must be from 250.000 to 275.000"),
        (rows(faces=[262.0, 263.0, 264.0]), "at least 50%"),
        (rows(profiles=[0.2, 25.0]), "profile_mm = 25.0: must be from 0.000"),
        (rows() + rows(tooth=144), "tooth = 144: must be at most 143"),
        (rows(tooth=3), "tooth = 1: must be given for all 143 teeth"),
        (rows() + rows(tooth=2, profiles=(0.2, 4.0)), "at the same places on all teeth"),
        (rows(flank="top"), "flank = 'top' must be right or left"),
        (rows(body="pinion"), "no rows with body face_gear"),
        (rows(tooth="first"), "tooth = 'first'"),
    ],
)
def test_a_file_that_is_not_of_this_gear_is_refused_in_one_line(tmp_path, lines, said):
    assert said in refusal(written(tmp_path, lines))


def test_a_file_must_say_whether_pitch_and_thickness_are_in_it(tmp_path):
    assert "# pitch and thickness" in refusal(written(tmp_path, rows(), HEAD.splitlines()[1]))


@pytest.mark.parametrize("body", ["pinion", "face_gear"])
@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        (lambda point, normal: (point, normal), None),
        (lambda point, normal: (point, -normal), "turned"),
        (lambda point, normal: (point * [-1, 1, 1], normal * [-1, 1, 1]), "mirrored"),
        (lambda point, normal: (point + 0.1, normal), "x_mm, y_mm, z_mm"),
    ],
)
def test_nominal_points_and_normals_of_a_file_show_turned_and_mirrored_flanks(tmp_path, body, wrong, said):
    face = flank_face(pair_design(facegear.example().config.tooth_pair), body)
    along, across = (FACES, PROFILES) if body == "face_gear" else ((-14.0, 0.0, 14.0), (10.0, 18.0, 25.0))
    points, normals = nominal_points(face, "left", 1e-3 * np.array(along), 1e-3 * np.array(across))
    points, normals = wrong(1e3 * points.reshape(-1, 3), normals.reshape(-1, 3))
    given = rows(body=body, faces=along, profiles=across, value=lambda r, d: 1.0)
    lines = [
        f"{line},{','.join(f'{value:.6f}' for value in (*point, *normal))}"
        for line, point, normal in zip(given, points, normals, strict=True)
    ]
    path = written(tmp_path, lines, f"{HEAD},x_mm,y_mm,z_mm,nx,ny,nz")
    if said:
        assert said in refusal(path, body)
    else:
        assert machine(path, body).config.tooth_pair


def test_a_gde_file_is_refused_by_its_name(tmp_path):
    path = tmp_path / "pinion.gde"
    path.write_text("<x/>")
    assert "GDE files (VDI/VDE 2610) are not read" in refusal(path)
