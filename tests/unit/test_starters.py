"""Starter machines are the same in every run, and the cheapest of them comes to its report."""

import re

import pytest

from facegear.__main__ import main
from facegear.build.load import load_config
from facegear.checking import check_config
from facegear.new_machine.first_machine import first_machine
from facegear.schema.yaml_file import read_yaml
from validation.starters import COUNT, SHARING, draw_machines, run_all

LIGHTEST = (18, 4, 16)
"""A single pair, a gear with five pinions and a split-torque machine: some 30 s of the processor each."""


def test_the_same_machines_are_drawn_each_time_and_split_torque_is_among_them():
    machines = list(draw_machines())
    assert machines == list(draw_machines()) and len(machines) == COUNT
    assert any(known.idlers for known in machines) and any(not known.idlers for known in machines)


@pytest.mark.parametrize("number", LIGHTEST)
def test_a_starter_machine_comes_to_its_report_with_nothing_missing(number):
    row = run_all([list(draw_machines())[number - 1]]).iloc[0]
    assert (row["outcome"], row["reason"]) == ("report", "")
    assert row["stages"] >= 10
    assert row["printed_pitting_safety"] == pytest.approx(row["pitting_safety"], rel=0.4)
    if row["idlers"]:
        assert [row[f"printed_{name}"] for name in SHARING] == pytest.approx(
            [row[name] for name in SHARING], rel=0.1
        )
        assert row["k_gamma_inputs"] <= 1.3 and row["k_gamma_idlers_least"] >= 0.7
        assert row["k_gamma_idlers_largest"] <= 1.3


WALKED = {
    "pair": ("19", "97", "2.5", "60", "--pressure-angle-deg", "20"),
    "split": ("22", "101", "3.5", "300", "--pinions", "2", "--idlers", "2"),
}
"""Teeth, module and torque of the machines of docs/tutorials/first_machine.md that were walked by hand."""
ASKED = ("--pinion-teeth", "--face-gear-teeth", "--module-mm", "--torque-n-m")


@pytest.mark.parametrize("case", WALKED)
def test_new_check_and_report_lead_to_a_page_without_a_red_rating(case, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    numbers, wishes = WALKED[case][: len(ASKED)], WALKED[case][len(ASKED) :]
    given = [word for pair in zip(ASKED, numbers, strict=True) for word in pair]
    assert main(["new", "own.yaml", *given, *wishes, "--speed-rpm", "5000", "--coarse"]) == 0
    assert "leaves the rating without reserve" not in capsys.readouterr().out
    assert main(["check", "own.yaml"]) == 0
    assert "own.yaml: no mistakes; 1 case: own" in capsys.readouterr().out
    assert main(["report", "own.yaml"]) == 0
    assert capsys.readouterr().out == "own.html\n"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["own.html", "own.yaml"]
    verdicts = (tmp_path / "own.html").read_text().partition('class="verdicts"')[2].partition("</table>")[0]
    rows = re.findall(r"(?s)<tr.*?</tr>", verdicts)
    assert {
        subject: "green" in row
        for row in rows
        for subject in ("Teeth", "Bending", "Pitting")
        if f">{subject}<" in row
    } == dict.fromkeys(("Teeth", "Bending", "Pitting"), True)


@pytest.mark.parametrize("known", [*draw_machines()][::6], ids=lambda known: known.case)
def test_check_has_nothing_to_say_of_a_starter_machine(known, tmp_path):
    path = tmp_path / "own.yaml"
    path.write_text(first_machine(known).text)
    result = check_config(load_config(path), read_yaml(path))
    assert result.failures == ()
    assert not [line for line in result.remarks if "without effect" in line or "would be usual" in line]
