"""Reports of whole machines in Chromium: `python -m validation.report_pages results/concentric`.

Size, time to open and printed pages go to docs/measured/report_pages.csv. With `--store FILE` the tables of
the first folder are stored as well, so that a test prints its page without computing the machine.
"""

import argparse
import json
import os
import re
import shutil
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from statistics import median
from typing import Any

import pandas as pd
from playwright.sync_api import Browser, Page, ViewportSize, sync_playwright

from facegear.io import documents, tables
from facegear.pipeline.report_tables import REPORT_TABLES, table_name
from facegear.pipeline.table import STAGES
from facegear.report.compare.answers import SAME_DATE
from validation.references import ROOT

TABLE = ROOT / "docs" / "measured" / "report_pages.csv"
A4: ViewportSize = {"width": 710, "height": 1030}
"""Pixels of a page of A4 within its margins."""
TIMES = 5
"""Number of times that a page is opened for the times printed."""
OPEN_FRACTION, VIBRATION = "open_fraction", "deflection_ac_rms_um"
"""Quantities of a sweep that the report reads: of all meshes, and of the one that vibrates most."""
MANIFEST_KEYS = ("rule", "summary", "seconds", "made_at", "code", "versions")
"""Keys of each rule's manifest that the report reads."""
RIGHT_EDGES = """() => {
  const end = cell => cell.getBoundingClientRect().left + cell.scrollWidth;
  return [...document.querySelectorAll("main table")].filter(table => table.checkVisibility())
    .map(table => Math.floor(Math.max(...[...table.querySelectorAll("th, td")].map(end))));
}"""
TIMING = """() => ({
  load: performance.getEntriesByType("navigation")[0].loadEventEnd,
  paint: performance.getEntriesByName("first-contentful-paint")[0]?.startTime ?? NaN,
})"""


@contextmanager
def chromium() -> Iterator[Browser]:
    """Open a browser that is closed afterwards.

    Yields
    ------
    Browser
        The browser.
    """
    with sync_playwright() as playwright:
        running = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        yield running
        running.close()


def print_page(page: Page) -> tuple[int, list[int]]:
    """Print a page on A4.

    Parameters
    ----------
    page : Page
        The open page.

    Returns
    -------
    tuple[int, list[int]]
        Number of printed pages, and where (px) the last column of each of its tables ends on them.
    """
    page.emulate_media(media="print")
    page.set_viewport_size(A4)
    edges = page.evaluate(RIGHT_EDGES)
    content = page.pdf(prefer_css_page_size=True)
    return len(re.findall(rb"/Type\s*/Page\b(?!s)", content)), edges


def time_opening(browser: Browser, path: Path) -> dict[str, float]:
    """Measure how long a page takes to open.

    Parameters
    ----------
    browser : Browser
        The browser.
    path : Path
        Path of the page.

    Returns
    -------
    dict[str, float]
        Times in ms until the page is loaded and first painted, and processor time of its own thread.
    """
    page = browser.new_page(viewport={"width": 1280, "height": 900})
    session = page.context.new_cdp_session(page)
    session.send("Performance.enable", {"timeDomain": "threadTicks"})
    page.goto(path.resolve().as_uri(), wait_until="load")
    times = page.evaluate(TIMING)
    metrics = {item["name"]: item["value"] for item in session.send("Performance.getMetrics")["metrics"]}
    page.close()
    return {"load_ms": times["load"], "paint_ms": times["paint"], "cpu_ms": 1e3 * metrics["TaskDuration"]}


def measure_report(browser: Browser, path: Path) -> dict[str, Any]:
    """Measure a report's size, times and printed pages.

    Parameters
    ----------
    browser : Browser
        The browser.
    path : Path
        Path of the report.

    Returns
    -------
    dict[str, Any]
        One row of the table.
    """
    times = pd.DataFrame([time_opening(browser, path) for _ in range(TIMES)])
    page = browser.new_page()
    page.goto(path.resolve().as_uri())
    pages, edges = print_page(page)
    figures = page.locator("figure[id]").count()
    page.close()
    return {
        "machine": path.parent.name,
        "size_mb": round(path.stat().st_size / 1e6, 2),
        "a4_pages": pages,
        "tables": len(edges),
        "tables_wider_than_a4": sum(edge > A4["width"] for edge in edges),
        "figures": figures,
        **{f"{name}_{statistic}": round(value) for name in times for statistic, value in _range(times[name])},
        "load_average": round(os.getloadavg()[0], 1),
    }


def _range(values: pd.Series) -> list[tuple[str, float]]:
    return [("median", median(values)), ("largest", values.max())]


def stored_tables(folder: Path) -> dict[str, pd.DataFrame]:
    """Read the tables that the report of a case reads; of a sweep OPEN_FRACTION and VIBRATION.

    Parameters
    ----------
    folder : Path
        Results of the case.

    Returns
    -------
    dict[str, DataFrame]
        Tables by name.
    """
    files_read = [(name, file) for name, files in REPORT_TABLES.items() for file in files]
    paths = [
        folder / STAGES[name].files[file].path for name, file in (*files_read, ("duty_loads", "duty_loads"))
    ]
    read = {table_name(path): tables.read(path, allow_empty=True) for path in paths if path.exists()}
    if "sweep" in read:
        sweep = read["sweep"]
        vibration = sweep[sweep["quantity"] == VIBRATION]
        loudest = vibration.loc[vibration["value"].idxmax(), "body_or_mesh"]
        is_loudest = (sweep["quantity"] == VIBRATION) & (sweep["body_or_mesh"] == loudest)
        read["sweep"] = sweep[(sweep["quantity"] == OPEN_FRACTION) | is_loudest]
    return read


def store(folder: Path, path: Path) -> None:
    """Store the inputs of a case's report in one file: tables, records and the sizes of its figures.

    Parameters
    ----------
    folder : Path
        Results of the case.
    path : Path
        Path of the file (zip).
    """
    contents = {f"{name}.csv": frame.to_csv(index=False) for name, frame in stored_tables(folder).items()}
    contents |= {f"{svg.stem}.svg": empty_drawing(svg) for svg in sorted(folder.glob("figures/*.svg"))}
    manifests = [documents.read(file, ["rule"]) for file in sorted(folder.glob("*/*.provenance.json"))]
    contents["manifests.json"] = json.dumps(
        [{key: manifest[key] for key in MANIFEST_KEYS} for manifest in manifests]
    )
    contents["pair.json"] = (folder / "geometry" / "pair.json").read_text(encoding="utf-8")
    with zipfile.ZipFile(path, "w") as archive:
        for name, text in sorted(contents.items()):
            archive.writestr(zipfile.ZipInfo(name, SAME_DATE), text, zipfile.ZIP_DEFLATED)


def empty_drawing(svg: Path) -> str:
    """Return a svg as large as another, with nothing on it.

    Parameters
    ----------
    svg : Path
        Path of the other.

    Returns
    -------
    str
        Text of the svg.
    """
    (start,) = re.findall(r"(?s)<svg [^>]*>", svg.read_text(encoding="utf-8"))[:1]
    return f"{start}</svg>"


def main() -> None:
    """Measure the reports of the folders given, and store the first one's tables where asked."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folders", nargs="+", type=Path, help="results of a case, with its report.html")
    parser.add_argument("--store", type=Path, help="file (zip) for the tables of the first folder")
    options = parser.parse_args()
    if options.store:
        store(options.folders[0], options.store)
    with chromium() as browser:
        rows = [measure_report(browser, folder / "report.html") for folder in options.folders]
    pd.DataFrame(rows).to_csv(TABLE, index=False)
    print(pd.DataFrame(rows).T.to_string(header=False))


if __name__ == "__main__":
    main()
