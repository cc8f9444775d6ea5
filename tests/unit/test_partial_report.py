"""A report holds what could be computed, says what could not and why, and goes on where it was stopped."""

import re
from pathlib import Path

import pytest

import facegear
from facegear.__main__ import main
from facegear.errors import FacegearError, NotConverged
from facegear.pipeline.results.chain import Chain

ROOT = Path(__file__).parents[2]
CASE = str(ROOT / "config" / "harmonics_only.yaml")
LIGHT = {"dynamics.sweep.points": 2, "load_sharing.cycles": 20, "load_sharing.starts": 1}


@pytest.fixture
def computed(monkeypatch):
    """Names of the stages that are computed, in order; a test may make some of them fail."""
    names, failing, compute = [], {}, Chain.compute

    def compute_or_fail(self, name, *arguments, **more):
        names.append(name)
        if name in failing:
            raise failing[name]
        return compute(self, name, *arguments, **more)

    monkeypatch.setattr(Chain, "compute", compute_or_fail)
    return type("Computed", (), {"names": names, "failing": failing})


def gearbox():
    return facegear.load(CASE, None).with_values({**LIGHT, "load_sharing.speed_range.points": 2})


def test_a_page_holds_all_but_what_failed_and_says_so_at_its_head(tmp_path, computed):
    computed.failing["dynamics_sweep_chunk"] = NotConverged("sweep", "7000 rpm", "20 steps")
    said = []
    path = gearbox().report(tmp_path / "own.html", lambda *line: said.append(line))
    page = path.read_text()
    head, _, chapters = page.partition("</header>")
    (listed,) = re.findall("<li>(.*?)</li>", head)
    assert listed == "Jumps and resonances: sweep did not converge at 7000 rpm: 20 steps"
    assert "Natural frequencies; equal ones share a row" in chapters
    assert ("dynamics_sweep", "not computed: sweep did not converge at 7000 rpm: 20 steps") in said
    assert said[0][0] == "report" and re.match(r"\d+ stages, about \d+ (s|min)", said[0][1])
    assert computed.names.count("dynamics_sweep_chunk") == 1, "it failed a second time"


@pytest.mark.parametrize("name", ["stiffness", "ratings", "modal", "dynamics_response"])
def test_whatever_stage_fails_the_page_is_written(tmp_path, computed, name):
    computed.failing[name] = FacegearError("no & such result")
    page = gearbox().report(tmp_path / "own.html").read_text()
    assert "no &amp; such result" in page.partition("</header>")[0]


def test_a_report_that_was_stopped_goes_on_from_there(tmp_path, computed):
    page = tmp_path / "own.html"
    computed.failing["dynamics_response"] = KeyboardInterrupt()
    with pytest.raises(KeyboardInterrupt):
        gearbox().report(page)
    assert not page.exists() and (tmp_path / "own.partial").is_dir()
    before = set(computed.names) - {"dynamics_response"}
    assert before
    computed.names.clear()
    computed.failing.clear()
    gearbox().report(page)
    assert not set(computed.names) & before and "dynamics_response" in computed.names
    assert [path.name for path in tmp_path.iterdir()] == ["own.html"]


def test_a_file_in_the_place_of_what_is_kept_is_said_before_any_work(tmp_path, computed):
    """It was noticed when the first stage was done."""
    (tmp_path / "own.partial").write_text("mine")
    with pytest.raises(FacegearError, match=r"own\.partial: is a file, not a folder"):
        gearbox().report(tmp_path / "own.html", lambda *_: pytest.fail("work has begun"))
    assert computed.names == [] and (tmp_path / "own.partial").read_text() == "mine"


def test_a_changed_config_takes_nothing_from_a_stopped_report_that_it_changes(tmp_path, computed):
    computed.failing["dynamics_response"] = KeyboardInterrupt()
    with pytest.raises(KeyboardInterrupt):
        gearbox().report(tmp_path / "own.html")
    computed.names.clear()
    changed = gearbox().with_values({"transmission.pinion.mass_kg": 1.3})
    with pytest.raises(KeyboardInterrupt):
        changed.report(tmp_path / "own.html")
    assert "modal" in computed.names and "stiffness" not in computed.names


def test_the_command_ends_with_1_and_the_page_where_a_stage_fails(tmp_path, computed, capsys, monkeypatch):
    machine = gearbox()
    monkeypatch.setattr(facegear, "load", lambda *_: machine)
    computed.failing["stiffness"] = FacegearError("there is none")
    assert main(("report", CASE, "--output", str(tmp_path / "own.html"))) == 1
    said = capsys.readouterr()
    assert said.out.splitlines() == [str(tmp_path / "own.html")]
    assert "stiffness: not computed: there is none" in said.err
    computed.failing["stiffness"] = KeyboardInterrupt()
    assert main(("report", CASE, "--output", str(tmp_path / "two.html"))) == 130
    assert "stopped; the same command goes on" in capsys.readouterr().err
