"""The command that a damaged file is told with makes that file again, however the run was started."""

import shlex

import pytest

from facegear.pipeline.provenance.manifest import rebuild_command


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """The working directory of a run, with a Snakefile and a config elsewhere."""
    for name in ("run", "sources"):
        (tmp_path / name).mkdir()
    (tmp_path / "sources" / "Snakefile").touch()
    monkeypatch.chdir(tmp_path / "run")
    return tmp_path


def test_a_run_beside_its_snakefile_needs_neither_snakefile_nor_directory(folder, monkeypatch):
    monkeypatch.chdir(folder / "sources")
    message = rebuild_command(folder / "sources" / "Snakefile", [folder / "own config.yaml"], {}, None)
    assert message == "snakemake --cores 2 --configfile '../own config.yaml' --force"


def test_sources_elsewhere_are_named_as_the_current_folder_counts_them(folder):
    message = rebuild_command(folder / "sources" / "Snakefile", [], {}, None)
    assert message == "snakemake --cores 2 --snakefile ../sources/Snakefile --force"


def test_with_a_directory_the_command_works_in_any_folder(folder):
    message = shlex.split(rebuild_command(folder / "sources" / "Snakefile", [folder / "a.yaml"], {}, "run"))
    assert message[message.index("--directory") + 1] == str(folder / "run")
    assert message[message.index("--snakefile") + 1] == str(folder / "sources" / "Snakefile")
    assert message[message.index("--configfile") + 1] == str(folder / "a.yaml")


def test_values_given_on_the_command_line_are_kept(folder):
    values = {"case": "mine", "transmission": {"backlash_um": 80}}
    message = shlex.split(rebuild_command(folder / "sources" / "Snakefile", [], values, None))
    assert message[-4:] == ["--config", "case=mine", 'transmission={"backlash_um": 80}', "--force"]
