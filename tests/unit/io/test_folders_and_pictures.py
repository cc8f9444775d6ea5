"""Folders that cannot be written and stored files that are not whole end in one line, before any work."""

import json
import os
from pathlib import Path

import pandas as pd
import pytest
from strangers import done_by_stranger

import facegear
from facegear.__main__ import main
from facegear.errors import CorruptFile, FacegearError
from facegear.io import documents, tables
from facegear.io.atomic import atomic_path, require_writable, require_writable_file
from facegear.io.pages import read_svg
from facegear.pipeline.results.store import Store
from facegear.report.figures.draw_matplotlib import save
from facegear.report.figures.machine import mode_shapes
from facegear.report.page import Picture

CONFIG = str(Path(__file__).parents[3] / "config" / "harmonics_only.yaml")
TEETH = ("--pinion-teeth", "25", "--face-gear-teeth", "160", "--module-mm", "4", "--torque-n-m", "100")
posix = pytest.mark.skipif(not hasattr(os, "fork"), reason="users of POSIX systems only")


@pytest.fixture
def stray(tmp_path):
    """A file where a folder should be."""
    path = tmp_path / "results"
    path.write_text("a file")
    return path


@pytest.fixture
def shut(tmp_path):
    """A folder in which only its owner, or nobody, may write; the way there is open."""
    folder = tmp_path / "shut"
    folder.mkdir()
    for above in (folder, *folder.parents[:3]):
        above.chmod(0o755)
    folder.chmod(0o755 if os.getuid() == 0 else 0o555)
    yield folder
    folder.chmod(0o755)


def refused(work, *arguments):
    """Return the line with which something is refused."""
    with pytest.raises(FacegearError) as error:
        work(*arguments)
    assert "\n" not in str(error.value)
    return str(error.value)


def test_a_file_in_place_of_a_folder_is_named(stray):
    line = f"{stray}: is a file, not a folder; move it, or choose another folder"
    assert refused(require_writable, stray / "case") == line
    assert refused(lambda: atomic_path(stray / "case" / "x.csv").__enter__()) == line
    assert refused(require_writable, stray) == line


def test_a_folder_in_place_of_a_file_is_named(tmp_path):
    assert "is a folder, not a file" in refused(require_writable_file, tmp_path)


@posix
def test_a_folder_that_may_not_be_written_is_named(shut):
    def write():
        for work in (require_writable, lambda folder: atomic_path(folder / "new" / "x").__enter__()):
            assert "cannot be written (permission denied)" in refused(work, shut)
        with pytest.raises(FacegearError, match=r"cannot be written \(permission denied\)"):
            tables.write(shut / "x.csv", pd.DataFrame({"a": [1]}))

    assert done_by_stranger(write)


@pytest.mark.parametrize(
    "arguments",
    [
        ("run", CONFIG, "--directory", "."),
        ("run", CONFIG, "--directory", "results"),
        ("report", CONFIG, "--output", "results/own.html"),
        ("new", "results/own.yaml", *TEETH, "--speed-rpm", "1000"),
        ("compare", "current/quick", "current/quick", "--page", "results/own.html"),
    ],
)
def test_every_command_names_a_file_in_place_of_its_folder(stray, arguments, monkeypatch, capsys):
    """They ended in FileExistsError or NotADirectoryError, some after minutes."""
    monkeypatch.chdir(stray.parent)
    monkeypatch.setattr("subprocess.Popen", lambda *_, **__: pytest.fail("no run begins"))
    assert main(arguments) == 1
    said = capsys.readouterr()
    assert said.err == "results: is a file, not a folder; move it, or choose another folder\n"
    assert sorted(path.name for path in stray.parent.iterdir()) in (["results"], [".snakemake", "results"])


def test_python_names_a_file_in_place_of_its_folder_before_it_computes(stray):
    gearbox = facegear.load(CONFIG, None)
    done = []
    for work in (
        lambda: gearbox.run(stray / "case", lambda *stage: done.append(stage)),
        lambda: gearbox.report(stray / "own.html", lambda *stage: done.append(stage)),
        lambda: gearbox.modes().save(stray),
        lambda: gearbox.modes().to_excel(stray / "own.xlsx"),
        lambda: gearbox.export(stray / "own.rexs"),
    ):
        assert "results: is a file, not a folder" in refused(work)
    assert done == []


@posix
def test_stored_results_that_may_not_be_read_are_computed_anew(tmp_path):
    gearbox = facegear.load(CONFIG, None)
    gearbox.modes().save(tmp_path / "harmonics_only")
    (tmp_path / "harmonics_only").chmod(0o700 if os.getuid() == 0 else 0o000)

    def compute():
        assert facegear.load(CONFIG, tmp_path).modes().source == "computed"
        store = Store(tmp_path / "harmonics_only")
        assert facegear.Gearbox(gearbox.config, store).modes().source == "computed"

    try:
        assert done_by_stranger(compute)
    finally:
        (tmp_path / "harmonics_only").chmod(0o700)


def test_a_config_in_the_root_folder_is_loaded(monkeypatch):
    """The folder above it was asked for, and there is none."""
    config = facegear.load(CONFIG, None).config
    monkeypatch.setattr("facegear.gearbox.load_config", lambda _: config)
    assert facegear.load("/own.yaml").config.case == "harmonics_only"


@pytest.fixture(scope="module")
def figure(tmp_path_factory):
    """A figure as svg and in its interactive form."""
    path = tmp_path_factory.mktemp("figures") / "modes.svg"
    modes = facegear.load(CONFIG, None).modes()
    save(mode_shapes(modes.table(), modes.shapes()), path, path.with_suffix(".json"))
    return path


@pytest.mark.parametrize("kept", [0.0, 0.5, 0.99])
def test_a_figure_that_was_cut_off_is_named(figure, tmp_path, kept):
    """A page was made of it all the same, or a traceback of its interactive form."""
    for ending, read in ((".svg", read_svg), (".json", documents.read)):
        whole = figure.with_suffix(ending)
        read(whole)
        cut = tmp_path / whole.name
        content = whole.read_bytes()
        cut.write_bytes(content[: int(kept * len(content))])
        with pytest.raises(CorruptFile, match=cut.name):
            read(cut)
        shown = Picture(cut if ending != ".json" else cut.with_suffix(".svg"), "")
        with pytest.raises(CorruptFile, match=cut.name):
            assert shown.interactive if ending == ".json" else shown.data_uri()


def test_a_figure_that_differs_from_its_manifest_is_named(figure, tmp_path):
    altered = tmp_path / figure.name
    altered.write_text(figure.read_text().replace("</svg>", " </svg>"))
    recorded = {"bytes": figure.stat().st_size, "sha256": "0"}
    manifest = {"files": {altered.name: recorded}, "rebuild": "snakemake "}
    (tmp_path / "modal.provenance.json").write_text(json.dumps(manifest))
    with pytest.raises(CorruptFile, match="differs from what its stage wrote"):
        Picture(altered, "").data_uri()
