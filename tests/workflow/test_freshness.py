"""Jobs that are run again, and jobs that are not, after an edit of code or config."""

import ast
import json
import os
import re
import subprocess
import sys

import pytest
from projects import ROOT, Project, copy_sources, environment

pytestmark = [pytest.mark.workflow, pytest.mark.xdist_group("workflow")]
QUICK = ("--configfile", str(ROOT / "config" / "quick.yaml"))


START = """
import pkgutil, sys
listed = pkgutil.iter_modules
pkgutil.iter_modules = lambda *paths: (m for m in listed(*paths) if "_executor_plugin_" not in m.name)
from snakemake.cli import main
try:
    main()
finally:
    slow = {"skfem", "xarray", "matplotlib", "scipy.stats"}
    print("imported:", *slow & {*sys.modules})
"""
"""A start without executors that are installed beside, and what it imported that is slow."""


def test_second_run_does_nothing_and_imports_no_solvers_and_no_compiler(quick):
    """These would take half of such a start; Snakemake itself imports pandas."""
    command = [sys.executable, "-c", START, *quick.command(*QUICK)[3:]]
    done = subprocess.run(command, env=environment(), capture_output=True, text=True, check=False)
    assert "Nothing to be done" in done.stderr
    assert done.stdout.splitlines()[-1].split() == ["imported:"]


def test_a_first_run_parses_the_sources_of_the_rules_that_it_needs_alone(tmp_path):
    """Parsing those of all benchmarks, too, took a fresh clone a second before it could plan."""
    sources = copy_sources(tmp_path)
    Project(tmp_path / "run", sources).run("results/paper/modal/frequencies.csv")
    parsed = json.loads((sources / ".snakemake" / "sources.json").read_text())["files"]
    names = {module for _, imports in parsed.values() for _, module, _ in imports}
    assert "facegear.machine.modes" in names
    assert "facegear.sparse.matrices" not in names


@pytest.fixture(scope="session")
def edited(tmp_path_factory, quick):
    """Function: rules that would run after replacing text in one source file of a copy of the project."""
    sources = copy_sources(tmp_path_factory.mktemp("sources"))
    config = ("--configfile", str(sources / "config" / "quick.yaml"))

    def planned(name, old, new):
        path = sources / name
        original, times = path.read_text(), path.stat()
        assert old in original, f"{name} no longer holds {old!r}: choose another edit"
        try:
            path.write_text(original.replace(old, new, 1))
            return Project(quick.folder, sources).planned(*config)
        finally:
            path.write_text(original)
            os.utime(path, ns=(times.st_atime_ns, times.st_mtime_ns))

    return planned


def with_statement(edited, reference):
    """Rules that would run after another statement in a function, `module:function`."""
    module, _, name = reference.partition(":")
    path = f"{module.replace('.', '/')}.py"
    text = (ROOT / path).read_text()
    function = next(node for node in ast.parse(text).body if getattr(node, "name", "") == name)
    first = function.body[1 if ast.get_docstring(function) else 0]
    lines = text.splitlines(keepends=True)
    before, after = "".join(lines[: first.lineno - 1]), "".join(lines[first.lineno - 1 :])
    return edited(path, text, f"{before}    edited = 1\n{after}")


def test_copy_of_the_sources_has_nothing_to_do(edited):
    assert edited("facegear/errors.py", '"""Errors', '"""Errors') == set()


@pytest.mark.parametrize(
    ("function", "reruns", "spares"),
    [
        ("facegear.teeth.limits:radius_limits", {"geometry"}, {"modal"}),
        (
            "facegear.sparse.matrices:solve_sparse",
            {"compliance", "contact"},
            {"geometry", "mesh", "modal"},
        ),
        (
            "facegear.machine.modes:modes_of",
            {"modal"},
            {"geometry", "mesh", "compliance", "contact", "stiffness"},
        ),
        (
            "facegear.sharing.even_shares:sharing_coefficient",
            {"load_sharing"},
            {"contact", "stiffness", "dynamics_response", "modal"},
        ),
        (
            "facegear.report.figures.machine:modal_figures",
            {"modes_figures"},
            {"modal", "contact", "dynamics_response", "load_sharing"},
        ),
    ],
)
def test_editing_a_function_reruns_its_stages_and_those_after_it(edited, function, reruns, spares):
    planned = with_statement(edited, function)
    assert reruns <= planned
    assert not spares & planned


def test_a_function_that_nothing_calls_reruns_nothing(edited):
    name = "facegear/machine/modes.py"
    last = (ROOT / name).read_text()[-40:]
    assert edited(name, last, f"{last}\n\ndef added() -> int:\n    return 1\n") == set()


@pytest.mark.parametrize("module", ["facegear/sparse/matrices.py", "facegear/teeth/design.py"])
def test_a_comment_reruns_nothing(edited, module):
    last = (ROOT / module).read_text()[-40:]
    assert edited(module, last, f"{last}# only a comment\n") == set()


@pytest.mark.parametrize(
    ("pattern", "replacement"),
    [
        (r"backlash_um: [\d.]+", "backlash_um: 101"),
        (r"per_input_n_m: [\d.]+", "per_input_n_m: 777"),
        (r"mass_per_s: [\d.]+", "mass_per_s: 801"),
        (r"angle_pitches: 22.5", "angle_pitches: 23"),
    ],
)
def test_a_change_of_the_transmission_recomputes_nothing_before_the_dynamics(edited, pattern, replacement):
    old = re.search(pattern, (ROOT / "config" / "paper.yaml").read_text()).group()
    planned = edited("config/paper.yaml", old, replacement)
    assert "dynamics_response" in planned
    assert not {"geometry", "mesh", "compliance", "contact", "stiffness"} & planned


def test_a_change_of_tooth_data_recomputes_everything_after_geometry(edited):
    old = re.search(r"outer_radius_mm: \S+", (ROOT / "config" / "paper.yaml").read_text()).group()
    planned = edited("config/paper.yaml", old, "outer_radius_mm: 274")
    assert {
        "geometry",
        "mesh",
        "compliance",
        "contact",
        "stiffness",
        "dynamics_response",
        "load_sharing",
    } <= planned
