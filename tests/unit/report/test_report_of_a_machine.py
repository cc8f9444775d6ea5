"""The report of a whole machine on paper: config/concentric.yaml, from tables that a run of it wrote.

concentric.zip holds them and the sizes of the figures: `python -m validation.report_pages results/concentric
--store tests/unit/report/concentric.zip` after `snakemake --cores 2 --configfile config/concentric.yaml`.
"""

import html
import json
import re
import shutil
import zipfile
from pathlib import Path

import pandas as pd
import pytest
from axe_playwright_python.sync_playwright import Axe

from facegear.build.config import resolved_values
from facegear.build.load import base_path, load_config
from facegear.build.notes import notes
from facegear.io import tables
from facegear.report.case import case_report
from facegear.report.machine import Base
from validation.report_pages import A4, chromium, print_page

ROOT = Path(__file__).parents[3]
CONFIG = ROOT / "config" / "concentric.yaml"
MOST_PAGES = 25
WIDE = """[...document.querySelectorAll('.scroll')]
  .filter(box => box.checkVisibility() && box.scrollWidth > box.clientWidth + 1)
  .map(box => box.getAttribute('aria-label'))"""
"""Tables that are wider than the page."""
COLUMNS = """[...document.querySelectorAll('main table')].filter(table => table.checkVisibility())
  .map(table => [...table.rows[0].cells].filter(cell => cell.checkVisibility()).length)"""
"""Columns that each table shows."""
REASONS = """Math.min(...[...document.querySelectorAll('.verdicts tr')]
  .map(row => row.cells[2].offsetWidth / row.offsetWidth))"""
"""Smallest part of a verdict's width that its reason has."""
pytestmark = [
    pytest.mark.xdist_group("browser"),
    pytest.mark.skipif(shutil.which("chromium") is None, reason="no chromium: .ci/run installs it"),
]


def in_parts(table):
    """Return a table whose rows are numbered anew in its second half, as one that was put together."""
    return table.set_index(pd.Index([row % max(len(table) // 2, 1) for row in range(len(table))]))


@pytest.fixture(scope="module")
def concentric(tmp_path_factory):
    """The page as the report writes it today, of stored tables; figures are empty and as large as drawn."""
    folder = tmp_path_factory.mktemp("concentric")
    with zipfile.ZipFile(Path(__file__).with_name("concentric.zip")) as archive:
        archive.extractall(folder)
    values = {**resolved_values(load_config(CONFIG)), "reproduction": False}
    base = base_path(CONFIG)
    text = case_report(
        values,
        {path.stem: in_parts(tables.read(path, allow_empty=True)) for path in folder.glob("*.csv")},
        {path.stem: path for path in sorted(folder.glob("*.svg"))},
        json.loads((folder / "manifests.json").read_text()),
        json.loads((folder / "pair.json").read_text()),
        base=None
        if base is None
        else Base(base.name, {**resolved_values(load_config(base)), "reproduction": False}),
        notes=notes({**values, "reproduction": None}),
    )
    page = folder / "report.html"
    page.write_text(text, encoding="utf-8")
    return page


def test_a_whole_machine_prints_on_at_most_25_pages_of_a4_with_every_column_of_every_table(concentric):
    with chromium() as browser:
        page = browser.new_page()
        page.goto(concentric.as_uri())
        unread = page.evaluate("[...document.images].filter(image => !image.naturalWidth).length")
        pages, right_edges = print_page(page)
        figures = page.locator("figure[id] img").count()
    assert len(right_edges) >= 20 and figures >= 25, "a whole machine"
    assert pages <= MOST_PAGES
    assert max(right_edges) <= A4["width"]
    assert unread == 0, "stills that no reader has scrolled to are printed, too"


@pytest.mark.parametrize(("width", "scheme"), [(1280, "light"), (390, "dark")])
def test_a_whole_machine_has_no_serious_fault_of_accessibility_and_fits(concentric, width, scheme):
    with chromium() as browser:
        context = browser.new_context(viewport={"width": width, "height": 844}, color_scheme=scheme)
        page = context.new_page()
        page.goto(concentric.as_uri())
        assert page.evaluate("document.documentElement.scrollWidth") <= width
        faults = Axe().run(page).response["violations"]
        reasons = page.evaluate(REASONS)
    serious = [fault for fault in faults if fault["impact"] in ("serious", "critical")]
    assert not [(fault["id"], fault["nodes"][0]["html"][:120]) for fault in serious]
    assert reasons >= 0.5, "a reason has at least half the width of its verdict"


def test_the_page_holds_no_none_no_minus_zero_and_no_plural_of_one(concentric):
    page = concentric.read_text(encoding="utf-8").split("<main>")[1].split("</main>")[0]
    text = html.unescape(re.sub(r"<[^>]*>", " ", re.sub(r"(?s)<img [^>]*>|<svg.*?</svg>", " ", page)))
    assert len(text) > 10_000
    wrong = r"(?<!\w)(?:None|nan|-0|-0\.0+|1 (?:keys|cases|verdicts|flanks|jumps|speeds))(?![\w.,])"
    assert re.findall(wrong, text) == []


def test_every_table_fits_1280_px_and_shows_at_most_eight_columns(concentric):
    with chromium() as browser:
        page = browser.new_page(viewport={"width": 1280, "height": 800})
        page.goto(concentric.as_uri())
        wide = page.evaluate(WIDE)
        columns = page.evaluate(COLUMNS)
    assert wide == [] and len(columns) >= 15 and max(columns) <= 8
