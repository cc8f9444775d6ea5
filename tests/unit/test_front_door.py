"""The front door: what a notebook meets. Every answer of the example takes a second or two."""

import gc
import pkgutil
import subprocess
import sys
import weakref
from copy import deepcopy
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest
from ruamel.yaml import YAML

import facegear
from facegear import errors
from facegear.errors import FacegearError
from facegear.io.tables import LONGEST_NAME
from facegear.pipeline.results.base import Result
from facegear.pipeline.table import STAGES
from facegear.report.compare.answers import open_answer
from facegear.report.compare.judge import compare

pytestmark = pytest.mark.xdist_group("notebooks")  # the example's contact is computed once a process

ROOT = Path(__file__).parents[2]
HEAVY = "{'matplotlib', 'skfem', 'gmsh', 'meshio', 'snakemake', 'paper', 'validation'}"


@pytest.fixture(scope="module")
def gearbox():
    return facegear.example()


def loaded(code):
    command = [sys.executable, "-c", f"{code}; import sys; print(sorted({HEAVY} & set(sys.modules)))"]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()


def test_importing_the_package_loads_nothing_behind_the_door():
    assert loaded("import facegear") == "[]"


def test_modes_need_no_mesh_and_no_compiler():
    own = ROOT / "config" / "harmonics_only.yaml"
    assert loaded(f"import facegear; facegear.load({str(own)!r}).modes().table()") == "[]"


@pytest.mark.parametrize(
    ("mistake", "line"),
    [
        (
            lambda g: g.contact(torques=[600, 300]),
            "contact.torques_n_m = [600.0, 300.0]: must be rising",
        ),
        (lambda g: g.contact(torques="much"), 'contact: contact.torques_n_m = "much"'),
        (lambda g: g.contact(positions=2), "contact.positions_per_pitch = 2: must be greater"),
        (lambda g: g.response(-1), "response: dynamics.speed_rpm = -1: must be greater than"),
        (lambda g: g.sweep(2000, 1000), "dynamics.sweep.to_rpm = 1000.0: must be more than from_rpm = 2000"),
        (lambda g: g.branches(2000, 1000), "branches.to_rpm = 1000.0: must be more than from_rpm = 2000"),
        (lambda g: g.branch_loci(["mass"]), 'parameters[0] = "mass": must be'),
        (lambda g: g.load_sharing(float("nan")), "dynamics.speed_rpm = NaN"),
        (lambda g: g.with_values({"transmission.backlash": 1}), "with_values: transmission.backlash = 1"),
        (lambda g: g.with_values({"case": "other"}), "case = 'other': must be a dotted key"),
        (lambda g: g.with_values({"transmission.backlash_um": -1}), "backlash_um = -1: must be greater"),
        (
            lambda g: g.modes() and g.contact(torques=600).plot("patern"),
            "plot = 'patern': must be one of",
        ),
    ],
)
def test_a_mistake_in_an_argument_is_one_clear_line(gearbox, mistake, line):
    with pytest.raises(FacegearError) as caught:
        mistake(gearbox)
    assert line in str(caught.value)
    assert "\n" not in str(caught.value)


def test_numpy_values_and_single_torques_are_as_good_as_lists(gearbox):
    changed = gearbox.with_values({"contact.torques_n_m": np.array([300.0, 900.0])})
    assert changed.values["contact"]["torques_n_m"] == [300.0, 900.0]
    assert set(gearbox.contact(torques=600).table()["torque_n_m"]) == {600.0}


def test_a_change_of_backlash_computes_no_contact_again(gearbox):
    tight = gearbox.with_values({"transmission.backlash_um": 80})
    assert tight.contact().content["ltca"] is gearbox.contact().content["ltca"]
    assert tight.stiffness().content["tvms"] is gearbox.stiffness().content["tvms"]
    assert tight.load_sharing().content["curve"] is not gearbox.load_sharing().content["curve"]


def test_a_change_of_teeth_forgets_the_contact(gearbox):
    thick = gearbox.with_values({"tooth_pair.face_gear.rim_thickness_mm": 24})
    softer = thick.contact(torques=600).table()["k_average_n_per_m"].mean()
    assert softer < gearbox.contact(torques=600).table()["k_average_n_per_m"].mean()


def test_the_dataset_of_pressures_says_what_the_table_says(gearbox):
    contact = gearbox.contact()
    peaks = contact.pressures()["pressure_mpa"].max(["pair", "plane"])
    message = contact.table().pivot(index="torque_n_m", columns="position", values="pressure_mpa")
    np.testing.assert_allclose(peaks.to_numpy(), message.to_numpy(), rtol=1e-12)


def test_the_dataset_of_a_sweep_holds_every_row_of_its_table(gearbox):
    found = gearbox.sweep(1000, 1200, points=3)
    data = found.dataset()
    assert data.sizes == {"direction": 2, "speed_rpm": 3, "mesh": 10, "body": 7}
    for row in found.content["sweep"].iloc[::37].itertuples():
        at = data[row.quantity].sel(direction=row.direction, speed_rpm=row.speed_rpm)
        kind = [name for name in at.dims if name in ("mesh", "body")]
        assert float(at.sel(dict.fromkeys(kind, row.body_or_mesh))) == row.value


def test_the_files_of_a_sweep_are_saved_although_its_figures_use_more(gearbox, tmp_path):
    assert all(path.stat().st_size for path in gearbox.sweep(1000, 1200, points=3).save(tmp_path))


RENEW = "where this is meant: CONTRIBUTING.md, Stored answers"
ANSWERS = "geometry", "contact", "stiffness", "modes", "response", "load_sharing"


@pytest.fixture(scope="module")
def saved(gearbox, tmp_path_factory):
    """A folder with the files of all answers, and the files of each."""
    folder = tmp_path_factory.mktemp("answers")
    return folder, {name: getattr(gearbox, name)().save(folder) for name in ANSWERS}


@pytest.mark.parametrize("name", ANSWERS)
def test_every_answer_has_a_table_a_figure_and_files(gearbox, saved, name):
    found = getattr(gearbox, name)()
    assert len(found.table())
    assert found.plot().axes
    assert all(path.stat().st_size for path in saved[1][name])
    assert found.source == "computed"


def test_the_example_gives_the_stored_answers(saved):
    with open_answer("current/example") as stored:
        found = compare(stored, saved[0])
    assert found.equal, f"{found.rows.to_string(max_rows=20)}\n{RENEW}"


@pytest.mark.parametrize("name", ["teeth.step", "teeth.STL"])
def test_exact_teeth_are_exported_in_the_format_that_the_ending_names(gearbox, name, tmp_path):
    written = gearbox.export(tmp_path / name, body="face_gear", teeth=1).read_bytes()
    if name.endswith("step"):
        assert written.startswith(b"ISO-10303-21")
    else:
        assert len(written) == 84 + 50 * int.from_bytes(written[80:84], "little") > 84


@pytest.mark.parametrize(
    ("asked", "line"),
    [
        (
            {"path": "teeth.iges"},
            "ending of the path = '.iges': must be one of .step, .stp, .stl, .glb, .fmu, .rexs, .csv",
        ),
        ({"path": "teeth.stl", "body": "gear"}, "body = 'gear': must be one of pinion, face_gear"),
        ({"path": "teeth.stl", "teeth": 24}, "teeth = 24: must be from 1 to 23"),
    ],
)
def test_an_export_that_cannot_be_is_refused_in_one_line(gearbox, asked, line):
    with pytest.raises(FacegearError, match=f"^{line}$"):
        gearbox.export(**asked)


@pytest.fixture(scope="module")
def followed(gearbox):
    """A sweep of three speeds and the branches around them; the meshes have two flanks each."""
    sweep = {"from_rpm": 7380, "to_rpm": 7580, "points": 3}
    narrow = gearbox.with_values({f"dynamics.sweep.{key}": value for key, value in sweep.items()})
    return narrow.branches(7380, 7580, starts=1)


def test_branches_have_tables_figures_and_files(followed, tmp_path):
    table = followed.table()
    assert followed.source == "computed"
    assert table["mesh"].nunique() == 10
    assert (table["deflection_minimum_um"] <= table["deflection_maximum_um"]).all()
    assert all(followed.plot(name).axes for name in ("amplitudes", "fractions", "multipliers"))
    assert all(path.stat().st_size for path in followed.save(tmp_path))
    with pytest.raises(FacegearError, match="plot = 'loci': must be one of amplitudes"):
        followed.plot("loci")


def test_every_periodic_motion_of_the_sweep_lies_on_a_branch(followed):
    swept = followed.swept()
    assert len(swept) == 6
    assert (swept["branch"] != "").all()
    assert swept["distance"].max() < 1e-5
    assert swept["sweep_error"].max() < 1e-2


def test_load_sharing_of_two_gearboxes_stands_in_one_figure(gearbox):
    tight = gearbox.with_values({"transmission.backlash_um": 80})
    figure = gearbox.load_sharing().plot("idlers", label="100 um", beside={"80 um": tight.load_sharing()})
    labels = [line.get_label() for line in figure.axes[0].lines]
    assert [label.split(":")[0] for label in labels] == ["100 um", "80 um"]


def test_given_harmonics_need_no_teeth(tmp_path):
    config = tmp_path / "own.yaml"
    stored = facegear.load(ROOT / "config" / "harmonics_only.yaml")
    assert stored.stiffness().table()["order"].to_list() == [0, 1, 2, 3]
    with pytest.raises(FacegearError, match=r"own\.yaml: no such config file"):
        facegear.load(config)
    with pytest.raises(FacegearError, match="geometry and contact need the bodies"):
        stored.geometry()


def test_what_a_machine_has_computed_is_freed_with_it():
    """A series of machines held 150 MB of each until Python happened to look for cycles."""
    machine = facegear.load(ROOT / "config" / "harmonics_only.yaml", results=None)
    machine.modes()
    kept = weakref.ref(machine.store)
    gc.disable()
    try:
        del machine
        assert kept() is None
    finally:
        gc.enable()


def test_a_mapping_and_a_file_with_the_same_keys_are_the_same_gearbox(tmp_path, monkeypatch):
    file = ROOT / "facegear" / "example.yaml"
    stored = facegear.load(file)
    given = YAML(typ="safe").load(file.read_text())
    before = deepcopy(given)
    assert facegear.load(given).config == stored.config
    assert given == before
    given["mesh_stiffness"]["mean_n_per_m"] = np.float64(5e8)
    given["transmission"]["pinions"] = tuple(given["transmission"]["pinions"])
    changed = {"mesh_stiffness.mean_n_per_m": 5e8}
    assert facegear.load(given).config == stored.with_values(changed).config
    monkeypatch.chdir(tmp_path)
    own = {"extends": file, "mesh_stiffness": {"mean_n_per_m": 5e8}}
    assert facegear.load(own).values == stored.with_values(changed).values


@pytest.mark.parametrize(
    ("given", "line"),
    [
        ({}, "config: case = (missing): this key is required"),
        ({"extends": "no.yaml"}, "no.yaml: no such config file"),
        ({"extends": 3}, "config: extends = 3: must be the name of a config file"),
        ({"extends": "config/harmonics_only.yaml", "dynamics": {"speed": 3}}, "dynamics.speed = 3: unknown"),
    ],
)
def test_a_mistake_in_a_mapping_is_one_line_as_in_a_file(given, line):
    with pytest.raises(facegear.ConfigErrors) as caught:
        facegear.load(given)
    assert line in str(caught.value).splitlines()[0]


def test_every_error_that_a_user_may_meet_has_a_name_in_the_package():
    own = {one for one in vars(errors).values() if isinstance(one, type) and issubclass(one, Exception)}
    for error in own - {errors.GeometryError}:
        assert getattr(facegear, error.__name__) is error and error.__name__ in facegear.__all__
        assert issubclass(error, facegear.FacegearError)
    assert issubclass(errors.GeometryError, facegear.InvalidInput)


def test_values_of_a_gearbox_and_of_its_results_are_copies():
    """Setting a number inside them changed later answers, of the example until Python ended."""
    gearbox = facegear.example().with_values({"mesh_stiffness.mean_n_per_m": 4.2e8})
    before = gearbox.modes().table()["frequency_hz"].to_list()
    for values in (gearbox.values, gearbox.modes().values, facegear.example().values):
        values["transmission"]["pinion"]["mass_kg"] = 77.0
        values["mesh_stiffness"]["mean_n_per_m"] = 1e9
        values["transmission"]["pinions"].clear()
    assert gearbox.values["transmission"]["pinion"]["mass_kg"] == 1.199
    assert facegear.example().values["transmission"]["pinions"]
    again = gearbox.with_values({"dynamics.speed_rpm": 7000}).modes().table()["frequency_hz"].to_list()
    assert gearbox.modes().table()["frequency_hz"].to_list() == again == before


def test_the_machine_at_rest_is_in_balance(gearbox):
    """Every pinion's meshes take the torque that it brings; the gears' torques are those of the teeth."""
    found = gearbox.statics()
    bodies, meshes = found.bodies().set_index("body"), found.table()
    pinions = meshes.groupby(meshes["mesh"].str.rpartition("/")[0])["pinion_torque_n_m"].sum()
    torque = bodies["torque_n_m"]
    np.testing.assert_allclose(pinions, torque[pinions.index], atol=1e-7 * torque.abs().max())
    assert bodies["power_kw"].sum() == pytest.approx(0.0, abs=1e-9 * bodies["power_kw"].abs().max())


def test_the_sensitivity_to_an_error_is_the_change_that_the_error_makes(gearbox):
    """Per um, against a machine with that error of half a micrometre."""
    found = gearbox.sensitivity(positions=8)
    row = found.table().query("error == 'error right input/upper' and group == 'right input'").iloc[0]

    def k_gamma(error_um):
        mesh = {"right input/upper": {"error_um": error_um}}
        changed = gearbox.with_values({"transmission.single_meshes": mesh})
        return changed.hunting(positions=8).table().set_index("group").loc["right input", "k_gamma"]

    assert row["per_um"] == pytest.approx(k_gamma(0.5) - k_gamma(-0.5), rel=2e-3)


def test_a_study_holds_every_combination_and_says_what_was_changed(gearbox):
    keys = ("transmission.backlash_um", "mesh_stiffness.mean_n_per_m")
    study = gearbox.study({keys[0]: [80, 120], keys[1]: np.array([4e8, 5e8])})
    table = study.table("modes")
    assert len(study.machines) == 4 and len(table) == 4 * len(gearbox.modes().table())
    largest = table.groupby(keys[1])["frequency_hz"].agg(["max", "count"])
    assert largest.loc[5e8, "max"] > largest.loc[4e8, "max"]
    assert set(largest["count"]) == {len(table) // 2}


@pytest.mark.parametrize(
    ("mistake", "line"),
    [
        (lambda g: g.study({"transmission.backlash_um": []}), "must hold at least one value"),
        (lambda g: g.study({"transmission.backlash_um": [-1]}), "backlash_um = -1: must be greater"),
        (lambda g: g.study({"transmission.backlash_um": [80]}).table("mods"), "answer = 'mods': must be"),
        (lambda g: g.study({"transmission.backlash_um": [80]}).plot("modes"), "one of load_sharing, sweep"),
        (lambda g: g.report("own.pdf"), "own.pdf: must end in .html"),
    ],
)
def test_a_mistake_in_a_study_or_a_report_is_one_clear_line(gearbox, mistake, line):
    with pytest.raises(FacegearError) as caught:
        mistake(gearbox)
    assert line in str(caught.value) and "\n" not in str(caught.value)


def test_sweeps_of_two_machines_stand_in_the_same_axes(gearbox):
    found = gearbox.sweep(1000, 1200, points=3, directions=["up"])
    figure = found.plot(label="one", beside={"other": found})
    assert [text.get_text() for text in figure.legends[0].texts] == ["one, up", "other, up"]
    curve = found.dataset()["deflection_ac_rms_um"].sel(direction="up", mesh="tail idler/upper")
    for line in figure.axes[0].lines:
        np.testing.assert_array_equal(line.get_ydata(), curve)
    with pytest.raises(FacegearError, match="must be one of meshes"):
        found.plot("gears", beside={"other": found})


def test_tables_of_an_answer_go_to_a_workbook_and_come_back(gearbox, tmp_path):
    from facegear.io.tables import read_workbook

    found = gearbox.modes()
    sheets = read_workbook(found.to_excel(tmp_path / "modes.xlsx"))
    assert set(sheets) == set(found.content)
    read_back = sheets["frequencies"]["frequency_hz"]
    np.testing.assert_allclose(read_back, found.table()["frequency_hz"], rtol=1e-15)


SHEETS = "geometry", "contact", "stiffness", "modes", "response", "statics", "topography", "hunting"


@pytest.mark.parametrize("name", SHEETS)
def test_every_table_of_an_answer_is_a_sheet_of_its_workbook(gearbox, tmp_path, name):
    from facegear.io.tables import read_workbook

    found = gearbox.hunting(positions=4) if name == "hunting" else getattr(gearbox, name)()
    sheets = read_workbook(found.to_excel(tmp_path / "own.xlsx"))
    tables = {key: part for key, part in found.content.items() if hasattr(part, "columns")}
    tables = tables or {name: found.table()}
    assert sheets and set(sheets) == set(tables)
    for key, table in tables.items():
        assert list(sheets[key].columns) == list(table.columns) and len(sheets[key]) == len(table)


def test_every_answer_of_the_door_has_something_to_write_into_a_workbook():
    """A stage that writes no csv needs sheets of its own."""
    for module in pkgutil.iter_modules(facegear.pipeline.results.__path__):
        import_module(f"facegear.pipeline.results.{module.name}")
    for answer in Result.__subclasses__():
        files = STAGES[answer.STAGE].files
        tables = [name for name, file in files.items() if file.path.endswith((".csv", ".parquet"))]
        assert tables or "_sheets" in vars(answer), answer.__name__
        assert all(len(name) <= LONGEST_NAME for name in tables), answer.__name__


def test_stiffness_over_the_pinions_angle_is_the_series_over_one_pitch(gearbox):
    found = gearbox.stiffness()
    curve = found.over_angle(32)
    orders = found.table()
    np.testing.assert_allclose(curve["pinion_angle_deg"], np.arange(32) * 360 / (23 * 32))
    spectrum = np.fft.rfft(curve["k_n_per_m"]) / 32
    np.testing.assert_allclose(spectrum[0].real, orders["cos_n_per_m"][0], rtol=1e-12)
    own = spectrum[1 : len(orders)]
    np.testing.assert_allclose(2 * own.real, orders["cos_n_per_m"][1:], atol=1e-6 * 4e8)
    np.testing.assert_allclose(-2 * own.imag, orders["sin_n_per_m"][1:], atol=1e-6 * 4e8)


def test_the_running_machine_is_followed_on_geometric_meshes_alone():
    printed = facegear.load("config/quick.yaml", results=None)
    with pytest.raises(facegear.ConfigError, match=r"mesh_kinematics = .*geometric") as refused:
        printed.following()
    assert "\n" not in str(refused.value)
