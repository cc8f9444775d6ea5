"""The command line: limits before radii are chosen, checks, and mistakes in one line."""

import contextlib
from dataclasses import fields
from pathlib import Path
from types import SimpleNamespace

import pytest

from facegear.__main__ import main
from facegear.build.face_limits import FaceNumbers
from facegear.questions import OPTIONS, QUESTIONS, flag

ROOT = Path(__file__).parents[2]
TEETH = ("limits", "--pinion-teeth", "25", "--face-gear-teeth", "160", "--module-mm", "6.35")
POINTED = (
    *("--gear-addendum-modules", "2", "--pressure-angle-deg", "30"),
    *("--shaper-addendum-modules", "1.05"),
)


def test_limits_of_a_gear_are_reported_from_tooth_numbers_alone(capsys):
    assert main(TEETH) == 0
    assert "with a shaper of 28 teeth: between 465.173 (undercut) and 552.153 (" in capsys.readouterr().out


P1 = (
    *("limits", "--pinion-teeth", "25", "--face-gear-teeth", "125", "--module-mm", "3.5"),
    *("--shaper-teeth", "27", "--helix-angle-deg", "15", "--shaper-tip-rounding-modules", "0.05"),
)
"""Helical teeth of the first public design of the family."""


def test_limits_of_helical_teeth_name_both_flanks_and_the_keys_that_help(capsys):
    """Radii of the reference page: undercut of the drive flank, no height on the coast flank."""
    assert main(P1) == 0
    (line,) = capsys.readouterr().out.splitlines()
    inner = (
        "between 214.598 (undercut of the drive flank, a smaller shaper.addendum_modules helps; no height of "
    )
    assert f"{inner}the coast flank at 199.413) and " in line
    assert "(tips pointed at 255.243, a smaller face_gear.addendum_modules helps)" in line


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        ((*P1, "--helix-angle-deg", "60"), "helix_angle_deg = 60.0: must be from -45 to 45"),
        ((*P1, "--shaft-angle-deg", "10"), "shaft_angle_deg = 10.0: must be from 20 to 160"),
        ((*P1, "--taper-angle-deg", "-21"), "taper_angle_deg = -21.0: must be from -20 to 20"),
        ((*P1, "--offset-mm", "-10001"), "offset_mm = -10001.0: must be from -10000 to 10000"),
        ((*P1, "--coast-pressure-angle-deg", "5"), "coast_pressure_angle_deg = 5.0: must be from 10 to 40"),
        ((*P1, "--shaper-teeth", "29"), "shaper.teeth = 29: must be from 25 (line contact) to 28"),
        ((*TEETH, "--shaper-teeth", "40"), "shaper.teeth = 40: must be from 25 (line contact) to 28"),
        (
            (*TEETH, *POINTED),
            "face_gear.addendum_modules = 2.0: must be less: the teeth are pointed where they are no longer",
        ),
        ((*TEETH, "--gear-addendum-modules", "-3"), "gear_addendum_modules = -3.0: must be from 0.1 to 2"),
        (("check", "none.yaml"), "none.yaml: no such config file"),
        (("run", "none.yaml"), "none.yaml: no such config file"),
        (("run", str(ROOT)), f"{ROOT}: is a directory, not a config file"),
    ],
)
def test_a_mistake_on_the_command_line_ends_in_one_line(capsys, arguments, line):
    assert main(arguments) == 1
    message = capsys.readouterr().err
    assert message.startswith(line) and message.count("\n") == 1


@pytest.mark.parametrize(
    ("words", "line"),
    [
        (("new", "own.yaml", "--pinion-teeth", "abc"), "--pinion-teeth: 'abc': must be a whole number"),
        (("new", "own.yaml", "--module-mm", "2,5"), "--module-mm: '2,5': must be a number"),
        (("limits", "--module-mm", "2", "--pinion-teeth", "9.5"), "--pinion-teeth: '9.5': must be a whole"),
        (("new", "own.yaml", "--pinon-teeth", "9"), "unrecognized arguments: --pinon-teeth 9"),
        (("neww",), "command: invalid choice: 'neww'"),
        (("check",), "the following arguments are required: config"),
    ],
)
def test_a_word_that_cannot_be_read_is_one_line_without_the_usage(words, line, capsys):
    """The usage of all options stood before it, thirty lines."""
    with pytest.raises(SystemExit) as stop:
        main(words)
    message = capsys.readouterr().err
    assert stop.value.code == 2 and line in message and message.count("\n") == 1


BASE = {
    "pinion_teeth": 25,
    "face_gear_teeth": 160,
    "module_mm": 4,
    "torque_n_m": 100,
    "speed_rpm": 1000,
}
ABSURD = ("1e-300", "1e300", "inf", "nan", "-1", "1000000000")


@pytest.mark.parametrize("key", QUESTIONS)
def test_an_absurd_number_for_a_new_config_is_one_line_with_its_argument(key, tmp_path, capsys):
    """A billion pinions were listed one by one."""
    for value in ABSURD:
        words = [word for name, text in {**BASE, key: value}.items() for word in (flag(name), str(text))]
        try:
            code = main(("new", str(tmp_path / "own.yaml"), *words))
        except SystemExit as stop:  # argparse says what is no whole number
            assert stop.code == 2
            capsys.readouterr()
            continue
        message = capsys.readouterr().err
        assert code == 1 and message.count("\n") == 1 and (key in message or "pinion" in message)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("key", OPTIONS)
def test_a_wish_outside_its_limits_is_one_line_with_its_name(key, tmp_path, capsys):
    """A bore wider than the pinion and a gear without mass ended in tracebacks."""
    for value in ("nan", "-1e9", "1e300") if OPTIONS[key][0] is float else ("-5", "1000000"):
        words = [word for name, text in {**BASE, key: value}.items() for word in (flag(name), str(text))]
        words[words.index(flag(key)) : words.index(flag(key)) + 2] = [f"{flag(key)}={value}"]
        assert main(("new", str(tmp_path / "own.yaml"), *words)) == 1
        message = capsys.readouterr().err
        assert message.startswith(f"{key} = ") and "must be from" in message and message.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("key", [field.name for field in fields(FaceNumbers)])
def test_an_absurd_number_for_the_limits_is_an_answer_or_one_line(key, capsys):
    """A billion teeth ended in a ValueError of the root finder."""
    for value in ABSURD:
        given = {name: BASE[name] for name in ("pinion_teeth", "face_gear_teeth", "module_mm")} | {key: value}
        words = [word for name, text in given.items() for word in (flag(name), str(text))]
        try:
            code = main(("limits", *words))
        except SystemExit as stop:
            code = stop.code
        said = capsys.readouterr()
        assert code in (0, 2) or (said.out + said.err).count("\n") == 1


def test_a_file_that_the_system_refuses_ends_in_one_line(monkeypatch, capsys):
    def refuse(_):
        raise PermissionError(13, "Permission denied", "/shut/own.yaml")

    monkeypatch.setattr("facegear.__main__.load_config", refuse)
    assert main(("check", "own.yaml")) == 1
    assert capsys.readouterr().err == "/shut/own.yaml: permission denied\n"


@pytest.mark.parametrize("usable", [True, False])
def test_a_run_has_a_cache_of_its_own_where_the_home_folder_allows_none(monkeypatch, tmp_path, usable):
    """Snakemake ended with PermissionError; the folder of results can be written, or nothing could."""
    home = tmp_path / "home"
    home.mkdir() if usable else home.write_text("a file")
    monkeypatch.setenv("XDG_CACHE_HOME", str(home))
    monkeypatch.chdir(tmp_path)
    given = []

    def begin(command, env):
        given.append(env)
        return contextlib.nullcontext(SimpleNamespace(wait=lambda: 0))

    monkeypatch.setattr("subprocess.Popen", begin)
    main(("run", str(ROOT / "config" / "harmonics_only.yaml")))
    wanted = home if usable else tmp_path / ".snakemake" / "cache"
    assert given[0]["XDG_CACHE_HOME"] == str(wanted)


@pytest.mark.parametrize("name", ["misaligned", "unequal_inputs", "eight_pinions"])
def test_the_example_machines_are_configs_without_mistakes(capsys, name):
    assert main(("check", str(ROOT / "examples" / "machines" / f"{name}.yaml"))) == 0
    assert f"no mistakes; {4 if name == 'misaligned' else 1} case" in capsys.readouterr().out


CASE = str(ROOT / "config" / "harmonics_only.yaml")


def test_pictures_of_named_figures_are_drawn_beside_the_run_and_nothing_else(tmp_path, capsys):
    assert main(("figures", CASE, "mode_shapes", "--png", "--results", str(tmp_path))) == 0
    (path,) = (path for path in tmp_path.rglob("*") if path.is_file())
    assert path.parts[-2:] == ("figures", "mode_shapes.png") and path.read_bytes().startswith(b"\x89PNG")
    assert capsys.readouterr().out == f"{path}\n"


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (("mode_shape", "--png"), "figure 'mode_shape': must be one of this case: "),
        (("mode_shapes",), "figures: the svg in "),
    ],
)
def test_figures_that_cannot_be_drawn_end_in_one_line(tmp_path, capsys, arguments, line):
    assert main(("figures", CASE, *arguments, "--results", str(tmp_path))) == 1
    message = capsys.readouterr().err
    assert message.startswith(line) and message.count("\n") == 1
    assert not list(tmp_path.iterdir())
