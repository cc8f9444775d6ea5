"""Every capability has an independent reference, and the stored references are those of the tests."""

import importlib
import inspect
import pkgutil
import re

import numpy as np
import pandas as pd
import pytest

import facegear.pipeline.results
from facegear.gearbox import Gearbox
from facegear.pipeline.provenance.fingerprint import loaded_modules
from facegear.pipeline.results.base import Result
from facegear.pipeline.table import STAGES
from validation.references import (
    COLUMNS,
    DECLARED_COLUMNS,
    INDEPENDENT,
    METHOD_TITLES,
    NO_LESS,
    ROOT,
    Kind,
    comparison_tables,
    counts_table,
    declarations,
    read,
    shares_table,
)

DECLARATIONS = declarations()
WITHOUT_NUMBERS = {"with_values", "study", "report", "run", "figures", "summary"}
"""Public methods of the Gearbox that compute nothing."""


def methods():
    """Stage or name of every public method of the Gearbox that computes."""
    for module in pkgutil.iter_modules(facegear.pipeline.results.__path__):
        importlib.import_module(f"facegear.pipeline.results.{module.name}")
    stages = {one.__name__: one.STAGE for one in Result.__subclasses__()}
    public = [name for name in vars(Gearbox) if not name.startswith("_") and callable(vars(Gearbox)[name])]
    gives = {name: inspect.get_annotations(vars(Gearbox)[name])["return"] for name in public}
    return {name: stages.get(str(given).strip("\"'"), name) for name, given in gives.items()}


@pytest.fixture(scope="module")
def stored():
    """The stored references."""
    return read()


METHODS = {name: stage for name, stage in methods().items() if name not in WITHOUT_NUMBERS}


@pytest.mark.parametrize("capability", [*STAGES, *METHODS])
def test_every_stage_and_every_method_of_a_gearbox_has_an_independent_reference(stored, capability):
    independent = stored[stored["kind"].isin(INDEPENDENT)]
    checked = {name for names in independent["capability"].str.split() for name in names}
    assert METHODS.get(capability, capability) in checked


def test_a_capability_that_is_checked_is_a_stage_or_a_method():
    checked = {name for one in DECLARATIONS.values() for name in one.capability.split()}
    assert checked <= {*STAGES, *METHODS}
    assert set(METHOD_TITLES) == set(METHODS.values()) - set(STAGES)


def test_the_stored_references_are_those_that_the_tests_declare(stored):
    """Otherwise `make verification` stores them anew."""
    assert tuple(stored.columns) == COLUMNS
    declared = {
        tuple(getattr(one, key) for key in ("test", *DECLARED_COLUMNS)) for one in DECLARATIONS.values()
    }
    assert {tuple(row) for row in stored[["test", *DECLARED_COLUMNS]].itertuples(index=False)} == declared


def test_stored_values_lie_within_their_tolerances(stored):
    missed = stored["expected"] - stored["computed"]
    error = np.where(stored["relation"] == NO_LESS, np.maximum(missed, 0.0), np.abs(missed))
    assert (error <= stored["tolerance"] * (1.0 + 1e-5)).all()
    np.testing.assert_allclose(stored["error"], error, rtol=6e-3, atol=1e-300)
    assert not stored.duplicated(["test", "quantity"]).any()
    assert stored["date"].str.fullmatch(r"\d{4}-\d\d-\d\d").all()
    assert stored["commit"].str.fullmatch(r"[0-9a-f]{7,}").all()


@pytest.mark.parametrize("capability", STAGES)
def test_a_stage_is_made_with_the_modules_that_its_references_check(capability):
    stage = STAGES[capability]
    stages = (stage, *(STAGES[source.stage] for source in stage.upstream.values()))
    reached = loaded_modules([name for one in stages for name in one.functions], ROOT)
    checked = {one.module for one in DECLARATIONS.values() if capability in one.capability.split()}
    assert checked <= reached


@pytest.mark.parametrize("counts", [(1, 1, 1), (1, 2, 4), (341, 81, 46, 17, 37, 65), (0, 0, 5)])
def test_shares_of_all_kinds_are_printed_and_add_up(counts):
    kinds = [kind for kind, count in zip(Kind, counts, strict=False) for _ in range(count)]
    lines = shares_table(pd.DataFrame({"kind": kinds})).splitlines()[2:]
    cells = [line.strip("| ").split(" | ") for line in lines]
    assert [cell[0] for cell in cells] == [*Kind, "all"]
    tenths = [round(10 * float(cell[2].removesuffix(" %"))) for cell in cells]
    assert sum(tenths[:-1]) == tenths[-1] == 1000
    for cell, tenth in zip(cells[:-1], tenths, strict=False):
        rows = 0 if cell[1] == "none" else int(cell[1])
        assert abs(tenth - 1000 * rows / len(kinds)) < 1


def test_a_row_of_an_unknown_kind_is_refused():
    with pytest.raises(ValueError, match="other program"):
        shares_table(pd.DataFrame({"kind": ["other program"]}))


def test_the_page_opens_with_the_shares_and_says_what_was_never_measured():
    page = (ROOT / "docs" / "reference" / "verification.md").read_text(encoding="utf-8")
    assert page.index("\n## ") == page.index("\n## What was never checked against the real world")
    opening = page[page.index("\n## ") : page.index("\n## How it is checked")].splitlines()
    assert "<!-- generated: shares -->" in opening
    assert sum(line.startswith(("- **Strong**", "- **Weak**", "- **Missing**")) for line in opening) == 5


def test_the_pages_show_every_stored_row_and_every_capability(stored):
    shown = re.findall(r"^\| .* \|$", comparison_tables(stored), flags=re.MULTILINE)
    headings = re.findall(r"^## .*\(`(\w+)`\)$", comparison_tables(stored), flags=re.MULTILINE)
    assert len(shown) == len(headings) + len(stored)
    assert len(set(headings)) == len(headings)
    counted = [line.split(" | ")[0].removeprefix("| ") for line in counts_table(stored).splitlines()[2:]]
    assert len(counted) == len(set(counted)) and set(counted) == {*STAGES, *METHODS.values()}


SECTIONS = (
    *("Summary", "Statement of need", "State of the field", "Software design", "Research impact statement"),
    *("AI usage disclosure", "Acknowledgements", "References"),
)
"""Sections that the Journal of Open Source Software asks for."""


def test_the_paper_has_its_sections_and_claims_only_programs_that_the_page_shows(stored):
    paper = (ROOT / "docs" / "joss" / "paper.md").read_text(encoding="utf-8")
    headings = re.findall(r"^# (.+)$", paper, flags=re.MULTILINE)
    assert set(SECTIONS) <= set(headings)
    (claimed,) = re.findall(r"as references: (.+?) compute cases", paper)
    programs = re.split(r", | and ", claimed.replace("`", ""))
    sources = " ".join(stored.loc[stored["kind"] != Kind.CONVERGENCE, "source"])
    assert len(programs) == 5 and [name for name in programs if name not in sources] == []
    assert "None of them is a measurement of a machine" in paper or (stored["kind"] == Kind.MEASUREMENT).any()
