"""Snakemake's own report of a finished run."""

import pytest
from projects import ROOT

pytestmark = [pytest.mark.workflow, pytest.mark.xdist_group("workflow")]


def test_snakemake_report_holds_the_figures_and_their_captions(quick, tmp_path):
    project = quick.copied(tmp_path)
    config = str(ROOT / "config" / "quick.yaml")
    done = project.run("--report", str(tmp_path / "report.html"), "--configfile", config)
    assert "warning" not in (done.stdout + done.stderr).lower()
    page = (tmp_path / "report.html").read_text()
    for figure in ("mode_shapes", "mesh_stiffness", "mesh_sweep", "contact_pattern"):
        assert f"{figure}.svg" in page
    assert "Load sharing" in page
