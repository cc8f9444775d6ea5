"""The report page stands alone and shows what it was given."""

import base64
import re

import pandas as pd

from facegear.report.case import mode_rows, with_study_titles
from facegear.report.chapter_tables import bins_in_words
from facegear.report.page import Chapter, Picture, render
from facegear.report.table import Table


def page(tmp_path):
    picture = tmp_path / "a.svg"
    picture.write_text("<svg xmlns='http://www.w3.org/2000/svg' width='2' height='2'/>")
    frame = pd.DataFrame({"frequency_hz": [756.7123, float("nan")], "class": ["pinion <b>", "gear"]})
    chapter = Chapter("Modes & shapes", "One.\n\nTwo.", (Picture(picture, "Figure"),), (Table("T", frame),))
    return render("Case", "Lead", [chapter])


def test_page_needs_no_other_file(tmp_path):
    text = page(tmp_path)
    assert "src='data:image/svg+xml,%3Csvg " in text
    assert not re.search(r"""(src|href)=["'](?!data:|#)""", text)


def test_text_is_escaped_and_missing_numbers_are_blank(tmp_path):
    text = page(tmp_path)
    assert "pinion &lt;b&gt;" in text
    assert '<td class="number">756.7</td>' in text
    assert "nan" not in text
    assert text.count("<p>") == 3


def test_units_in_column_names_are_written_out():
    frame = pd.DataFrame(
        columns=["torque_n_m", "k_average_n_per_m mean", "speed_before_rpm", "line_load_n_per_mm", "motion"]
    )
    assert Table("T", frame).header() == [
        "torque (N m)",
        "k average (N/m) mean",
        "speed before (rpm)",
        "line load (N/mm)",
        "motion",
    ]


def test_units_of_heat_motion_and_time_are_written_out():
    """A head said "loss w" and "contact temperature c"."""
    names = {
        "loss_w": "loss (W)",
        "energy_lost_kwh": "energy lost (kWh)",
        "largest_flash_k": "largest flash (K)",
        "contact_temperature_c": "contact temperature (°C)",
        "largest_sliding_m_per_s": "largest sliding (m/s)",
        "life_hours": "life (h)",
        "pinion_w_per_k": "pinion (W/K)",
        "mesh_n_s_per_m": "mesh (N s/m)",
    }
    assert Table("T", pd.DataFrame(columns=[*names])).header() == [*names.values()]
    powers = Table("T", pd.DataFrame({"power_in_w": [251327.0], "loss_w": [1769.0]}))
    assert (powers.header(), powers.rows()) == (["power in (kW)", "loss (kW)"], [["251.3", "1.769"]])


def test_a_study_has_its_title_in_tables_and_not_its_name():
    table = pd.DataFrame({"study": ["nominal", "gear_bearings"], "mean": [1.0, 2.0]})
    titled = with_study_titles({"summary": table}, [{"name": "gear_bearings", "title": "Effect of bearings"}])
    assert titled["summary"]["study"].to_list() == ["nominal", "Effect of bearings"]


def test_bins_that_are_none_of_the_duty_cycle_are_words():
    """The whole duty cycle was bin -1."""
    assert bins_in_words(pd.DataFrame({"bin": [0.0, 1.0, -1.0]}))["bin"].to_list() == [
        "nominal",
        "1",
        "all bins",
    ]


def test_equal_modes_are_one_row_that_says_how_many():
    frequencies = pd.DataFrame(
        {
            "order": [1, 2, 3, 4],
            "frequency_hz": [0.0, 0.0, 0.0, 756.7],
            "multiplicity": [3, 3, 3, 1],
            "symbols": ["R", "R", "R", "T"],
            "class": ["rigid body"] * 3 + ["pinion"],
        }
    )
    rows = mode_rows(frequencies)
    assert rows["modes"].to_list() == ["1 to 3", "4"]
    assert rows["times"].to_list() == ["x 3", ""]


def test_stiffnesses_are_written_in_one_format():
    frame = pd.DataFrame({"mean_n_per_m": [4.1e8, 5.2e7, 9.99e5], "torque_n_m": [600.0, 5.0, 1e5]})
    table = Table("T", frame)
    assert table.header() == ["mean (N/µm)", "torque (N m)"]
    assert [row[0] for row in table.rows()] == ["410", "52", "0.999"]
    none = pd.DataFrame({"sin_n_per_m": [0.0, 2.9e7]})
    assert Table("T", none).rows() == [["0"], ["29"]]


def test_large_forces_are_in_kilonewtons_and_small_ones_are_not():
    frame = pd.DataFrame({"mean_n": [24319.1, 812.0], "peak_n": [26000.0, float("nan")]})
    table = Table("T", frame)
    assert table.header() == ["mean (kN)", "peak (kN)"]
    assert table.rows() == [["24.32", "26"], ["0.812", ""]]
    small = Table("T", 1e-3 * frame)
    assert small.header() == ["mean (N)", "peak (N)"] and small.rows()[0] == ["24.32", "26"]


def test_a_cell_is_never_none_nor_minus_zero():
    frame = pd.DataFrame({"x_um": [-0.0, 1.0], "what": [None, "a"], "count": [1234, 5]})
    assert Table("T", frame).rows() == [["0", "", "1,234"], ["1", "a", "5"]]


def test_a_wide_table_shows_eight_columns_and_the_others_on_demand(tmp_path):
    wide = pd.DataFrame({f"part_{n}": ["x"] for n in range(11)})
    table = Table("Wide", wide, main=("part_9", "part_3"))
    assert table.header()[:3] == ["part 9", "part 3", "part 0"]
    assert table.on_demand() == [False] * 2 + [True] * 9 and sum(Table("Wide", wide).on_demand()) == 3
    text = render("Case", "Lead", [Chapter("C", "", (), (table,))])
    assert "all 11 columns" in text and text.count('class="more"') == 18
    assert (
        "columns"
        not in render("Case", "Lead", [Chapter("C", "", (), (Table("T", wide.iloc[:, :8]),))])
        .split("<main>")[1]
        .split("</main>")[0]
    )


def test_letters_of_a_printed_table_shrink_with_the_words_of_its_row_and_not_with_its_length():
    narrow = pd.DataFrame({"mesh": ["tail idler/upper"] * 3, "force_n": [7712.5] * 3})
    wide = pd.concat([narrow.add_prefix(f"largest_{n}_") for n in range(8)], axis=1)
    sentence = narrow.assign(reason="fillets carry up to 0.27 % of the torque, kept out of the pressure " * 3)
    sizes = [Table("T", frame).print_pt() for frame in (narrow, pd.concat([narrow] * 9), sentence, wide)]
    assert sizes[0] == sizes[1] == sizes[2] == 8.0
    assert 4.0 < sizes[3] < 8.0


def test_text_of_pictures_keeps_its_size_on_a_telephone(tmp_path):
    for name, points in (("a", 338.4), ("b", 792.0)):
        path = tmp_path / f"{name}.svg"
        path.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" width="{points}pt" height="9pt"/>')
        text = render("Case", "Lead", [Chapter("C", "", (Picture(path, "P"),))])
        assert f'width="{round(points * 4 / 3)}"' in text


def test_rounding_is_written_as_zero_and_small_numbers_of_their_own_unit_are_kept():
    frame = pd.DataFrame({"mean_n": [3.3e-12, 210.0], "rms_n": [10.2, 0.5], "energy_fraction": [1e-12, 0.1]})
    assert Table("T", frame).rows() == [["0", "10.2", "1e-12"], ["210", "0.5", "0.1"]]


def test_every_number_is_written_alike_and_the_csv_keeps_all_its_digits():
    """Numbers were 1.234e+04 in one column and 4.1e8 in the next."""
    values = [12345.678, 1234567.0, 2.0e-2, -0.0123456, float("inf"), 10.0, 999999.9]
    frame = pd.DataFrame({"speed_rpm": values, "running": [True, False] * 3 + [True]})
    table = Table("Speeds, of every mesh", frame)
    shown = ["12,346", "1.235e6", "0.02", "-0.01235", "inf", "10", "1,000,000"]
    assert [row[0] for row in table.rows()] == shown
    assert table.numeric() == [True, False] and table.rows()[0][1] == "yes"
    kept = base64.b64decode(table.csv_uri().partition(",")[2]).decode()
    assert kept == frame.to_csv(index=False) and "12345.678" in kept
    assert table.csv_name("modes") == "modes-speeds-of-every-mesh.csv"
