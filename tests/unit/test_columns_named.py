"""The docstring of every table names its columns, whose units stand at the end of their names."""

import pkgutil
import re
from importlib import import_module
from inspect import getmembers, getsource, isfunction, signature
from pathlib import Path

import pandas as pd
import pytest

import facegear
from facegear.pipeline.results.base import Result
from facegear.pipeline.stage import load
from facegear.pipeline.table import STAGES

ROOT = Path(__file__).parents[2]
CASES = {
    "harmonics_only": ("stiffness", "modes", "statics", "hunting", "sensitivity", "response", "load_sharing"),
    "shafts": ("shafts",),
}
OWN_NAMES = (
    *("cycles", "samples", "winners", "designs", "imprint", "over_angle"),
    *("coefficients", "irregular_ends"),
)
"""Tables whose columns follow from the machine or the search, or are those of another method."""


def tables_of(kind):
    """Public methods of a kind of result that return a table, by name."""
    return {
        name: method
        for name, method in getmembers(kind, isfunction)
        if not name.startswith("_") and signature(method).return_annotation in (pd.DataFrame, "pd.DataFrame")
    }


def stored_columns(kind, method):
    """Columns that readers of the stored file ask for, of a method that gives a file as it is."""
    parts = re.findall(r'self\.content\["(\w+)"\]', getsource(method))
    stage, part = kind.BESIDE.get(parts[0], (kind.STAGE, parts[0])) if parts else (kind.STAGE, "")
    file = STAGES[stage].files.get(part)
    if file is None or not file.path.endswith(".csv"):
        return ()
    holds = load(file.holds) if isinstance(file.holds, str) else file.holds
    return (*holds, *file.text)


def kinds():
    for module in pkgutil.iter_modules(facegear.pipeline.results.__path__):
        import_module(f"facegear.pipeline.results.{module.name}")
    return Result.__subclasses__()


def missing(columns, method):
    words = set(re.findall(r"\w+", method.__doc__))
    return [column for column in columns if column not in words]


@pytest.mark.parametrize("kind", kinds(), ids=lambda kind: kind.__name__)
def test_the_docstring_of_a_table_names_the_columns_of_its_file(kind):
    for name, method in tables_of(kind).items():
        if name in OWN_NAMES:
            continue
        assert missing(stored_columns(kind, method), method) == [], name


@pytest.mark.parametrize(
    ("case", "answer"), [(case, answer) for case, answers in CASES.items() for answer in answers]
)
def test_the_docstring_of_a_table_names_all_columns_that_it_has(case, answer):
    light = {"load_sharing.cycles": 20, "load_sharing.starts": 1, "load_sharing.hunting_positions": 2}
    found = getattr(machine(case, tuple(light.items())), answer)()
    for name, method in tables_of(type(found)).items():
        if name not in OWN_NAMES:
            assert missing(method(found).columns, method) == [], name


MACHINES = {}


def machine(case, light):
    """A machine, made once."""
    if case not in MACHINES:
        MACHINES[case] = facegear.load(ROOT / "config" / f"{case}.yaml", None).with_values(dict(light))
    return MACHINES[case]
