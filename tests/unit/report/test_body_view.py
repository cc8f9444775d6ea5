"""Mode shapes in the report's viewer are those of the stage, in a few kilobytes, and move when asked."""

import base64
import gzip
import json
import re
import shutil

import numpy as np
import pandas as pd
import pytest
from playwright.sync_api import sync_playwright

from facegear.build.config import resolved_values
from facegear.build.load import load_config
from facegear.report.case import case_report
from facegear.report.page import Chapter, render
from facegear.report.viewers import body_view, boundary

CHROMIUM = shutil.which("chromium")
RINGS, LEVELS = 13, 3
RADII, HEIGHTS = np.linspace(0.12, 0.28, RINGS), np.linspace(-0.01, 0.01, LEVELS)


@pytest.fixture(scope="module")
def disc():
    """Modes and shapes of two equal flat discs: two nodal diameters that lift the rim, and a torsion."""
    nodes = np.array([(r, z) for z in HEIGHTS for r in RADII])
    corners = [k * RINGS + i for k in range(LEVELS - 1) for i in range(RINGS - 1)]
    quads = np.array([(a, a + 1, a + RINGS + 1, a + RINGS) for a in corners])
    grown = (nodes[:, 0] - RADII[0]) / np.ptp(RADII)
    lifts = np.column_stack([0.0 * grown, 0.1 * grown, 3.0 * grown])
    twists = np.column_stack([0.0 * grown, grown, 0.0 * grown])
    one = {
        "nodes": nodes,
        "quads": quads,
        "labels": np.array([[0, 1], [2, 1]]),
        "shapes": np.array([twists, lifts]),
    }
    shapes = {f"{gear}_{name}": array for gear in ("lower", "upper") for name, array in one.items()}
    rows = [(gear, order, 1, 300.0 + 400.0 * order) for gear in ("lower", "upper") for order in (0, 2)]
    return pd.DataFrame(rows, columns=["gear", "nodal_diameters", "mode", "frequency_hz"]), shapes


def test_the_outline_goes_once_round_the_section(disc):
    _, shapes = disc
    along = boundary(shapes["lower_quads"])
    assert along.size == np.unique(along).size == 2 * (RINGS + LEVELS) - 4
    x, y = shapes["lower_nodes"][along].T
    area = 0.5 * abs(x @ np.roll(y, -1) - y @ np.roll(x, -1))
    assert area == pytest.approx(np.ptp(RADII) * np.ptp(HEIGHTS))


def test_motions_of_the_viewer_are_those_of_the_modes_to_a_part_in_thirty_thousand(disc):
    modes, shapes = disc
    view = body_view(modes, shapes)
    assert list(view.data["gears"]) == ["lower and upper"], "gears that are alike are shown once"
    (gear,) = view.data["gears"].values()
    outline = np.frombuffer(base64.b64decode(gear["points"]), "<f4").reshape(-1, 2)
    grown = (outline[:, 0] / 1e3 - RADII[0]) / np.ptp(RADII)
    torsion, lift = (
        np.frombuffer(base64.b64decode(mode["shape"]), "<i2").reshape(-1, 3) / 32767
        for mode in view.data["modes"]
    )
    np.testing.assert_allclose(torsion[:, 1], grown, atol=2e-5)
    np.testing.assert_allclose(lift[:, 2] * np.hypot(3.0, 0.1), 3.0 * grown, atol=1e-4)
    assert [mode["frequency_hz"] for mode in view.data["modes"]] == [300.0, 1100.0]
    assert body_view(modes[:0], shapes) is None


def test_the_page_with_mode_shapes_stays_small_and_names_each_control(disc):
    view = body_view(*disc)
    text = render("Case", "Lead", [Chapter("Modes", "", view=view)])
    assert len(view.compressed_data()) < 2e4
    (stored,) = re.findall(r'<script type="application/gzip">(.*?)</script>', text, re.DOTALL)
    assert json.loads(gzip.decompress(base64.b64decode(stored)))["modes"][1]["order"] == 2
    asked = set(re.findall(r'find\("(\w+)"\)', text))
    assert asked | {"swing", "mode", "wave"} == set(
        re.findall(r'name="?(\w+)"? ?(?:type="range"|type="button"|>)', text)
    )


def test_pictures_and_viewer_of_bodies_stand_in_the_chapter_on_modes(disc, tmp_path):
    names = ("machine_campbell", "body_shapes", "body_waves", "body_campbell")
    for name in names:
        (tmp_path / f"{name}.svg").write_text('<svg xmlns="http://www.w3.org/2000/svg" width="9pt"/>')
    values = resolved_values(load_config("config/harmonics_only.yaml"))
    pictures = {name: tmp_path / f"{name}.svg" for name in names}
    page = case_report(values, {}, pictures, [], bodies=body_view(*disc))
    (chapter,) = re.findall(r'(?s)<section id="modes">(.*?)</section>', page)
    assert 'data-kind="body"' in chapter
    assert all(f'id="figure-{name}"' in chapter for name in names)


@pytest.mark.xdist_group("browser")
@pytest.mark.skipif(CHROMIUM is None, reason="no chromium: .ci/run installs it")
def test_a_reader_chooses_a_mode_and_sees_it_move_with_its_exaggeration_said(disc, tmp_path):
    (tmp_path / "page.html").write_text(render("C", "L", [Chapter("Modes", "", view=body_view(*disc))]))
    pixels = "document.querySelector('.pair-view canvas').toDataURL()"
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=CHROMIUM, args=["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader"]
        )
        page = browser.new_page(viewport={"width": 500, "height": 700})
        failures = []
        page.on("pageerror", lambda error: failures.append(str(error)))
        page.goto((tmp_path / "page.html").as_uri())
        page.wait_for_function("document.querySelector('.pair-view output').textContent !== ''")
        said = page.locator(".pair-view output").inner_text()
        assert "2 nodal diameters, mode 1, 1100 Hz" in said and "drawn: 22 mm, exaggerated" in said
        bent = page.evaluate(pixels)
        page.locator("[name=swing]").fill("0")
        page.wait_for_function(
            "document.querySelector('.pair-view output').textContent.includes('drawn: 0 mm')"
        )
        assert page.evaluate(pixels) != bent
        page.locator("[name=swing]").fill("40")
        page.locator("[name=move]").click()
        page.wait_for_function(f"(before => {pixels} !== before)({json.dumps(bent)})", timeout=5000)
        assert page.evaluate("document.documentElement.scrollWidth") <= 500
        browser.close()
    assert not failures
