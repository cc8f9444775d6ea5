"""Every figure of a run names quantities with units, and both of its drawings show the same."""

import numpy as np
import pytest
from projects import ROOT
from stored_figures import require_equal_drawings, stored_figures

from facegear.report.figures.description import Figure

pytestmark = [pytest.mark.workflow, pytest.mark.xdist_group("workflow")]
UNITS = {
    *(
        "",
        "1",
        "rpm",
        "µm",
        "mm",
        "m",
        "N",
        "kN",
        "N m",
        "N/µm",
        "N/m",
        "MPa",
        "Hz",
        "kHz",
        "ms",
        "s",
        "W",
        "W/mm",
    ),
    *("K", "°C", "%", "% of the mean", "pitches", "mesh cycles", "m/s", "10⁻³/µm"),
}


@pytest.fixture(scope="module", params=["quick", "paper"])
def figures(request):
    """Return the figures of a case by name; those of the paper where a run has stored them."""
    if request.param == "quick":
        folder = request.getfixturevalue("quick").folder / "results"
    else:
        folder = ROOT / "results"
        if not (folder / "paper" / "dynamics" / "sweep.csv").exists():
            pytest.skip("no results of config/paper.yaml")
    return dict(stored_figures(ROOT / "config" / f"{request.param}.yaml", folder))


def texts(figure: Figure):
    """Return every text of a figure."""
    panels = [text for panel in figure.panels for text in (panel.title, panel.x.label, panel.y.label)]
    names = [
        getattr(mark, "name", "") or getattr(mark, "text", "") for p in figure.panels for mark in p.marks
    ]
    return [figure.title, figure.y_label, figure.legend_title, *panels, *names]


def test_every_axis_names_its_quantity_and_unit(figures):
    for name, figure in figures.items():
        for panel in figure.panels if not figure.is_drawing else ():
            for axis, label in ((panel.x, ""), (panel.y, figure.y_label)):
                assert axis.name or label or axis.ticks, name
                assert axis.unit in UNITS, (name, axis.unit)
            for scale in panel.scales():
                assert scale.name and scale.unit in UNITS, name
        for text in texts(figure):
            assert not any(word in text for word in ("None", "nan", "-0.0", "$", "_")), (name, text)


def test_both_drawings_show_the_same_numbers_ends_and_names(figures):
    compared = [name for name, figure in figures.items() if not figure.is_drawing]
    assert len(compared) > 12
    for name in compared:
        require_equal_drawings(figures[name])


def test_every_title_fits_a_telephone_and_no_number_of_a_curve_is_infinite(figures):
    for name, figure in figures.items():
        for panel in figure.panels:
            assert max(map(len, panel.title.split("\n"))) <= 60, (name, panel.title)
            for mark in panel.marks:
                assert not np.isinf(np.asarray(getattr(mark, "y", 0.0), dtype=float)).any(), name
