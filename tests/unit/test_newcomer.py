"""From nothing to a machine's report by the commands of docs/tutorials/first_machine.md alone."""

import io
import re
import shlex
from functools import cache
from pathlib import Path

import pytest

import facegear
from facegear import __main__ as command_line
from facegear.exchange.rexs import CylindricalGear, Shaft, Unit, write_rexs
from facegear.gearbox import load
from facegear.schema.yaml_file import read_yaml

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "tutorials" / "first_machine.md").read_text()
COMMANDS = [shlex.split(line) for line in re.findall(r"(?m)^(facegear .*)$", PAGE)]
DATE = "2026-11-23T20:00:00+00:00"
LIGHT = {
    "mesh_stiffness: {torque_n_m: 600, harmonics_kept: 3}": "mesh_stiffness: {source: harmonics, table: "
    "[{order: 0, cos_n_per_m: 4.1e8}, {order: 1, sin_n_per_m: 2.0e7}]}",
    "transmission_error: from_contact": "transmission_error: {amplitude_um: 5}",
    "points: 12, chunks: 1": "points: 2, chunks: 1",
}
"""Changes of the config beside leaving out the rating, so that no contact is solved."""


@cache
def computed_once(path):
    """The gearbox of a config, whichever command asks for it."""
    return load(path, None)


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """An empty folder, and a package installed without its workflow; a config is computed once."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(command_line, "ROOT", tmp_path)
    monkeypatch.setattr(facegear, "load", lambda path, results: computed_once(path))
    return tmp_path


def test_each_command_of_the_page_works_in_turn(folder, capsys):
    new, *others = COMMANDS
    assert command_line.main(new[1:]) == 0
    text = (folder / "own.yaml").read_text()
    for old, light in LIGHT.items():
        assert old in text
        text = text.replace(old, light)
    text = re.sub(r"(?ms)^strength:.*?^transmission:", "transmission:", text)
    (folder / "own.yaml").write_text(text)
    assert [command[1] for command in others] == ["check", "report", "run"]
    for command in others:
        assert command_line.main(command[1:]) == 0, capsys.readouterr().err
    page = (folder / "own.html").read_text()
    assert "1 pinion of 23 teeth and 1 face gear" in page
    written = (folder / "results" / "own" / "report.html").read_text()
    assert re.findall(r"<figcaption>.*?</figcaption>", page) == re.findall(
        r"<figcaption>.*?</figcaption>", written
    )
    for name in ("modal/frequencies.csv", "dynamics/sweep.csv", "figures/campbell.svg"):
        assert (folder / "results" / "own" / name).is_file(), name
    assert not list(folder.rglob("*.png")), "pictures are drawn on request"


def test_what_is_not_given_is_asked_and_an_empty_answer_takes_the_default(folder, monkeypatch):
    answers = iter(["23", "143", "3.75", "600", "7500", "", "20", ""])
    monkeypatch.setattr("sys.stdin", type("Terminal", (io.StringIO,), {"isatty": lambda self: True})())
    monkeypatch.setattr("builtins.input", lambda question: next(answers))
    assert command_line.main(("new", "own.yaml")) == 0
    values = read_yaml("own.yaml")
    assert values["tooth_pair"]["pressure_angle_deg"] == 20
    assert len(values["transmission"]["pinions"]) == 1


def test_pinions_of_a_rexs_file_are_taken_over_and_what_it_lacks_is_asked_for_by_name(
    folder, monkeypatch, capsys
):
    gear = CylindricalGear(25, 4.0, 33.0, right_angle=22.5, left_angle=22.5, bore=20.0)
    shafts = [Shaft(name, 1.5, 7e7, None, gear) for name in "abc"]
    write_rexs("unit.rexs", Unit((*shafts, Shaft("gear", 9.0, 8e9, None)), 206e3, 0.3), DATE, "1")
    monkeypatch.setattr("sys.stdin", io.StringIO())
    assert command_line.main(("new", "own.yaml", "--from", "unit.rexs")) == 1
    lacking = "new: --face-gear-teeth, --torque-n-m, --speed-rpm must be given"
    assert capsys.readouterr().err.startswith(lacking)
    known = ("--face-gear-teeth=140", "--torque-n-m=600", "--speed-rpm=3000")
    assert command_line.main(("new", "own.yaml", "--from", "unit.rexs", "--idlers=1", *known)) == 0
    values = read_yaml("own.yaml")
    assert [pinion["role"] for pinion in values["transmission"]["pinions"]].count("input") == 2
    assert values["transmission"]["pinion"]["mass_kg"] == 1.5
    assert values["transmission"]["pinion"]["bearing_stiffness_n_per_m"]["x"] == 7e7
    pair = values["tooth_pair"]
    assert (pair["pinion_teeth"], pair["module_mm"], pair["pressure_angle_deg"]) == (25, 4, 22.5)
    assert (pair["pinion"]["width_mm"], pair["pinion"]["bore_radius_mm"]) == (33, 20)
    other = Shaft("d", 1.5, 7e7, None, CylindricalGear(26, 4.0, None, None, None, None))
    write_rexs("two.rexs", Unit((shafts[0], other), None, None), DATE, "1")
    assert command_line.main(("new", "two.yaml", "--from", "two.rexs", *known)) == 1
    refusal = "two.rexs: cylindrical gears = 25 teeth of 4 mm, 26 teeth of 4 mm: must be equal pinions\n"
    assert capsys.readouterr().err == refusal and not Path("two.yaml").exists()


GIVEN = ("--pinion-teeth=23", "--face-gear-teeth=143", "--module-mm=3.75", "--torque-n-m=600")


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (("own.yaml", *GIVEN), "new: --speed-rpm must be given"),
        (("there.yaml", *GIVEN, "--speed-rpm=1"), "there.yaml: exists already"),
        (("own.txt", *GIVEN, "--speed-rpm=1"), "own.txt: must end in .yaml"),
        (("own.yaml", *GIVEN, "--speed-rpm=0"), "speed_rpm = 0.0: must be from 1 to 100000"),
        (
            ("own.yaml", *GIVEN, "--speed-rpm=1", "--module-mm=-1"),
            "module_mm = -1.0: must be from 0.1 to 100",
        ),
        (
            ("own.yaml", *GIVEN, "--speed-rpm=1", "--torque-n-m=1"),
            "torque_n_m = 1: the contact analysis cannot resolve so light a load",
        ),
    ],
)
def test_a_mistake_ends_new_in_one_line_and_writes_nothing(folder, monkeypatch, capsys, arguments, line):
    (folder / "there.yaml").write_text("case: there\n")
    monkeypatch.setattr("sys.stdin", io.StringIO())
    assert command_line.main(("new", *arguments)) == 1
    message = capsys.readouterr().err
    assert message.startswith(line) and message.count("\n") == 1
    assert [path.name for path in folder.iterdir()] == ["there.yaml"]


WALKED = (
    "--pinion-teeth=19 --face-gear-teeth=97 --module-mm=2.5 --pressure-angle-deg=20 --torque-n-m=80 "
    "--speed-rpm=6000 --coarse",
    "--pinion-teeth=22 --face-gear-teeth=101 --module-mm=3.5 --pinions=2 --idlers=2 --torque-n-m=300 "
    "--speed-rpm=4000 --coarse",
)
"""Machines of a user that were walked from an empty folder to their report by the page alone."""


@pytest.mark.parametrize("words", WALKED)
def test_own_machines_are_written_and_pass_check_with_an_estimate_of_what_they_do(folder, capsys, words):
    assert command_line.main(("new", "own.yaml", *words.split())) == 0
    said = capsys.readouterr().out
    assert ("K_gamma" in said) == ("--idlers" in words) and "safety of the pinion" in said
    assert command_line.main(("check", "own.yaml")) == 0
    assert "no mistakes" in capsys.readouterr().out


def test_a_folder_that_new_makes_is_said_and_a_refused_wish_makes_none(folder, monkeypatch, capsys):
    """A misspelt folder was made without a word."""
    monkeypatch.setattr("sys.stdin", io.StringIO())
    wishes = (*GIVEN, "--speed-rpm=7500", "--coarse")
    assert command_line.main(("new", "there/own.yaml", *wishes, "--rim-thickness-mm=-1")) == 1
    assert not (folder / "there").exists() and "there" not in capsys.readouterr().err
    assert command_line.main(("new", "there/own.yaml", *wishes)) == 0
    assert capsys.readouterr().err == "there: new folder\n"
    assert command_line.main(("new", "there/two.yaml", *wishes)) == 0
    assert capsys.readouterr().err == ""


def test_the_command_says_its_version(capsys):
    with pytest.raises(SystemExit) as ended:
        command_line.main(("--version",))
    assert ended.value.code == 0 and re.fullmatch(r"facegear \S.*\n", capsys.readouterr().out)
