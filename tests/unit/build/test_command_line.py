"""Config files that Snakemake could not open are told before it tries."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from facegear.build.load import check_configfiles

ROOT = Path(__file__).parents[3]
PAPER = str(ROOT / "config" / "paper.yaml")


@pytest.mark.parametrize(
    ("named", "line"),
    [
        ("none.yaml", "none.yaml: no such config file"),
        ("folder", "folder: is a directory, not a config file"),
        ("latin.yaml", "latin.yaml"),
        ("results/paper/report.html", "Write -- before the targets that follow --configfile."),
    ],
)
@pytest.mark.parametrize("option", ["--configfile", "--configfiles"])
def test_what_cannot_be_read_ends_the_program_with_its_name(tmp_path, monkeypatch, named, line, option):
    monkeypatch.chdir(tmp_path)
    Path("folder").mkdir()
    Path("latin.yaml").write_bytes("case: caf\xe9".encode("latin-1"))
    with pytest.raises(SystemExit) as ended:
        check_configfiles(["snakemake", "--cores", "1", option, PAPER, named, "-n"])
    assert line in str(ended.value)
    with pytest.raises(SystemExit):
        check_configfiles([f"{option}={named}"])


def test_good_files_options_and_targets_after_a_dash_pass():
    check_configfiles(["--configfile", PAPER, "--cores", "2", "none.yaml"])
    check_configfiles(["--configfile", PAPER, "--", "results/none.csv"])
    check_configfiles(["--config", "none.yaml"])


@pytest.mark.parametrize("profile", ["default", "local", "slurm"])
def test_every_profile_asks(tmp_path, profile):
    """Read the profile like Snakemake: it is a template, whose definitions are run when it is read."""
    path = ROOT / "workflow" / "profiles" / profile / "config.yaml"
    code = (
        "import sys, yte; sys.argv = ['snakemake', '--configfile', 'none.yaml']; "
        f"yte.process_yaml(open({str(path)!r}), require_use_yte=True)"
    )
    here = {**os.environ, "PYTHONPATH": str(ROOT)}
    message = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, env=here, capture_output=True, text=True
    )
    assert message.returncode == 1
    assert message.stderr == "none.yaml: no such config file\n"
