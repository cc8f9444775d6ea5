"""A reader opens the chapter on the load-sharing map in Chromium: nothing fails, and it fits a phone."""

import shutil

import pytest
from axe_playwright_python.sync_playwright import Axe
from idler_machines import make_idlers
from playwright.sync_api import sync_playwright

from facegear.report.case import case_report
from facegear.report.figures.draw_matplotlib import save
from facegear.report.figures.sharing_map import sharing_map_figure

pytestmark = [
    pytest.mark.xdist_group("browser"),
    pytest.mark.skipif(shutil.which("chromium") is None, reason="no chromium: .ci/run installs it"),
]


@pytest.fixture(scope="module")
def chapter(tmp_path_factory):
    """Write the report of five idlers beside a gear on soft bearings; it holds the map alone."""
    folder = tmp_path_factory.mktemp("sharing_map")
    section = {"samples": 100, "points": 3}
    gearbox = make_idlers(5, 3e8, backlash_um=2000.0).with_values({"sharing_map": section})
    content = gearbox.sharing_map().content
    figure = sharing_map_figure(content["curves"], content["inputs"], content["points"])
    save(figure, folder / "sharing_map.svg", folder / "sharing_map.json")
    tables = {f"sharing_map_{name}": table for name, table in content.items()}
    text = case_report(gearbox.values, tables, {"sharing_map": folder / "sharing_map.svg"}, [])
    page = folder / "report.html"
    page.write_text(text, encoding="utf-8")
    return page


@pytest.mark.parametrize(("width", "scheme"), [(1280, "light"), (390, "dark")])
def test_the_chapter_opens_without_an_error_and_fits(chapter, width, scheme):
    said = []
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        page = browser.new_context(viewport={"width": width, "height": 844}, color_scheme=scheme).new_page()
        page.on("console", lambda message: said.append(message.text))
        page.on("pageerror", lambda error: said.append(str(error)))
        page.goto(chapter.as_uri())
        section = page.locator("section", has=page.locator("h2", has_text="Load-sharing map"))
        section.scroll_into_view_if_needed()
        section.locator(".js-plotly-plot").wait_for()
        assert "let the upper face gear float" in section.inner_text()
        assert page.evaluate("document.documentElement.scrollWidth") <= width
        faults = Axe().run(page).response["violations"]
        browser.close()
    assert said == []
    assert not [(fault["id"], fault["nodes"][0]["html"][:120]) for fault in faults]
