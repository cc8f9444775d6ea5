"""A reader opens a page of the report in Chromium: values by pointer, zoom, tables, dark mode, print."""

import base64
import io
import re
import shutil

import numpy as np
import pandas as pd
import pytest
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import sync_playwright

from facegear.report.compact import sweep_picture
from facegear.report.figures.colours import colour_of
from facegear.report.figures.description import Axis, Figure, Panel
from facegear.report.figures.draw_matplotlib import save
from facegear.report.figures.marks import Band, ColourScale, Curve, Map
from facegear.report.figures.motion import mesh_sweeps, translations
from facegear.report.first_screen import FirstScreen, Key
from facegear.report.page import Chapter, Picture, data_uri, render
from facegear.report.table import Table
from facegear.report.verdicts import Verdict

CHROMIUM = shutil.which("chromium")
pytestmark = [
    pytest.mark.xdist_group("browser"),
    pytest.mark.skipif(CHROMIUM is None, reason="no chromium: .ci/run installs it"),
]
A4 = {"width": 710, "height": 1030}
"""Pixels of a page of A4 within its margins."""
OVER_SPEED = "figure-mesh_sweep"
DIM = "#440154"
WIDER = """[...document.querySelectorAll('#first-screen *')]
  .filter(part => part.scrollWidth > part.clientWidth + 1 && getComputedStyle(part).display !== 'inline')
  .map(part => part.outerHTML.slice(0, 80))"""
"""Parts of the first screen that hold more than their width."""
COLOURS = ("green", "red", "grey")
DOTS = """async sources => {
  const [first, second] = await Promise.all(sources.map(async source => {
    const image = new Image(), canvas = document.createElement("canvas");
    image.src = source;
    await image.decode();
    Object.assign(canvas, { width: 800, height: 800 * image.height / image.width });
    const dots = canvas.getContext("2d");
    dots.fillStyle = "white";
    dots.fillRect(0, 0, canvas.width, canvas.height);
    dots.drawImage(image, 0, 0, canvas.width, canvas.height);
    return dots.getImageData(0, 0, canvas.width, canvas.height).data;
  }));
  let dark = 0, other = 0;
  for (let green = 1; green < first.length; green += 4) {
    dark += first[green] < 155;
    other += Math.abs(first[green] - second[green]) > 25;
  }
  return [4 * dark / first.length, 4 * other / first.length, first.length - second.length];
}"""
"""Script that compares two pictures drawn 800 px wide: dark dots of the first, dots that differ, both as
fractions."""


def dim_colours():
    """Return a line and an area of the same dark violet."""
    ends = np.array([0.0, 1.0])
    marks = [Curve(ends, ends, "line", DIM), Band(ends, ends + 2.0, ends + 3.0, colour=DIM, opacity=1.0)]
    return Figure([Panel(Axis("x", "mm"), Axis("y", "mm"), marks)])


def wide_legend():
    """Return a panel below a legend as wide as the figure."""
    ends = np.array([0.0, 1.0])
    curves = [Curve(ends, n * ends, f"curve of the mesh {n}", colour_of(n)) for n in range(4)]
    return Figure([Panel(Axis("speed", "rpm"), Axis("force", "kN"), curves, own_legend=True)])


def long_title():
    """Return a narrow panel beside a bar of colours, below a title wider than the panel."""
    at = np.array([0.0, 1.0])
    drawn = Map(at, at, np.array([[1.0, 2.0], [2.0, 3.0]]), ColourScale("Pressure", "MPa", 1.0, 3.0))
    title = "1200 N m: 1568 ± 9 MPa; tip edges up to 857 N/mm"
    return Figure([Panel(Axis("along", "mm"), Axis("radius", "mm"), [drawn], title=title)])


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    """Two figures of a sweep, a narrow and the widest kind of table, and verdicts of each colour."""
    folder = tmp_path_factory.mktemp("page")
    speeds = np.linspace(1000.0, 9000.0, 9)
    rows = [
        (direction, speed, quantity, item, 1.0 + np.sin(1e-3 * speed), "period-1", True)
        for direction in ("up", "down")
        for quantity, item in (
            ("deflection_ac_rms_um", "input/upper"),
            ("deflection_ac_rms_um", "tail/upper"),
        )
        + (("x_ac_rms_um", "input"), ("y_ac_rms_um", "input"))
        for speed in speeds
    ]
    columns = ["direction", "speed_rpm", "quantity", "body_or_mesh", "value", "class", "periodic"]
    sweep = pd.DataFrame(rows, columns=columns)
    jumps = pd.DataFrame({"direction": ["up"], "kind": "jump", "speed_after_rpm": [4000.0]})
    drawn = {
        "mesh_sweep": mesh_sweeps(sweep, jumps, ["input", "tail"], ["upper"]),
        "pinion_sweep": translations(sweep, ["input"], "xy"),
    }
    for name, figure in drawn.items():
        save(figure, folder / f"{name}.svg", folder / f"{name}.json")
    drawn["dim"] = dim_colours()
    save(drawn["dim"], folder / "dim.svg", folder / "dim.json")
    drawn["legend"] = wide_legend()
    save(drawn["legend"], folder / "legend.svg", folder / "legend.json")
    drawn["titled"] = long_title()
    save(drawn["titled"], folder / "titled.svg", folder / "titled.json")
    pictures = [Picture(folder / f"{name}.svg", f"Sweep, {name}.") for name in drawn]
    modes = pd.DataFrame({"mode": ["7", "8", "9"], "frequency_hz": [597.5591, 1010.1912, 812.3]})
    wide = pd.DataFrame({f"largest_line_load_{n}_n_per_mm": [1234.5678 + n] * 4 for n in range(20)})
    judged = [Verdict("Pitting", colour, "safety 1.0 " * 8, ("edge contact",)) for colour in COLOURS]
    keys = [Key(f"Number {n}", "2,086 → 2,074 kW", "beside it", "Its definition.", n == 3) for n in range(8)]
    drawn_small = [sweep_picture(sweep, jumps, 7500.0)] * 3
    warned = [("Machine", ["transmission.mesh_kinematics: " + "words " * 30])]
    first = FirstScreen("red", "Not as required:", "words " * 25, keys, drawn_small, judged, warned)
    chapters = [
        Chapter("Modes", "Text.", tables=[Table("Natural frequencies", modes), Table("Wide", wide)]),
        Chapter("Sweeps", "", pictures),
    ]
    (folder / "report.html").write_text(render("A machine", "Lead.", chapters, first), encoding="utf-8")
    return folder / "report.html"


@pytest.fixture(scope="module")
def browser():
    with sync_playwright() as playwright:
        running = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield running
        running.close()


@pytest.fixture
def opened(browser, report):
    """Opens the report in a window of a width; afterwards no script has failed."""
    contexts, failures = [], []

    def opening(width=1280, script=True, **wishes):
        size = {"width": width, "height": 900}
        contexts.append(browser.new_context(viewport=size, java_script_enabled=script, **wishes))
        page = contexts[-1].new_page()
        page.on("pageerror", lambda error: failures.append(str(error)))
        page.on("request", lambda request: failures.append(request.url) if "//" in request.url[5:] else None)
        page.goto(report.as_uri())
        if script:
            page.wait_for_function("document.documentElement.dataset.plots === 'ready'")
        return page

    yield opening
    for context in contexts:
        context.close()
    assert not [failure for failure in failures if not failure.startswith(("file:", "blob:", "data:"))]


def drawn(page, name):
    """The figure, in view and drawn."""
    page.locator(f"#{name}").scroll_into_view_if_needed()
    page.wait_for_selector(f"#{name}[data-drawn=true]")
    return page.locator(f"#{name} .live")


def middle_of(page, name):
    """Centre of a figure's first panel on the screen, and the panel's width."""
    box = page.locator(f"#{name} .nsewdrag").first.bounding_box()
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2, box["width"]


def test_the_pointer_shows_values_with_units_up_and_down_side_by_side(opened):
    page = opened()
    drawn(page, OVER_SPEED)
    x, y, _ = middle_of(page, OVER_SPEED)
    page.mouse.move(x, y)
    label = page.wait_for_selector(f"#{OVER_SPEED} .hoverlayer .legend")
    words = label.text_content()
    assert re.search(r"up : [\d.,]+ µm.*down : [\d.,]+ µm", words), words
    assert re.search(r"speed [\d.,]+ rpm", words), words


def test_a_drag_zooms_every_figure_over_speed_and_a_legend_switches_a_curve_everywhere(opened):
    page = opened()
    drawn(page, "figure-pinion_sweep")
    graph = drawn(page, OVER_SPEED)
    before = graph.evaluate("graph => graph.layout.xaxis.range")
    x, y, width = middle_of(page, OVER_SPEED)
    page.mouse.move(x - width / 4, y)
    page.mouse.down()
    page.mouse.move(x + width / 4, y, steps=3)
    page.mouse.up()
    after = graph.evaluate("graph => [...graph.layout.xaxis.range]")
    assert after[0] > before[0] and after[1] < before[1]
    other = page.locator("#figure-pinion_sweep .live")
    assert other.evaluate("graph => [...graph.layout.xaxis.range]") == after
    page.locator(f"#{OVER_SPEED} .legendtoggle").first.click(force=True)
    page.wait_for_function(f"document.querySelector('#{OVER_SPEED} .live').data[0].visible === 'legendonly'")
    hidden = graph.evaluate("graph => graph.data.filter(t => t.visible === 'legendonly').map(t => t.name)")
    assert hidden == ["up", "up"]


def test_a_table_is_sorted_by_its_head_and_kept_as_csv_with_all_its_digits(opened):
    page = opened()
    head = page.locator("#modes th button", has_text="frequency (Hz)")
    for order in (["597.6", "812.3", "1,010"], ["1,010", "812.3", "597.6"]):
        head.click()
        assert page.locator("#modes table").first.locator("td:nth-child(2)").all_inner_texts() == order
    with page.expect_download() as download:
        page.locator("#modes a.csv").first.click()
    assert download.value.suggested_filename == "modes-natural-frequencies.csv"
    kept = pd.read_csv(io.BytesIO(download.value.path().read_bytes()))
    assert kept["frequency_hz"].tolist() == [597.5591, 1010.1912, 812.3]


@pytest.mark.parametrize(("width", "scheme"), [(1280, "light"), (390, "dark")])
def test_the_page_has_no_serious_fault_of_accessibility_and_fits_the_window(opened, width, scheme):
    page = opened(width, color_scheme=scheme)
    drawn(page, OVER_SPEED)
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    assert page.evaluate(WIDER) == [], "the first screen is read without scrolling sideways"
    paper = page.evaluate("getComputedStyle(document.body).backgroundColor")
    assert (sum(map(int, re.findall(r"\d+", paper)[:3])) < 200) == (scheme == "dark")
    faults = Axe().run(page).response["violations"]
    serious = [fault for fault in faults if fault["impact"] in ("serious", "critical")]
    assert not [(fault["id"], fault["nodes"][0]["html"][:120]) for fault in serious]


def test_the_first_screen_leads_from_the_sentence_to_the_verdicts_at_1280_by_800(opened):
    page = opened()
    page.set_viewport_size({"width": 1280, "height": 800})
    tops = page.evaluate(
        "['.status', '.keys', '.pictures', '.verdicts tbody'].map(e => "
        "document.querySelector(e).getBoundingClientRect().top)"
    )
    assert tops == sorted(tops) and tops[-1] < 760
    figures = "[...document.querySelectorAll('.pictures figure')].map(e => e.getBoundingClientRect().y)"
    assert len(set(page.evaluate(figures))) == 1, "three pictures beside each other"


def test_columns_beyond_the_eighth_are_shown_by_a_click(opened):
    page = opened()
    wide = page.locator("#modes table").nth(1)
    assert wide.locator("th:visible").count() == 8
    page.get_by_label("all 20 columns").check()
    assert wide.locator("th:visible").count() == 20


def test_in_the_dark_a_dim_line_is_light_and_an_area_keeps_the_colour_of_its_scale(opened):
    """The darkest lines of a scale could not be seen on the dark page."""
    colours = []
    for scheme in ("light", "dark"):
        graph = drawn(opened(color_scheme=scheme), "figure-dim")
        traces = graph.evaluate("graph => graph.data.map(trace => [trace.line?.color, trace.fillcolor])")
        ((line, _),) = [trace for trace in traces if trace[1] is None]
        ((_, area),) = [trace for trace in traces if trace[1] is not None]
        colours.append((line, area))
    (line, area), (light_line, dark_area) = colours
    assert dark_area == area
    assert sum(map(int, re.findall(r"\d+", light_line)[:3])) > 250 and light_line != line


def test_print_fits_a4_with_every_column_and_the_stills(opened):
    page = opened()
    drawn(page, OVER_SPEED)
    page.emulate_media(media="print")
    page.set_viewport_size(A4)
    widths = page.evaluate("[...document.querySelectorAll('main table')].map(table => table.scrollWidth)")
    assert len(widths) == 3 and max(widths) <= A4["width"]
    assert page.locator(f"#{OVER_SPEED} img").is_visible()
    assert not page.locator(f"#{OVER_SPEED} .live").is_visible()
    printed = page.pdf(prefer_css_page_size=True)
    assert len(re.findall(rb"/Type\s*/Page\b(?!s)", printed)) <= 2
    assert re.search(rb"/MediaBox \[0 0 59[45]\S* 84[12]", printed), "A4"


def test_no_heading_of_a_chapter_is_left_alone_at_the_end_of_a_printed_page(opened):
    """Between text and figures stood an empty part, before which a page could end."""
    page = opened()
    page.emulate_media(media="print")
    text = "getComputedStyle(document.querySelector('#modes h2 + p')).breakAfter"
    assert page.evaluate(text) == "avoid"
    parts = "[...document.querySelectorAll('.tables, .figures')]"
    assert page.evaluate(f"{parts}.every(part => part.children.length || !part.checkVisibility())")


def test_without_scripts_the_stills_and_tables_are_there(opened):
    page = opened(script=False)
    assert page.locator(f"#{OVER_SPEED} img").is_visible() and page.locator("#modes table").first.is_visible()
    assert page.locator("nav a").count() == 2


def test_a_still_on_the_page_shows_the_stored_drawing_dot_for_dot(browser, report):
    """A page holds its stills shortened, a third smaller; what a reader sees is what the file shows."""
    stored = report.parent / "mesh_sweep.svg"
    still = data_uri(stored.read_text(encoding="utf-8"))
    assert len(still) < 0.8 * len(base64.b64encode(stored.read_bytes()))
    whole = f"data:image/svg+xml;base64,{base64.b64encode(stored.read_bytes()).decode()}"
    page = browser.new_page()
    dark, other, larger = page.evaluate(DOTS, [whole, still])
    page.close()
    assert dark > 0.01, "the drawing is not empty"
    assert other < 1e-3 and larger == 0


def test_the_toolbar_of_a_figure_never_covers_its_legend(opened):
    page = opened()
    for name in (OVER_SPEED, "figure-legend"):
        drawn(page, name).hover()
        bar = page.locator(f"#{name} .modebar").bounding_box()
        for part in (".legend", ".annotation"):
            for text in (one.bounding_box() for one in page.locator(f"#{name} {part}").all()):
                below = text["y"] >= bar["y"] + bar["height"]
                assert below or text["x"] + text["width"] <= bar["x"], (name, part, text, bar)


@pytest.mark.parametrize("width", [390, 1280])
def test_the_title_of_no_panel_is_cut(opened, width):
    """At 390 px titles of the contact pattern began outside the figure."""
    page = opened(width)
    for name in (OVER_SPEED, "figure-titled"):
        drawn(page, name)
        whole = page.locator(f"#{name} .live").bounding_box()
        for note in page.locator(f"#{name} .annotation").all():
            box = note.bounding_box()
            assert box["x"] >= whole["x"] and box["x"] + box["width"] <= whole["x"] + whole["width"] + 1
