"""Stored files are whole, checked when read, and cannot execute code."""

import os

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays

from facegear.build.load import load_config
from facegear.errors import CorruptFile, FacegearError
from facegear.io import arrays as array_files
from facegear.io import columnar, documents, tables

finite = st.floats(allow_nan=False, allow_infinity=False, width=64)


@settings(max_examples=30, deadline=None)
@given(values=arrays(np.float64, array_shapes(max_dims=3, max_side=4), elements=finite))
def test_arrays_come_back_to_the_bit(tmp_path_factory, values):
    path = tmp_path_factory.mktemp("arrays") / "a.npz"
    array_files.write(path, values=values)
    back = array_files.read(path, {"values": values.shape})["values"]
    assert back.tobytes() == values.tobytes()


@settings(max_examples=30, deadline=None)
@given(values=st.lists(finite, min_size=1, max_size=8))
def test_table_numbers_come_back_to_the_bit(tmp_path_factory, values):
    path = tmp_path_factory.mktemp("tables") / "t.csv"
    tables.write(path, pd.DataFrame({"ste_um": values}))
    assert tables.read(path, ["ste_um"])["ste_um"].to_list() == values


@pytest.mark.parametrize("keep", [0, 1, 40, 0.5, 0.99])
def test_truncated_array_file_is_named(tmp_path, keep):
    path = tmp_path / "compliance.npz"
    array_files.write(path, matrix=np.eye(30))
    content = path.read_bytes()
    path.write_bytes(content[: int(keep if keep >= 1 or keep == 0 else keep * len(content))])
    with pytest.raises(CorruptFile, match=r"compliance\.npz: .*rebuild it with: snakemake"):
        array_files.read(path, {"matrix": (30, 30)})


def test_array_of_objects_is_neither_written_nor_read(tmp_path):
    path = tmp_path / "evil.npz"
    with pytest.raises(TypeError):
        array_files.write(path, a=np.array([{"x": 1}], dtype=object))
    np.savez(path, a=np.array([{"x": 1}], dtype=object))
    with pytest.raises(CorruptFile):
        array_files.read(path, {"a": (1,)})


def test_wrong_shape_missing_array_and_nan_are_named(tmp_path):
    path = tmp_path / "a.npz"
    array_files.write(path, a=np.zeros((2, 3)))
    with pytest.raises(CorruptFile, match=r"'a' has shape \(2, 3\)"):
        array_files.read(path, {"a": (3, None)})
    with pytest.raises(CorruptFile, match="'b' is missing"):
        array_files.read(path, {"b": (1,)})
    array_files.write(path, a=np.array([np.nan]))
    with pytest.raises(CorruptFile, match="not finite"):
        array_files.read(path, {"a": (1,)})


def test_table_without_a_column_or_with_a_hole_is_named(tmp_path):
    path = tmp_path / "ltca.csv"
    tables.write(path, pd.DataFrame({"ste_um": [1.0, np.nan]}))
    with pytest.raises(CorruptFile, match="'torque_n_m' is missing"):
        tables.read(path, ["torque_n_m"])
    with pytest.raises(CorruptFile, match="not finite"):
        tables.read(path, ["ste_um"])
    path.write_text("")
    with pytest.raises(CorruptFile):
        tables.read(path)


def test_altered_file_is_found_by_its_manifest(tmp_path):
    path = tmp_path / "tvms.csv"
    tables.write(path, pd.DataFrame({"k_n_per_m": [4.1e8]}))
    from facegear.pipeline.provenance.manifest import write_manifest

    write_manifest(
        tmp_path / "tvms.provenance.json", [path], [], {"code": "x"}, "tvms", 0.1, "", "snakemake --force"
    )
    assert tables.read(path, ["k_n_per_m"]).shape == (1, 1)
    path.write_text(path.read_text().replace("410000000", "420000000"))
    with pytest.raises(CorruptFile, match="differs from what its stage wrote"):
        tables.read(path, ["k_n_per_m"])


def test_failed_write_leaves_the_old_file_and_nothing_else(tmp_path):
    path = tmp_path / "pair.json"
    documents.write(path, {"radius_mm": 1.0})
    with pytest.raises(ValueError):
        documents.write(path, {"radius_mm": float("nan")})
    assert documents.read(path, ["radius_mm"]) == {"radius_mm": 1.0}
    assert [entry.name for entry in tmp_path.iterdir()] == ["pair.json"]


@pytest.mark.parametrize(
    ("name", "write"),
    [
        ("tvms.csv", lambda path: tables.write(path, pd.DataFrame({"k_n_per_m": np.ones(2000)}))),
        ("pinion.npz", lambda path: array_files.write(path, own=np.ones(20000))),
        ("pair.json", lambda path: documents.write(path, {"radius_mm": 1.0})),
        ("samples.parquet", lambda path: columnar.write(path, pd.DataFrame({"k_gamma": np.ones(2000)}))),
    ],
)
def test_full_disk_ends_in_one_line_and_leaves_nothing(tmp_path, name, write):
    (tmp_path / f".{os.getpid()}.{name}").symlink_to("/dev/full")
    with pytest.raises(FacegearError, match=f"{name}: no space left on the disk") as caught:
        write(tmp_path / name)
    assert "\n" not in str(caught.value)
    assert list(tmp_path.iterdir()) == []


class Trap:
    """Unpickling it would make a file."""

    def __init__(self, target):
        self.target = target

    def __reduce__(self):
        return (open, (str(self.target), "w"))


def test_a_stored_object_is_refused_and_not_brought_to_life(tmp_path):
    trap = np.array([Trap(tmp_path / "sprung")], dtype=object)
    np.savez(tmp_path / "pinion.npz", own=trap, allow_pickle=True)
    with pytest.raises(CorruptFile, match=r"pinion\.npz"):
        array_files.read(tmp_path / "pinion.npz", {"own": (None,)})
    assert not (tmp_path / "sprung").exists()


def test_a_config_cannot_call_code(tmp_path):
    path = tmp_path / "bad.yaml"
    path.write_text(f"case: !!python/object/apply:os.mkdir ['{tmp_path / 'sprung'}']\n")
    with pytest.raises(FacegearError):
        load_config(path).model_dump(mode="json")
    assert not (tmp_path / "sprung").exists()
