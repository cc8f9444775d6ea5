"""The numbers on the page about the dynamics, and in README, are those of the stored measurements."""

from pathlib import Path

import pandas as pd
import pytest

from validation.dynamics.work_precision import seconds_at

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "explanation" / "dynamics.md").read_text()
README = (ROOT / "README.md").read_text()
SWEEP = pd.read_csv(ROOT / "docs" / "measured" / "dynamics_convergence.csv")
SLOW_RPM = 1100.0
TIMES = pd.read_csv(ROOT / "docs" / "measured" / "dynamics.csv")
PROBLEMS = ("contact kept", "contact lost", "oracle (a)")
LAWS = (
    *("damper in contact only", "load-dependent law", "power law", "flanks that only push", "friction"),
    "bearing clearance",
)
ERRORS = (1e-3, 1e-6, 1e-9)


def number(value):
    """Two digits, as written: 4.6e-4."""
    digits, power = f"{value:.1e}".split("e")
    return f"{digits}e{int(power)}"


def periodic():
    return SWEEP[SWEEP["class"].str.startswith("period-")]


def verdict_rows():
    counts = SWEEP["verdict"].value_counts()
    sound = SWEEP[SWEEP["verdict"] == "converged"]
    change, slow = sound["rms_change"], sound.loc[sound["speed_rpm"] < SLOW_RPM, "rms_change"]
    return [
        f"| `converged` | {len(sound)} | same period, RMS to {number(change.max())}, in the median to "
        f"{number(change.median())}; the {len(slow)} below 1100 rpm to {number(slow.max())} |",
        f"| `moved`, `wrong` | {counts.get('moved', 0) + counts.get('wrong', 0)} |",
        *(
            f"| `{name}` | {counts.get(name, 0)} |"
            for name in ("irregular", "not settled", "transient", "sensitive")
        ),
    ]


@pytest.mark.parametrize("row", verdict_rows())
def test_the_table_of_a_sweeps_convergence_is_the_stored_one(row):
    assert row in PAGE


def test_every_periodic_row_of_the_stored_sweep_is_confirmed():
    assert (periodic()["verdict"] == "converged").all()


def test_the_error_beside_the_sweep_in_readme_is_the_stored_one():
    worst = number(periodic()["rms_change"].max())
    assert f"RMS of all {len(periodic())} periodic rows to {worst} against 1e-10 and 4096 samples" in README


def test_how_near_the_leading_multipliers_are_is_as_stored():
    off = (periodic()["multiplier"] - periodic()["multiplier_finer"]).abs().dropna()
    median, most = number(off.median()), number(off.quantile(0.95))
    assert f"in the median by {median}, {most} for 95 %, at most {off.max():.2f}" in PAGE


def milliseconds(seconds):
    if pd.isna(seconds):
        return "-"
    value = 1e3 * seconds
    return (
        f"{value:.3g}"
        if 10.0 <= value < 100.0
        else f"{value:.{3 if value < 0.1 else 2 if value < 10 else 0}f}"
    )


def integrator_rows():
    """Time of every method at three errors: trajectories, then all tangents."""
    rows = []
    for kind in ("", ", tangents"):
        found = TIMES[TIMES["problem"] == PROBLEMS[0] + kind]
        for method in found["method"].unique():
            cells = (
                " / ".join(milliseconds(seconds_at(TIMES, name + kind, method, error)) for error in ERRORS)
                for name in PROBLEMS
            )
            rows.append(f"| {method} | {' | '.join(cells)} |")
    return rows


def law_rows():
    """Time of both layouts of each Taylor method, and of DOP853, on every law at three errors."""
    methods = TIMES.loc[TIMES["problem"] == LAWS[0], "method"].unique()
    return [
        f"| {law} | "
        + " | ".join(
            " / ".join(milliseconds(seconds_at(TIMES, law, method, error)) for error in ERRORS)
            for method in methods
        )
        + " |"
        for law in LAWS
    ]


@pytest.mark.parametrize("row", [*integrator_rows(), *law_rows()])
def test_the_tables_of_integrators_are_the_stored_measurement(row):
    assert row in PAGE
