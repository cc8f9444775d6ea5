"""Two folders of results: nothing between equal runs, every planted change found, and its cause named."""

import json
import shutil
from pathlib import Path

import pandas as pd
import pytest

import facegear
from facegear.__main__ import main
from facegear.errors import CorruptFile, FacegearError
from facegear.io.atomic import sha256
from facegear.number_format import count_noun
from facegear.report.compare import answers
from facegear.report.compare.judge import Verdict, answer_tables, compare, tables_not_stored
from facegear.report.compare.page import causes

CONFIG = Path(__file__).parents[4] / "config" / "harmonics_only.yaml"


def answered(folder, **values):
    """Modes and the response of a machine with given harmonics, saved; no contact analysis."""
    changes = {"transmission.mesh_kinematics": "geometric", "transmission.face_gear.mesh_radius_mm": None}
    changes |= {key.replace("__", "."): value for key, value in values.items()}
    gearbox = facegear.load(CONFIG).with_values(changes)
    for result in (gearbox.modes(), gearbox.response(), gearbox.stiffness()):
        result.save(folder)
    return folder


def with_manifest(folder, path, rule, needs, code="1", versions=None, inputs=()):
    """A table of one number and the manifest of a stage that could have written it."""
    (folder / path).parent.mkdir(parents=True, exist_ok=True)
    (folder / path).write_text("mesh,force_n\nright input/upper,1000.0\n")
    record = {
        "rule": rule,
        "params": {"needs": needs},
        "code": code,
        "versions": versions or {"numpy": "2.4"},
        "inputs": dict.fromkeys(inputs, ""),
        "files": {Path(path).name: {"bytes": (folder / path).stat().st_size, "sha256": ""}},
        "rebuild": "snakemake",
    }
    (folder / path).with_name(f"{rule}.provenance.json").write_text(json.dumps(record))


@pytest.fixture(scope="module")
def nominal(tmp_path_factory):
    return answered(tmp_path_factory.mktemp("nominal"))


def test_two_equal_runs_show_no_difference(nominal, tmp_path, capsys):
    again = answered(tmp_path)
    found = compare(nominal, again)
    assert found.equal and found.rows.empty
    assert found.counts[Verdict.UNCHANGED] > 500
    assert main(["compare", str(nominal), str(again)]) == 0
    assert capsys.readouterr().out == "Both folders say the same.\n"


def test_a_mesh_a_thousandth_stiffer_is_found(nominal, tmp_path):
    mesh = next(iter(facegear.load(CONFIG).response().content["response"]["mesh"]))
    stiffer = answered(tmp_path, transmission__single_meshes={mesh: {"stiffness_factor": 1.001}})
    found = compare(nominal, stiffer)
    assert not found.equal
    moved = found.rows[found.rows["verdict"] == Verdict.BEYOND_ERROR]
    assert {"dynamics/bearings.csv"} <= set(moved["file"])
    assert "stiffness/harmonics.csv" not in set(found.rows["file"])


@pytest.mark.parametrize(
    ("factor", "verdict"), [(1 + 1e-12, None), (1.002, Verdict.WITHIN_ERROR), (1.01, Verdict.BEYOND_ERROR)]
)
def test_a_number_is_judged_by_its_own_numerical_error(factor, verdict, nominal, tmp_path):
    shutil.copytree(nominal, tmp_path, dirs_exist_ok=True)
    table = pd.read_csv(tmp_path / "stiffness/harmonics.csv")
    table.loc[0, "cos_n_per_m"] *= factor
    table.to_csv(tmp_path / "stiffness/harmonics.csv", index=False)
    assert compare(nominal, tmp_path).rows["verdict"].to_list() == [verdict] * (verdict is not None)


@pytest.mark.parametrize(
    ("old_class", "new_class", "verdict"),
    [
        ("chaotic", "quasi-periodic", Verdict.LABEL),
        ("chaotic", "period-3", Verdict.LABEL),
        ("not settled", "period-3", Verdict.LABEL),
        ("not settled", "quasi-periodic", Verdict.IRREGULAR),
        ("chaotic", "undecided", Verdict.IRREGULAR),
    ],
)
def test_numbers_of_an_irregular_motion_are_statistics_and_its_class_is_a_label_unless_left_open(
    old_class, new_class, verdict, tmp_path
):
    for side, (value, kind) in {"old": (1.0, old_class), "new": (1.3, new_class)}.items():
        (tmp_path / side / "dynamics").mkdir(parents=True)
        row = f"7500.0,rms_um,gear,{value},{kind}\n"
        (tmp_path / side / "dynamics/summary.csv").write_text(
            f"speed_rpm,quantity,body_or_mesh,value,class\n{row}"
        )
    rows = compare(tmp_path / "old", tmp_path / "new").rows.set_index("quantity")["verdict"]
    assert rows["value"] == Verdict.IRREGULAR
    assert rows["class"] == verdict


def sweep_peaks(folder, kind, value, after_irregular, speeds=(7500.0, 9000.0)):
    """A table of peaks at two speeds, of which the second has the given motion."""
    (folder / "dynamics").mkdir(parents=True)
    rows = [(speeds[0], 2.0, "period-1", False), (speeds[1], value, kind, after_irregular)]
    table = pd.DataFrame(rows, columns=["speed_rpm", "value", "class", "after_irregular"])
    table = table.assign(direction="down", quantity="rms_um", body_or_mesh="gear")
    table.to_csv(folder / "dynamics/resonances.csv", index=False)
    return folder


def test_what_follows_an_irregular_motion_in_both_runs_is_decided_by_rounding(tmp_path):
    old = sweep_peaks(tmp_path / "old", "not settled", 1.0, True)
    other = sweep_peaks(tmp_path / "other", "period-25", 1.3, True)
    moved = sweep_peaks(tmp_path / "moved", "period-1", 1.3, True, (7500.0, 9200.0))
    for new in (other, moved):
        found = compare(old, new)
        assert found.equal and found.counts[Verdict.ROUNDING]


def test_a_motion_that_is_irregular_in_one_run_first_is_a_change(tmp_path):
    old = sweep_peaks(tmp_path / "old", "period-1", 1.0, False)
    other = sweep_peaks(tmp_path / "other", "chaotic", 1.3, True)
    gone = sweep_peaks(tmp_path / "gone", "period-1", 1.0, False, (7500.0, 9200.0))
    assert not compare(old, other).equal
    assert not compare(old, gone).equal


def jumps(folder, *rows, error_rpm=0.8, **columns):
    """A table of jumps upwards: the speed before each, the AC RMS after it (um) and its multiplier."""
    (folder / "dynamics").mkdir(parents=True)
    table = pd.DataFrame(
        rows, columns=["speed_before_rpm", "deflection_ac_rms_after_um", "leading_multiplier_before"]
    )
    table = table.assign(
        direction="up", mesh="right input/upper", speed_after_rpm=table["speed_before_rpm"] + 0.8
    )
    table.assign(error_rpm=error_rpm, **columns).to_csv(folder / "dynamics/jumps.csv", index=False)
    return folder


JUMPS = (5806.5, 15.7, 0.956), (8876.0, 20.0, 0.95)


@pytest.mark.parametrize(
    ("moved", "verdicts"),
    [
        ((8876.0, 20.0, 0.95 + 1.3e-6), {Verdict.WITHIN_ERROR}),
        ((8876.0, 20.0, 0.95 + 2e-2), {Verdict.BEYOND_ERROR}),
        ((8876.0, 20.1, 0.95), {Verdict.BEYOND_ERROR}),
        ((8877.5, 20.1, 0.93), {Verdict.WITHIN_ERROR}),
        ((8877.5, 22.0, 0.93), {Verdict.WITHIN_ERROR, Verdict.BEYOND_ERROR}),
        ((8878.5, 20.0, 0.95), {Verdict.ONLY_IN_OLD, Verdict.ONLY_IN_NEW}),
    ],
)
def test_a_jump_is_compared_within_the_error_of_its_bracket(moved, verdicts, tmp_path):
    old, new = jumps(tmp_path / "old", *JUMPS), jumps(tmp_path / "new", JUMPS[0], moved)
    assert set(compare(old, new).rows["verdict"]) == verdicts


def test_a_jump_that_ends_irregular_motion_is_known_to_a_step_of_the_sweep(tmp_path):
    old = jumps(tmp_path / "old", *JUMPS, error_rpm=200.0)
    new = jumps(tmp_path / "new", JUMPS[0], (8950.0, 20.1, 0.93), error_rpm=200.0)
    assert compare(old, new).equal


def test_jumps_of_two_directions_are_not_taken_for_one_another(tmp_path):
    old, new = jumps(tmp_path / "old", *JUMPS), jumps(tmp_path / "new", *JUMPS, direction="down")
    assert set(compare(old, new).rows["verdict"]) == {Verdict.ONLY_IN_OLD, Verdict.ONLY_IN_NEW}


@pytest.mark.parametrize(("residual", "equal"), [(6e-13, True), (2e-12, False)])
def test_a_residual_of_a_contact_moves_only_where_it_is_no_longer_solved(residual, equal, tmp_path):
    for side, value in (("old", 1e-16), ("new", residual)):
        (tmp_path / side / "contact").mkdir(parents=True)
        row = f"950.0,0,{value}\n"
        (tmp_path / side / "contact/ltca.csv").write_text(f"torque_n_m,position,kkt_residual\n{row}")
    assert compare(tmp_path / "old", tmp_path / "new").equal is equal


@pytest.mark.parametrize(("residual", "equal"), [(6e-8, True), (2e-6, False)])
def test_a_residual_of_a_motion_moves_only_where_it_is_no_longer_periodic(residual, equal, tmp_path):
    """On a processor without AVX the residual of a solved orbit is 5e-11 in place of 4e-11."""
    for side, value in (("old", 4e-11), ("new", residual)):
        (tmp_path / side / "dynamics").mkdir(parents=True)
        row = f"7500.0,residual,machine,{value},period-1\n7500.0,periods_run,machine,48.0,period-1\n"
        (tmp_path / side / "dynamics/summary.csv").write_text(
            f"speed_rpm,quantity,body_or_mesh,value,class\n{row}"
        )
    assert compare(tmp_path / "old", tmp_path / "new").equal is equal


def test_rows_columns_and_tables_of_one_folder_only_are_named(nominal, tmp_path):
    shutil.copytree(nominal, tmp_path, dirs_exist_ok=True)
    (tmp_path / "stiffness/tvms.csv").unlink()
    table = pd.read_csv(tmp_path / "dynamics/bearings.csv")
    table.drop(columns="peak_n").iloc[1:].to_csv(tmp_path / "dynamics/bearings.csv", index=False)
    gone = compare(nominal, tmp_path).rows
    assert set(gone["verdict"]) == {Verdict.ONLY_IN_OLD}
    assert {"whole table", "column peak_n"} < set(gone["row"]) and len(gone) == 3


def test_a_column_of_zeros_and_undefined_numbers_compares_equal_to_itself(tmp_path):
    for side in ("old", "new"):
        (tmp_path / side).mkdir()
        (tmp_path / side / "some.csv").write_text("a,b,c\n0.0,,inf\n0.0,1.0,2.0\n")
    assert compare(tmp_path / "old", tmp_path / "new").rows.empty


def test_a_change_is_traced_to_config_code_and_versions_of_all_stages_before(tmp_path, capsys):
    for side, stiffness, code, numpy in (("old", 4.1e8, "1", "2.3"), ("new", 4.2e8, "2", "2.4")):
        folder = tmp_path / side
        needs = {"single": [{"name": "left", "stiffness": stiffness}], "alike": 1}
        with_manifest(folder, "stiffness/k.csv", "stiffness", needs, code, {"numpy": numpy})
        with_manifest(folder, "statics/force.csv", "statics", {}, inputs=["../stiffness/k.csv"])
    (tmp_path / "new/statics/force.csv").write_text("mesh,force_n\nright input/upper,1100.0\n")
    for manifest in tmp_path.rglob("*.json"):  # a table as its stage wrote it
        record = json.loads(manifest.read_text())
        record["files"] = {
            table.name: {"bytes": table.stat().st_size, "sha256": sha256(table)}
            for table in manifest.parent.glob("*.csv")
        }
        manifest.write_text(json.dumps(record))
    page = tmp_path / "page.html"
    assert main(["compare", str(tmp_path / "old"), str(tmp_path / "new"), "--page", str(page)]) == 1
    message = capsys.readouterr().out
    assert "config single.left.stiffness: 410000000.0 -> 420000000.0  [statics/force.csv]" in message
    assert "code of stage stiffness" in message and "numpy 2.3 -> 2.4" in message and "alike" not in message
    assert "The folders differ in 1 table." in message
    assert "410000000.0" in page.read_text()


def test_what_may_have_moved_a_table_is_listed_in_the_same_order_in_every_run(tmp_path):
    """The order was that of a set of texts, which differs from process to process."""
    stages = [f"stage_{letter}" for letter in "abcdefgh"]
    for side in ("old", "new"):
        for stage, before in zip(stages, [None, *stages], strict=False):
            inputs = [f"../{before}/k.csv"] if before else []
            with_manifest(tmp_path / side, f"{stage}/k.csv", stage, {stage: side}, inputs=inputs)
    lines = causes(f"{stages[-1]}/k.csv", tmp_path / "old", tmp_path / "new")
    assert lines == [f"config {stage}: 'old' -> 'new'" for stage in stages]


def test_a_table_edited_by_hand_is_refused_and_not_compared(tmp_path, capsys):
    with_manifest(tmp_path, "statics/force.csv", "statics", {})
    with pytest.raises(CorruptFile, match="differs from what its stage wrote"):
        compare(tmp_path, tmp_path)


def test_stored_answers_are_small_the_same_bytes_each_time_and_compare_equal_to_their_source(
    nominal, tmp_path, monkeypatch
):
    """Tables too large to be stored counted as added, so that no stored answer was equal to its source."""
    sizes = sorted((nominal / name).stat().st_size for name in answer_tables(nominal))
    monkeypatch.setattr(answers, "MAX_BYTES", sizes[-2])
    for name in ("a.zip", "b.zip"):
        answers.store(nominal, tmp_path / name)
    assert (tmp_path / "a.zip").read_bytes() == (tmp_path / "b.zip").read_bytes()
    assert (tmp_path / "a.zip").stat().st_size < 100_000
    shutil.unpack_archive(tmp_path / "a.zip", tmp_path / "stored")
    assert len(answer_tables(tmp_path / "stored")) == len(sizes) - 1
    for one, other in ((tmp_path / "stored", nominal), (nominal, tmp_path / "stored")):
        assert compare(one, other).rows.empty


def test_how_many_tables_a_stored_answer_holds_is_said(capsys):
    """Nothing is compared with those that are not stored, and a user did not know how many these are."""
    assert main(["compare", "current/example", "current/example"]) == 0
    with answers.open_answer("current/example") as folder:
        held, missing = len(answer_tables(folder)), len(tables_not_stored(folder))
    assert capsys.readouterr().out.splitlines()[1] == (
        f"current/example holds {held} tables. Not stored, and not compared: "
        f"{count_noun(missing, 'larger table')}."
    )


@pytest.mark.parametrize("name", ["no/such", "0.0.0/paper", str(CONFIG)])
def test_what_is_no_folder_of_results_is_refused_in_one_line(name, capsys):
    assert main(["compare", name, name]) == 1
    assert capsys.readouterr().err.count("\n") == 1


def test_a_folder_without_tables_is_refused(tmp_path):
    with pytest.raises(FacegearError, match="must be a folder of results"):
        compare(tmp_path, tmp_path)


MESHES = ("left/upper", "right/upper", "input/upper")


def write_sweep(folder, values, broken=True):
    """A sweep at one speed: the RMS of three meshes, of which symmetry exchanges two."""
    (folder / "dynamics").mkdir(parents=True)
    table = pd.DataFrame({"body_or_mesh": MESHES, "value": values}).assign(
        direction="up", speed_rpm=9600.0, quantity="deflection_ac_rms_um", symmetry_broken=broken
    )
    table.assign(**{"class": "period-1"}).to_csv(folder / "dynamics/sweep.csv", index=False)
    return folder


@pytest.mark.parametrize(
    ("values", "broken", "verdict"),
    [
        ((70.0, 17.0, 27.0), True, Verdict.MIRROR),
        ((70.0, 17.0, 27.0), False, Verdict.BEYOND_ERROR),
        ((70.0, 18.0, 27.0), True, Verdict.BEYOND_ERROR),
    ],
    ids=["image", "symmetric motion", "another motion"],
)
def test_mirror_images_count_as_one_motion_where_symmetry_is_broken(values, broken, verdict, tmp_path):
    old = write_sweep(tmp_path / "old", (17.0, 70.0, 27.0), broken)
    found = compare(old, write_sweep(tmp_path / "new", values, broken))
    assert found.equal == (verdict is Verdict.MIRROR)
    assert found.counts[verdict] == 2


def write_jump(folder, before, after, error=0.8, **columns):
    (folder / "dynamics").mkdir(parents=True)
    row = {"direction": "up", "kind": "jump", "speed_before_rpm": before, "speed_after_rpm": after}
    row |= {"error_rpm": error, "mesh": "a", "deflection_ac_rms_before_um": 69.0} | columns
    pd.DataFrame([row]).to_csv(folder / "dynamics/jumps.csv", index=False)
    return folder


@pytest.mark.parametrize(
    ("bracket", "columns", "equal"),
    [
        ((9505.0, 9505.8), {}, True),
        ((9505.8, 9506.6), {}, True),
        ((9505.8, 9506.6), {"deflection_ac_rms_before_um": 69.5}, True),
        ((9505.0, 9505.8), {"deflection_ac_rms_before_um": 69.5}, False),
        ((9505.8, 9506.6), {"deflection_ac_rms_before_um": 75.0}, False),
        ((9508.2, 9509.0), {}, False),
    ],
)
def test_the_speed_of_a_jump_is_compared_within_its_own_error(bracket, columns, equal, tmp_path):
    old = write_jump(tmp_path / "old", 9505.0, 9505.8)
    found = compare(old, write_jump(tmp_path / "new", *bracket, **columns))
    assert found.equal == equal
    assert not found.counts[Verdict.NO_ERROR]


def test_two_jumps_of_a_table_are_each_compared_with_the_nearest_one(tmp_path):
    folders = [write_jump(tmp_path / name, 9505.0, 9505.8) for name in ("old", "new")]
    for folder, second in zip(folders, (9507.0, 9506.9), strict=True):
        table = pd.read_csv(folder / "dynamics/jumps.csv")
        other = table.assign(speed_before_rpm=second, speed_after_rpm=second + 0.8)
        pd.concat([other, table]).to_csv(folder / "dynamics/jumps.csv", index=False)
    found = compare(*folders)
    assert found.equal
    assert set(found.rows["verdict"]) <= {Verdict.WITHIN_ERROR}
