"""Statements of a run's report about its config and about the publication that it reproduces."""

import html
import json
import re

import pytest
from projects import ROOT

from facegear.schema.yaml_file import read_yaml

pytestmark = [pytest.mark.workflow, pytest.mark.xdist_group("workflow")]
QUICK = ("--configfile", str(ROOT / "config" / "quick.yaml"))


def captions(page):
    return [html.unescape(text) for text in re.findall(r"<figcaption>(.*?)</figcaption>", page)]


def test_a_reproduction_numbers_its_figures_as_the_paper_does_and_another_machine_does_not(quick, tmp_path):
    """No report showed a number: what the report was given never held the key."""
    claims = read_yaml(ROOT / "config" / "claims" / "paper.yaml")
    (tmp_path / "claims.yaml").write_text(json.dumps({**claims, "claims": claims["claims"][:2]}))
    (tmp_path / "reproduction.yaml").write_text("claims: claims.yaml\n")
    project = quick.copied(tmp_path)
    given = f"reproduction={tmp_path / 'reproduction.yaml'}"
    project.run("results/quick/report.html", *QUICK, "--config", given)
    message = captions((tmp_path / "results" / "quick" / "report.html").read_text())
    for start in ("Figure 7 of the paper: Mesh stiffness", "Figure 13 of the paper: Effect of backlash"):
        assert any(caption.startswith(start) for caption in message), start
    plain = captions((quick.folder / "results" / "quick" / "report.html").read_text())
    assert len(plain) == len(message) and not any("of the paper" in caption for caption in plain)


def test_the_report_holds_every_key_of_the_config(quick):
    page = (quick.folder / "results" / "quick" / "report.html").read_text()
    for key in (
        "load_sharing.cycles",
        "studies[0].axes[0].points[1].set.transmission.backlash_um",
        "transmission.pinions[0].role",
    ):
        assert f"<td>{key}</td>" in page, key


def test_figures_of_the_report_are_interactive_and_it_stays_below_eight_megabytes(quick):
    folder = quick.folder / "results" / "quick"
    page = (folder / "report.html").read_text()
    assert len(page) < 8_000_000
    for name in ("mesh_sweep", "contact_pattern", "stiffness_harmonics", "campbell"):
        assert json.loads((folder / "figures" / f"{name}.json").read_text())["data"], name
        assert f'id="figure-{name}"' in page, name
    assert page.count('id="plot-library"') == page.count('id="plot-figures"') == 1
