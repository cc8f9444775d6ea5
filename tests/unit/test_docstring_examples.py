"""The examples in the docstrings of the front door give what they show."""

import doctest
from importlib import import_module
from pathlib import Path

import matplotlib.pyplot as plt
import pytest

ROOT = Path(__file__).parents[2]
MODULES = sorted(
    ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")
    for path in (ROOT / "facegear").rglob("*.py")
    if "\n    >>> " in (text := path.read_text()) or "\n>>> " in text
)


def test_the_front_door_shows_examples():
    assert {"facegear", "facegear.gearbox"} <= set(MODULES)


@pytest.mark.xdist_group("notebooks")  # the example's contact analysis is computed once a process
@pytest.mark.parametrize("name", MODULES)
def test_examples_give_what_they_show(name, monkeypatch):
    monkeypatch.chdir(ROOT)
    found = doctest.testmod(import_module(name), optionflags=doctest.ELLIPSIS)
    plt.close("all")
    assert found.attempted
    assert not found.failed
