"""The report page stands alone and shows what it was given."""

import re

import pandas as pd

from facegear.report.page import Chapter, Picture, Table, render


def page(tmp_path):
    picture = tmp_path / "a.svg"
    picture.write_text("<svg xmlns='http://www.w3.org/2000/svg' width='2' height='2'/>")
    frame = pd.DataFrame({"frequency_hz": [756.7123, float("nan")], "class": ["pinion <b>", "gear"]})
    chapter = Chapter("Modes & shapes", "One.\n\nTwo.", (Picture(picture, "Figure"),), (Table("T", frame),))
    return render("Case", "Lead", [chapter])


def test_page_needs_no_other_file(tmp_path):
    text = page(tmp_path)
    assert "data:image/svg+xml;base64," in text
    assert not re.search(r'(src|href)="(?!data:|#)', text)


def test_text_is_escaped_and_missing_numbers_are_blank(tmp_path):
    text = page(tmp_path)
    assert "pinion &lt;b&gt;" in text
    assert "<td>756.71</td>" in text
    assert "nan" not in text
    assert text.count("<p>") == 3


def test_units_in_column_names_are_written_out():
    frame = pd.DataFrame(columns=["torque_n_m", "k_average_n_per_m mean", "speed_before_rpm", "motion"])
    assert Table("T", frame).header() == [
        "torque (N m)",
        "k average (N/m) mean",
        "speed before (rpm)",
        "motion",
    ]
