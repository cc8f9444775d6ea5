"""Columns of the csv files that a user gives: each is read or refused by its name."""

import pytest

from facegear.errors import ConfigErrors
from facegear.schema.base import parse
from facegear.schema.csv_file import read_flanks
from facegear.schema.gear_body import BodySection
from facegear.schema.stiffness import MeshStiffness
from facegear.schema.strength import BIN_COLUMNS, Strength

FILES = {
    "orders": ("order,sin_n_per_m,cos_n_per_m", "0,0,4e8"),
    "angle": ("pinion_angle_deg,k_n_per_m", "0,4e8"),
    "duty": (",".join(BIN_COLUMNS), "100,1000,1"),
    "corners": ("r_mm,height_mm", "10,0"),
    "flanks": ("body,tooth,flank,face_mm,profile_mm,deviation_um", "pinion,all,right,0,0,1"),
}


def refused(kind, path):
    """Return the message with which the file is refused."""
    with pytest.raises(Exception) as error:
        if kind in ("orders", "angle"):
            parse(MeshStiffness, {"source": "harmonics", "csv": str(path)})
        elif kind == "duty":
            parse(Strength, {"pinion": {}, "face_gear": {}, "duty_csv": str(path)})
        elif kind == "corners":
            parse(BodySection, {"corners_csv": str(path)})
        else:
            read_flanks(path, "pinion")
    if isinstance(error.value, ConfigErrors):
        return "\n".join(error.value.lines)
    return str(error.value)


@pytest.mark.parametrize("kind", FILES)
def test_a_further_column_of_a_csv_is_refused_by_its_name(kind, tmp_path):
    header, row = FILES[kind]
    path = tmp_path / "own.csv"
    path.write_text(f"{header},colour\n{row},1\n")
    assert "column 'colour' is unknown; allowed here: " in refused(kind, path)


@pytest.mark.parametrize("kind", FILES)
def test_a_column_without_a_name_is_refused_by_its_place(kind, tmp_path):
    """Pandas writes one unless told otherwise."""
    header, row = FILES[kind]
    path = tmp_path / "own.csv"
    path.write_text(f",{header}\n0,{row}\n")
    assert "column 1 has no name" in refused(kind, path)


def test_half_of_the_nominal_columns_of_measured_flanks_are_refused(tmp_path):
    header, row = FILES["flanks"]
    path = tmp_path / "own.csv"
    path.write_text(f"{header},x_mm,y_mm\n{row},1,2\n")
    assert "column z_mm must stand once" in refused("flanks", path)
