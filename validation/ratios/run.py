"""Two commits in turns: `python -m validation.ratios.run [POINT ...] [--since COMMIT]`."""

import argparse
import json
import os
import subprocess
import time
from collections.abc import Collection, Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from tempfile import TemporaryDirectory
from types import MappingProxyType

import numpy as np
import pandas as pd

from facegear.report.compare.quantities import RESIDUALS
from validation.ratios.points import POINTS, Point
from validation.ratios.trees import Tree, checked_out, present

BASELINE = "94c3f7f7"
"""Commit that ratios are measured against: the last one before hot loops moved from numba to C++."""
TURNS = 3
"""Timed calls of each tree; the least time counts, as whatever else runs can only add to it."""
EQUAL_CHANGE = 1e-9
"""Change of a number, over the largest of its array, up to which it counts as equal."""
WORKER = Path(__file__).with_name("worker.py")
MOTION = ("motion", "class")
"""Ends of the names of arrays that hold classes of motion."""
DIFFERENCES = {"k_gamma_missed": 1e-12}
"""Relative differences of two like numbers up to which these count as equal."""
COLUMNS = (
    *("point", "unit", "before", "now", "ratio", "wall_before", "wall_now"),
    *("memory_before_mb", "memory_now_mb"),
    *("change", "fraction_equal", "labels_changed", "labels", "error", "load"),
)


class Job:
    """Calls of a point with the code of a tree, in one process or each in its own.

    `variables` are added to the environment of the processes.
    """

    def __init__(
        self,
        tree: Tree,
        job: Path,
        answers: Path,
        inputs: Path,
        whole_process: bool,
        variables: Mapping[str, str] = MappingProxyType({}),
    ) -> None:
        self.command = tree.command(WORKER, str(job), str(answers), str(inputs))
        self.tree, self.whole_process = tree, whole_process
        self.environment = {**tree.variables, **variables}
        self.process: subprocess.Popen[str] | None = None

    def call(self) -> dict[str, float]:
        """Run the job once.

        Returns
        -------
        dict
            `seconds` of processor time, `wall` seconds and `memory_mb` of the call, s and MB.

        Raises
        ------
        RuntimeError
            If the job cannot be run.
        """
        begin = time.perf_counter()
        if self.process is None:
            self.process = subprocess.Popen(
                self.command,
                cwd=self.tree.sources,
                env=self.environment,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                text=True,
            )
        assert self.process.stdin is not None and self.process.stdout is not None
        self.process.stdin.write("whole\n" if self.whole_process else "warm\n")
        self.process.stdin.flush()
        for line in self.process.stdout:
            if line.startswith("{"):
                answer: dict[str, float] = json.loads(line)
                break
        else:
            raise RuntimeError(f"the job ends without an answer: {' '.join(self.command)}")
        if self.whole_process:
            answer["wall"] = time.perf_counter() - begin
            self.close()
        return answer

    def close(self) -> None:
        """End the process."""
        if self.process is not None:
            self.process.communicate()
            self.process = None


def ratio(
    name: str, point: Point, trees: Sequence[Tree], folder: Path, turns: int = TURNS
) -> dict[str, object]:
    """Measure one row of the table: least time of `turns` calls in each tree, alternately, after one untimed
    call.

    Each tree computes what the stage takes from other stages by itself, from the same config, and keeps it in
    a folder of its own for the points after this one.

    Parameters
    ----------
    name : str
        Name of the point.
    point : Point
        The job and its unit of work.
    trees : sequence of Tree
        Earlier and present tree.
    folder : Path
        Folder for jobs, inputs and answers.
    turns : int
        Number of timed calls of each tree.

    Returns
    -------
    dict
        Value of each of COLUMNS.
    """
    job = folder / f"{name}.json"
    job.write_text(json.dumps(point.job), encoding="utf-8")
    sides = list(zip(("before", "now"), trees, strict=True))
    answers = [folder / f"{name}_{side}.npz" for side, _ in sides]
    jobs = [
        Job(tree, job, path, folder / f"inputs_{side}", point.whole_process)
        for path, (side, tree) in zip(answers, sides, strict=True)
    ]
    calls = [[job.call() for job in jobs] for _ in range(turns + 1)][1:]
    for timed_job in jobs:
        timed_job.close()
    memory = [max(turn[side]["memory_mb"] for turn in calls) for side in range(2)]
    before, now, *wall = (
        point.scale / point.amount * min(turn[side][clock] for turn in calls)
        for clock in ("seconds", "wall")
        for side in range(2)
    )
    change = changes(*(read_answers(path) for path in answers))
    times = (before, now, now / before, *wall, *memory, *change)
    values = (name, point.unit, *times, point.error, os.getloadavg()[0])
    return dict(zip(COLUMNS, values, strict=True))


def read_answers(path: Path) -> dict[str, np.ndarray]:
    """Read the answers of a job.

    Parameters
    ----------
    path : Path
        File in NumPy's format npz.

    Returns
    -------
    dict
        Arrays of numbers and texts by their names, of any shape and unit.
    """
    with np.load(path, allow_pickle=False) as arrays:
        return dict(arrays)


def changes(before: dict[str, np.ndarray], now: dict[str, np.ndarray]) -> tuple[float, float, int, int]:
    """Compare the answers of two trees.

    Rows whose `motion` changes its class or its period, or is not periodic, count by their label alone, as
    other motions are statistics. Residuals, and differences of like numbers, count as zero up to rounding. An
    array that is missing now, or has another shape, is an infinite change.

    Parameters
    ----------
    before, now : dict of (...) arrays
        Arrays of numbers and texts by name, in any unit.

    Returns
    -------
    float, float, int, int
        Largest change of a number relative to the largest of its array, fraction of numbers that change by at
        most EQUAL_CHANGE, number of labels that changed, and number of labels.
    """
    texts = {name for name, values in before.items() if values.dtype.kind == "U"}
    labels = sum(before[name].size for name in texts)
    if any(name not in now or values.shape != now[name].shape for name, values in before.items()):
        return float("inf"), 0.0, labels, labels
    labels_changed = sum(int((before[name] != now[name]).sum()) for name in texts)
    gaps = [
        gap for name in before.keys() - texts if (gap := relative_change(before, now, name, texts)).size
    ] or [np.zeros(1)]
    together = np.concatenate(gaps)
    return float(together.max()), float((together <= EQUAL_CHANGE).mean()), labels_changed, labels


def relative_change(
    before: Mapping[str, np.ndarray], now: Mapping[str, np.ndarray], name: str, texts: Collection[str]
) -> np.ndarray:
    """Return the change of each number of an array over its largest one, those of regular motions alone.

    Parameters
    ----------
    before, now : dict
        Arrays of numbers and texts, of any shape and unit.
    name : str
        Name of an array of numbers, which has one shape on both sides.
    texts : collection of str
        Names of the arrays of texts.

    Returns
    -------
    ndarray
        Changes (numbers,), dimensionless; of an array of zeros as they are.
    """
    old, new = (_comparable_numbers(name, side[name]) for side in (before, now))
    for label in texts:
        if label.endswith(MOTION) and name.startswith(label.removesuffix("motion").removesuffix("class")):
            regular = is_regular(before, now, label)
            if len(regular) == len(old):
                old, new = old[regular], new[regular]
    scale = np.abs(old[np.isfinite(old)]).max(initial=0.0)
    equal = (old == new) | np.isnan(old) & np.isnan(new)
    gap = np.where(equal, 0.0, np.nan_to_num(np.abs(new - old), nan=np.inf)).ravel()
    return gap / scale if scale > 0.0 else gap


def is_regular(before: Mapping[str, np.ndarray], now: Mapping[str, np.ndarray], label: str) -> np.ndarray:
    """Return which rows are periodic with the same period on both sides.

    Parameters
    ----------
    before, now : mapping
        Arrays of numbers and texts, of any shape and unit.
    label : str
        Name of the array of the classes of motion.

    Returns
    -------
    ndarray
        Whether each row is, (rows,).
    """
    kind, period = before[label], label.removesuffix("motion") + "period"
    rows = np.char.startswith(kind, "period") & (kind == now[label])
    return rows & (before[period] == now[period]) if period in before else rows


def _comparable_numbers(name: str, values: np.ndarray) -> np.ndarray:
    """Return the numbers of an array with differences up to rounding set to zero."""
    numbers = np.atleast_1d(values).astype(complex)
    zero = (RESIDUALS | DIFFERENCES).get(name.rsplit("/", 1)[-1], 0.0)
    return np.where(np.abs(numbers) <= zero, 0.0, numbers)


def main(arguments: Sequence[str] | None = None) -> None:
    """Print the table, and write it where a file is given.

    Parameters
    ----------
    arguments : sequence of str or None
        Arguments of the command line; those of the process if None.
    """
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("points", nargs="*", default=list(POINTS), help=", ".join(POINTS))
    parser.add_argument("--since", default=BASELINE, metavar="COMMIT", help=f"by default {BASELINE}")
    parser.add_argument("--turns", type=int, default=TURNS)
    parser.add_argument("--table", type=Path, help="csv to be written")
    options = parser.parse_args(arguments)
    invalid = [name for name in options.points if name not in POINTS]
    if invalid:
        parser.error(f"unknown points {', '.join(invalid)}; allowed: {', '.join(POINTS)}")
    rows = []
    with ExitStack() as stack:
        before = stack.enter_context(checked_out(options.since))
        folder = Path(stack.enter_context(TemporaryDirectory()))
        for name in options.points:
            rows.append(ratio(name, POINTS[name], (before, present()), folder, options.turns))
            print(pd.DataFrame(rows[-1:]).to_string(index=False, header=len(rows) == 1), flush=True)
            if options.table:
                pd.DataFrame(rows).to_csv(options.table, index=False)


if __name__ == "__main__":
    main()
