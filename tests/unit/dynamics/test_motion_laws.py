"""Every law of the kernels has what CONTRIBUTING.md says under "Add a mesh law"."""

import importlib
import re
from pathlib import Path

import pytest
from test_machines_side_by_side import OSCILLATORS

from facegear._kernels import motion

ROOT = Path(__file__).parents[3]
SOURCES = ROOT / "facegear" / "_kernels" / "src"
LAWS = re.findall(r"shared_ptr<const (\w+)Law>", (SOURCES / "motion" / "laws" / "all.hpp").read_text())


def file_name(law):
    """LoadDependent is load_dependent."""
    return re.sub(r"(?<=[a-z])(?=[A-Z])", "_", law).lower()


@pytest.mark.parametrize("law", LAWS)
def test_a_law_has_its_header_its_runners_its_python_file_and_an_oscillator(law):
    name = file_name(law)
    assert f"struct {law}Law" in (SOURCES / "motion" / "laws" / f"{name}.hpp").read_text()
    assert f"make_runner<motion::{law}Law>" in (SOURCES / "bindings" / f"motion_{name}.cpp").read_text()
    made = getattr(importlib.import_module(f"facegear.mesh_law.{name}"), f"{law}Law")
    assert callable(getattr(motion, f"{name}_law"))
    own = [system.law for system, _ in OSCILLATORS.values() if isinstance(system.law, made)]
    assert own and all(type(each.kernel_law) is getattr(motion, f"{law}Law") for each in own)


def test_the_recipe_names_files_that_are_there():
    text = (ROOT / "CONTRIBUTING.md").read_text()
    recipe = text[text.index("## Add a mesh law") :]
    recipe = recipe[: recipe.index("\n## ", 1)]
    for path in re.findall(r"`((?:facegear|tests)/[\w/]+\.\w+)`", recipe):
        assert (ROOT / path).exists(), path
    assert LAWS == ["Linear", "LoadDependent", "Power"]
