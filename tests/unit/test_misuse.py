"""Misuse of the Python interface ends in a FacegearError of one line, before any work."""

from pathlib import Path

import pytest

import facegear
from facegear.errors import FacegearError

ROOT = Path(__file__).parents[2]
MISTAKES = {
    "config": (lambda g, d: facegear.load(3), "config = 3: must be the name of a file"),
    "results": (lambda g, d: facegear.load(g.config.model_dump(), 3), "results = 3: must be"),
    "no changes": (lambda g, d: g.with_values(None), "changes = None: must be a mapping"),
    "list of changes": (lambda g, d: g.with_values(["a"]), "changes = ['a']: must be a mapping"),
    "key of changes": (lambda g, d: g.with_values({3: 4}), "changes = {3: 4}: must be a mapping"),
    "displacement": (lambda g, d: g.displaced_contact(pinion=3), "pinion = 3: must be a mapping"),
    "points": (lambda g, d: g.sweep(points="a"), 'dynamics.sweep.points = "a": must be a whole number'),
    "threads": (lambda g, d: g.sweep(threads=0), "threads = 0: must be a whole number of at least 1"),
    "size": (lambda g, d: g.modes().plot(size=3), "size = 3: must be width and height in inches"),
    "no size": (lambda g, d: g.modes().plot(size=(0, 0)), "size = (0, 0): must be width and height"),
    "beside": (lambda g, d: g.load_sharing().plot(beside={"x": 3}), "beside = {'x': 3}: must be answers of"),
    "study": (lambda g, d: g.study(3), "study = 3: must be a mapping"),
    "empty study": (lambda g, d: g.study({}), "study = {}: must be a mapping"),
    "lone value": (lambda g, d: g.study({"dynamics.speed_rpm": 3000}), "must be a list of values"),
    "text as values": (lambda g, d: g.study({"dynamics.speed_rpm": "3000"}), "must be a list of values"),
    "argument": (lambda g, d: study(g).table("modes", wrong=3), "modes: got an unexpected keyword argument"),
    "answer": (lambda g, d: study(g).table(3), "answer = 3: must be a method"),
    "report": (lambda g, d: g.report(3), "path = 3: must be the name of a file"),
    "run": (lambda g, d: g.run(3), "folder = 3: must be the name of a file"),
    "suffix": (lambda g, d: g.figures(d, suffix="png"), "suffix = 'png': must be one of .eps"),
    "figures": (lambda g, d: g.figures(d, 3), "names = 3: must be a list"),
    "export": (lambda g, d: g.export(3), "path = 3: must be the name of a file"),
    "ending": (lambda g, d: g.export(d / "a"), "must be one of .step, .stp, .stl, .glb, .fmu, .rexs, .csv"),
    "teeth": (lambda g, d: g.export(d / "a.stl", teeth=2.5), "teeth = 2.5: must be a whole number"),
    "workbook": (lambda g, d: g.modes().to_excel(3), "path = 3: must be the name of a file"),
    "files": (lambda g, d: g.modes().save(3), "folder = 3: must be the name of a file"),
}


def study(gearbox):
    return gearbox.study({"dynamics.speed_rpm": [3000]})


@pytest.fixture(scope="module")
def light():
    return facegear.load(ROOT / "config" / "harmonics_only.yaml", None)


@pytest.mark.parametrize("mistake", MISTAKES)
def test_misuse_ends_in_one_line_and_writes_nothing(mistake, light, tmp_path):
    call, line = MISTAKES[mistake]
    with pytest.raises(FacegearError) as caught:
        call(light, tmp_path)
    assert line in str(caught.value) and "\n" not in str(caught.value)
    assert not list(tmp_path.iterdir())


def test_a_study_goes_to_a_workbook_with_its_changed_keys(light, tmp_path):
    from facegear.io.tables import read_workbook

    path = study(light).to_excel(tmp_path / "own.xlsx", "modes")
    (sheet,) = read_workbook(path).values()
    assert list(sheet.columns[:2]) == ["dynamics.speed_rpm", "order"]


def test_endings_in_capitals_name_the_same_formats(light, tmp_path):
    with pytest.raises(FacegearError, match="geometry and contact need the bodies"):
        light.export(tmp_path / "a.GLB")
