"""Starter machines are the same in every run, and the cheapest of them comes to its report."""

from validation.starters import COUNT, draw_machines, run_all

LIGHTEST = 18
"""Number of a single pair of module 1: 27 s of the processor, the least of those tried."""


def test_the_same_machines_are_drawn_each_time_and_split_torque_is_among_them():
    machines = list(draw_machines())
    assert machines == list(draw_machines()) and len(machines) == COUNT
    assert any(known.idlers for known in machines) and any(not known.idlers for known in machines)


def test_a_starter_machine_comes_to_its_report_with_nothing_missing():
    table = run_all([list(draw_machines())[LIGHTEST - 1]])
    row = table.iloc[0]
    assert (row["outcome"], row["reason"]) == ("report", "")
    assert row["stages"] >= 10
