"""Laws and contact states of the kernels are added as CONTRIBUTING.md says."""

import importlib
import re
import shutil
import subprocess
import sysconfig
from pathlib import Path

import nanobind
import pytest
from test_machines_side_by_side import OSCILLATORS

from facegear._kernels import motion

ROOT = Path(__file__).parents[3]
SOURCES = ROOT / "facegear" / "_kernels" / "src"
LAWS = re.findall(r"shared_ptr<const (\w+)Law>", (SOURCES / "motion" / "laws" / "all.hpp").read_text())

PYTHON_FILES = {"Moving": "facegear.meshing.moving_law"}
"""Modules of laws whose name alone would not say what they hold."""


def file_name(law):
    """LoadDependent is load_dependent."""
    return re.sub(r"(?<=[a-z])(?=[A-Z])", "_", law).lower()


@pytest.mark.parametrize("law", LAWS)
def test_a_law_has_its_header_its_runners_its_python_file_and_an_oscillator(law):
    name = file_name(law)
    assert f"struct {law}Law" in (SOURCES / "motion" / "laws" / f"{name}.hpp").read_text()
    assert f"make_runner<motion::{law}Law>" in (SOURCES / "bindings" / f"motion_{name}.cpp").read_text()
    made = getattr(importlib.import_module(PYTHON_FILES.get(law, f"facegear.meshing.{name}")), f"{law}Law")
    assert callable(getattr(motion, f"{name}_law"))
    own = [system.law for system, _ in OSCILLATORS.values() if isinstance(system.law, made)]
    assert own and all(type(each.kernel_law) is getattr(motion, f"{law}Law") for each in own)


def recipe(heading):
    """Return the section of CONTRIBUTING.md under a heading."""
    text = (ROOT / "CONTRIBUTING.md").read_text()
    section = text[text.index(f"## {heading}\n") :]
    return section[: section.index("\n## ", 1)]


@pytest.mark.parametrize("heading", ["Add a mesh law", "Add a contact state"])
def test_the_recipe_names_files_that_are_there(heading):
    paths = re.findall(r"`((?:facegear|tests)/[\w/]+\.\w+)`", recipe(heading))
    assert len(paths) >= 3
    for path in paths:
        assert (ROOT / path).exists(), path
    assert LAWS == ["Linear", "LoadDependent", "Power", "Moving"]


def test_the_steps_to_a_contact_state_name_what_stands_in_their_files():
    """Each name of a step in code letters stands in one of the step's files."""
    steps = re.findall(r"^\d+\. (.*)", recipe("Add a contact state"), re.M)
    assert len(steps) == 6
    for step in steps:
        files = re.findall(r"`((?:facegear|tests)/[\w/]+\.\w+)`", step)
        if "switches" in step or "advance" in step or "system.hpp" in step:
            files.append("facegear/_kernels/src/motion/parting.hpp")
        text = "".join((ROOT / file).read_text() for file in files)
        names = re.findall(r"`(\w+)`", step)
        assert names and all(re.search(rf"\b{name}\b", text) for name in names), step


@pytest.fixture(scope="module")
def with_twin(tmp_path_factory):
    """Return copied sources to which a law was added by the first three steps: the power law, as a twin."""
    sources = tmp_path_factory.mktemp("law") / "src"
    shutil.copytree(SOURCES, sources)

    def rename(text):
        return text.replace("PowerLaw", "TwinLaw").replace("power_law", "twin_law").replace("/power", "/twin")

    law = sources / "motion" / "laws"
    (law / "twin.hpp").write_text(rename((law / "power.hpp").read_text()))
    listed = (law / "all.hpp").read_text()
    listed = listed.replace("#include", '#include "motion/laws/twin.hpp"\n#include', 1)
    power = "std::shared_ptr<const PowerLaw>"
    (law / "all.hpp").write_text(listed.replace(power, f"{power}, std::shared_ptr<const TwinLaw>"))
    bindings = sources / "bindings"
    runners = (bindings / "motion_power.cpp").read_text()
    (bindings / "motion_twin.cpp").write_text(rename(runners))
    bound = (bindings / "motion.cpp").read_text()
    function = re.search(r"^std::shared_ptr<const motion::PowerLaw> power_law.*?^}\n", bound, re.M | re.S)[0]
    class_ = re.search(r"^    nb::class_<motion::PowerLaw>.*;\n", bound, re.M)[0]
    maker = re.search(r'^    module.def\("power_law".*;\n', bound, re.M)[0]
    for part in (function, class_, maker):
        bound = bound.replace(part, part + rename(part))
    (bindings / "motion.cpp").write_text(bound)
    return sources


@pytest.mark.skipif(shutil.which("c++") is None, reason="the recipe's law is compiled by a C++ compiler")
@pytest.mark.parametrize("file", ["motion.cpp", "motion_twin.cpp"])
def test_a_law_that_follows_the_recipe_compiles_and_changes_no_other_file(with_twin, file):
    assert compiler_messages(with_twin, file) == ""
    assert changed_files(with_twin) == {
        "motion/laws/twin.hpp",
        "motion/laws/all.hpp",
        "bindings/motion.cpp",
        "bindings/motion_twin.cpp",
    }


@pytest.fixture(scope="module")
def with_state(tmp_path_factory):
    """Return copied sources to which a contact state was added by the recipe: that of parting, as a twin."""
    sources = tmp_path_factory.mktemp("state") / "src"
    shutil.copytree(SOURCES, sources)

    def rename(text):
        return (
            text.replace("parting", "muted")
            .replace("push_only", "muted")
            .replace("look_at_force", "look_at_muted")
        )

    def add_twin(file, *patterns):
        """Repeat each part of a file that a pattern finds, with the names of the new state."""
        text = (sources / file).read_text()
        for pattern in patterns:
            part = re.search(pattern, text, re.M | re.S)[0]
            text = text.replace(part, part + rename(part), 1)
        (sources / file).write_text(text)

    add_twin("motion/work.hpp", "&parting, ", ", parting(?=;)")
    add_twin("motion/contact_states.hpp", r"^ *w\.parting\.put.*?\n")
    parting = (sources / "motion" / "parting.hpp").read_text()
    found = [
        re.search(rf"^template[^\n]*\n\w+ {name}_parting\(.*?^}}\n", parting, re.M | re.S)[0]
        for name in ("find", "correct")
    ]
    code = "\n".join(
        ['#pragma once\n#include "motion/parting.hpp"\nnamespace facegear::motion {', *found, "}\n"]
    )
    (sources / "motion" / "muted.hpp").write_text(rename(code))
    add_twin(
        "motion/advance.hpp",
        r'^#include "motion/parting.hpp"\n',
        r"^ *if [^\n]*find_parting.*?\n",
        r"^ *if [^\n]*correct_parting.*?\n",
    )
    add_twin(
        "motion/switches.hpp",
        r"^template[^\n]*\nvoid look_at_force.*?^}\n",
        r"^ *if [^\n]*look_at_force.*?\n",
    )
    add_twin("motion/system.hpp", ", push_only = false")
    add_twin(
        "bindings/motion.cpp",
        "bool push_only, ",
        r"^ *s->push_only.*?\n",
        r"made_for.push_only == other.push_only &&",
        '"push_only"_a, ',
    )
    return sources


@pytest.mark.skipif(shutil.which("c++") is None, reason="the recipe's state is compiled by a C++ compiler")
@pytest.mark.parametrize("file", ["motion.cpp", "motion_power.cpp"])
def test_a_contact_state_that_follows_the_recipe_compiles_and_changes_no_other_file(with_state, file):
    assert compiler_messages(with_state, file) == ""
    named = re.findall(r"`facegear/_kernels/src/([\w/<>]+\.[hc]pp)`", recipe("Add a contact state"))
    expected = {name.replace("<state>", "muted") for name in named} - {"motion/parting.hpp"}
    assert changed_files(with_state) == expected


def compiler_messages(sources, file):
    """Return what the compiler says of a file of the bindings."""
    places = [sources, nanobind.include_dir(), sysconfig.get_path("include")]
    command = ["c++", "-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Werror", "-Wno-psabi"]
    include = [word for place in places for word in ("-isystem" if place != sources else "-I", str(place))]
    done = subprocess.run(
        [*command, *include, str(sources / "bindings" / file)], capture_output=True, text=True, check=False
    )
    assert (done.returncode == 0) == (not done.stderr)
    return done.stderr[:2000]


def changed_files(sources):
    """Return the files of copied sources that are not those of the repository."""
    return {str(path.relative_to(sources)) for path in sources.rglob("*.?pp") if differs(path, sources)}


def differs(path, sources):
    """Return whether a file is not that of the repository."""
    original = SOURCES / path.relative_to(sources)
    return not original.exists() or original.read_bytes() != path.read_bytes()
