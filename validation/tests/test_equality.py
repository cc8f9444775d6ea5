"""Rules for what counts as the same answer of two commits."""

from dataclasses import replace

import numpy as np
import pytest

import facegear
from validation.ratios.equality import CASES, LIMITS, NOT_SETTLED, STEP_TOLERANCE, Case, answer, compare, main
from validation.ratios.run import read_answers
from validation.ratios.trees import present


def rows(tmp_path, old, new, other=None):
    """Rows of the comparison of stored answers, by answer; `other`: the old code that rounds otherwise."""
    for side, arrays in (("before", old), ("now", new), ("before/spread", other or old)):
        (tmp_path / side).mkdir(exist_ok=True)
        np.savez(tmp_path / side / "case.npz", **arrays)
    table = compare(tmp_path / "before", tmp_path / "now", {"case": CASES["one_stiffness"]})
    return {row.answer: row for row in table.itertuples()}


def test_contact_holds_up_to_rounding_and_orbits_more_widely(tmp_path):
    old = {"contact/ltca/k": np.array([1.0, 2.0]), "response/multipliers/real": np.array([0.5, 1.0])}
    new = {name: values * (1.0 + 1e-11) for name, values in old.items()}
    found = rows(tmp_path, old, new)
    assert not found["contact"].holds and found["contact"].above == 2
    assert found["response"].holds and found["response"].largest_change == pytest.approx(1e-11, rel=1e-3)


def test_a_number_that_rounding_moves_in_the_old_code_may_move_as_far(tmp_path):
    old = {"contact/ltca/k": np.array([1.0, 2.0]), "contact/ltca/ste": np.array([1.0, 2.0])}
    new = {name: values * (1.0 + 1e-11) for name, values in old.items()}
    other = {**old, "contact/ltca/k": old["contact/ltca/k"] * (1.0 + 2e-11)}
    row = rows(tmp_path, old, new, other)["contact"]
    assert row.above == 2 and not row.holds  # those of `ste` alone
    assert row.spread == pytest.approx(2e-11, rel=1e-3)


def test_reduced_coordinates_and_residuals_are_not_compared(tmp_path):
    names = np.array(["residual", "deflection_um"])
    old = {"response/summary/quantity": names, "response/summary/value": np.array([1e-9, 1.0])}
    new = {**old, "response/summary/value": np.array([1e-15, 1.0])}
    assert rows(tmp_path, old, new)["response"].holds
    old = {**sweep(["periodic"], [1.0]), "chunk/own_displacement": np.array([[1.0, 2.0]])}
    new = {**old, "chunk/own_displacement": np.array([[2.0, 1.0]])}
    assert rows(tmp_path, old, new)["sweep"].holds


def test_numbers_of_a_table_are_compared_with_their_own_quantity(tmp_path):
    names = np.array(["force_n", "force_n", "deflection_um", "deflection_um"])
    old = {
        "response/summary/quantity": names,
        "response/summary/value": np.array([1e4, 1e4, 1e-3, 2e-3]),
    }
    new = {**old, "response/summary/value": old["response/summary/value"] + np.array([0.0, 0.0, 0.0, 1e-9])}
    row = rows(tmp_path, old, new)["response"]
    assert row.largest_change == pytest.approx(5e-7) and row.above == 1


def test_a_lost_table_or_a_changed_label_does_not_hold(tmp_path):
    old = {"statics/meshes/force_n": np.ones(3), "statics/meshes/flank": np.array(["drive", "back", "drive"])}
    lost = {"statics/meshes/flank": old["statics/meshes/flank"]}
    other = {**old, "statics/meshes/flank": np.array(["drive", "back", "back"])}
    assert not rows(tmp_path, old, lost)["statics"].holds
    assert rows(tmp_path, old, other)["statics"].labels_changed == 1
    assert not rows(tmp_path, old, other)["statics"].holds


def sweep(motions, rms):
    return {
        "chunk/own_motion": np.array(motions),
        "chunk/own_period": np.ones(len(motions)),
        "chunk/own_deflection_ac_rms": np.array(rms),
    }


def test_regular_speeds_must_hold_until_an_irregular_one_comes_before_them(tmp_path):
    motions = ["periodic", "periodic", "chaotic", "periodic"]
    old = sweep(motions, [1.0, 1.0, 1.0, 1.0])
    after = rows(tmp_path, old, sweep(motions, [1.0, 1.0, 9.0, 2.0]))["sweep"]
    assert after.holds and after.above == 1 and after.numbers == 3
    assert not rows(tmp_path, old, sweep(motions, [1.0, 2.0, 1.0, 1.0]))["sweep"].holds


def test_amplitudes_of_modes_are_compared_by_their_squares(tmp_path):
    old = {**sweep(["periodic"], [1.0]), "chunk/own_modal": np.array([[1.0, 0.0]])}
    rounded = {**old, "chunk/own_modal": np.array([[1.0, 1e-8]])}
    moved = {**old, "chunk/own_modal": np.array([[1.0, 1e-3]])}
    assert rows(tmp_path, old, rounded)["sweep"].holds
    assert not rows(tmp_path, old, moved)["sweep"].holds


def test_a_regular_speed_that_becomes_irregular_does_not_hold(tmp_path):
    old, new = sweep(["periodic"] * 2, [1.0, 1.0]), sweep(["periodic", "chaotic"], [1.0, 1.0])
    assert not rows(tmp_path, old, new)["sweep"].holds


def classes(label, second_look):
    return {"oscillators/label": np.array(label), "oscillators/second_look": np.array(second_look)}


def test_classes_may_differ_only_where_both_leave_them_undecided(tmp_path):
    old = classes(["period-1", "chaotic"], ["period-1", NOT_SETTLED])
    open_in_both = classes(["period-1", "period-3"], ["period-1", NOT_SETTLED])
    open_in_one = classes(["period-1", "period-3"], ["period-1", "period-3"])
    assert rows(tmp_path, old, open_in_both)["oscillators"].holds
    assert not rows(tmp_path, old, open_in_one)["oscillators"].holds
    many = classes(["chaotic"] * 6, [NOT_SETTLED] * 6), classes(["period-3"] * 6, [NOT_SETTLED] * 6)
    assert not rows(tmp_path, *many)["oscillators"].holds


def test_a_process_gives_statics_a_mesh_period_and_classes(tmp_path):
    calls = ("statics", "mesh_period", "oscillators")
    answer(present(), tmp_path, {"case": replace(CASES["geometric_kinematics"], calls=calls, oscillators=2)})
    found = read_answers(tmp_path / "case.npz")
    assert found["oscillators/label"].shape == found["oscillators/second_look"].shape == (2,)
    assert found["mesh_period/1/state"].shape == (2, 4 * found["statics/bodies/body"].size)
    assert found["mesh_period/1/fractions"].sum(axis=0) == pytest.approx(1.0)
    assert np.abs(found["mesh_period/1/state"] - found["mesh_period/0/state"]).max() > 1e-6
    assert {name.partition("/")[0] for name in found} == set(calls)


def test_stored_answers_are_not_computed_again(tmp_path):
    (tmp_path / "case.npz").touch()
    answer(present(), tmp_path, {"case": Case("no such config", ("statics",))})
    assert (tmp_path / "case.npz").stat().st_size == 0


def test_every_case_is_a_machine_with_limits_for_what_is_asked():
    for case in CASES.values():
        changes = case.job(present())["changes"]
        values = facegear.load(case.config, results=None).with_values(changes).values
        assert set(case.calls) <= {*LIMITS, "oscillators"}
        if case.is_motion:
            dynamics = values["dynamics"]
            found = [part["accuracy"]["tolerance"] for part in (dynamics, dynamics["sweep"])]
            assert found == [STEP_TOLERANCE, STEP_TOLERANCE]


def test_unknown_cases_are_refused_before_any_work(capsys):
    with pytest.raises(SystemExit):
        main(["statics", "--since", "no such commit"])
    assert "unknown cases statics; allowed: contact_example" in capsys.readouterr().err
