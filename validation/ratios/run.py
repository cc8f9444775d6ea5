"""Two commits in turns: `python -m validation.ratios.run COMMIT [POINT ...]`."""

import argparse
import json
import os
import pickle
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pandas as pd

from facegear.compare.quantities import RESIDUALS
from facegear.results.chain import Chain
from facegear.results.store import Store
from validation.growth.measure import ONE_THREAD
from validation.ratios.points import POINTS, Point

TURNS = 3
SAME = 1e-9
"""Change of a number, over the largest of its array, up to which it is the same."""
WORKER = Path(__file__).with_name("worker.py")
DIFFERENCES = {"k_gamma_missed": 1e-12}
"""Relative differences of two like numbers up to which these count as equal."""
COLUMNS = (
    *("point", "unit", "before", "now", "ratio", "memory_before_mb", "memory_now_mb"),
    *("change", "fraction_equal", "labels_changed", "labels", "error", "load"),
)


@contextmanager
def checked_out(commit: str) -> Iterator[Path]:
    """The files of a commit of this repository in a folder of their own."""
    with TemporaryDirectory() as folder:
        tree = Path(folder) / "before"
        subprocess.run(["git", "worktree", "add", "--quiet", "--detach", str(tree), commit], check=True)
        try:
            yield tree
        finally:
            subprocess.run(["git", "worktree", "remove", "--force", str(tree)], check=True)


class Job:
    """Calls of a point with the code of a tree, in one process or each in its own."""

    def __init__(self, tree: Path, given: Path, answers: Path, whole_process: bool) -> None:
        self.command = [sys.executable, str(WORKER), str(given), str(answers)]
        self.environment = {**os.environ, **ONE_THREAD, "PYTHONPATH": str(tree)}
        self.tree, self.whole_process = tree, whole_process
        self.process: subprocess.Popen[str] | None = None

    def call(self) -> dict[str, float]:
        """Seconds of a processor and memory in MB. Raises RuntimeError if the job cannot be run."""
        if self.process is None:
            self.process = subprocess.Popen(
                self.command,
                cwd=self.tree,
                env=self.environment,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                text=True,
            )
        assert self.process.stdin is not None and self.process.stdout is not None
        self.process.stdin.write("whole\n" if self.whole_process else "warm\n")
        self.process.stdin.flush()
        answer = ""
        for answer in self.process.stdout:
            if answer.startswith("{"):
                break
        else:
            raise RuntimeError(f"the job ends without an answer: {' '.join(self.command)}")
        if self.whole_process:
            self.close()
        return json.loads(answer)

    def close(self) -> None:
        """End the process."""
        if self.process is not None:
            self.process.communicate()
            self.process = None


def ratio(
    name: str, point: Point, trees: Sequence[Path], folder: Path, turns: int = TURNS
) -> dict[str, object]:
    """One row, COLUMNS: least processor time of `turns` calls in each tree, in turns, after one untimed."""
    given = folder / f"{name}.pickle"
    given.write_bytes(pickle.dumps((point.stage, dict(point.wildcards), arguments(point))))
    answers = [folder / f"{name}_{side}.pickle" for side in ("before", "now")]
    jobs = [Job(tree, given, path, point.whole_process) for tree, path in zip(trees, answers, strict=True)]
    calls = [[job.call() for job in jobs] for _ in range(turns + 1)][1:]
    for job in jobs:
        job.close()
    seconds = [min(turn[side]["seconds"] for turn in calls) for side in range(2)]
    memory = [max(turn[side]["memory_mb"] for turn in calls) for side in range(2)]
    before, now = (point.scale * each / point.amount for each in seconds)
    change = changes(*(pickle.loads(path.read_bytes()) for path in answers))
    values = (name, point.unit, before, now, now / before, *memory, *change, point.error, os.getloadavg()[0])
    return dict(zip(COLUMNS, values, strict=True))


def arguments(point: Point) -> dict[str, object]:
    """All that the point's stage takes, computed with the code of today."""
    import facegear

    gearbox = facegear.load(point.config, results=None).with_values(point.changes)
    return Chain(gearbox.values, Store()).arguments(point.stage)


def changes(before: dict[str, np.ndarray], now: dict[str, np.ndarray]) -> tuple[float, float, int, int]:
    """Largest change of a number over the largest of its array, the fraction of numbers that change by at
    most SAME, labels that changed, and how many labels there are.

    Rows whose `motion` changes its class or its period, or is not periodic, count by their label alone, as
    other motions are statistics. Residuals, and differences of like numbers, count as zero up to rounding.
    """
    texts = {name: values for name, values in before.items() if values.dtype.kind in "UO"}
    changed = sum(int((values != now[name]).sum()) for name, values in texts.items())
    labels = sum(values.size for values in texts.values())
    regular = {
        name.removesuffix("motion"): _regular(before, now, name) for name in texts if name.endswith("motion")
    }
    worst, same, total = 0.0, 0, 0
    for name in before.keys() - texts.keys():
        old, new = (_counted(name, side[name]) for side in (before, now))
        if old.shape != new.shape:
            return float("inf"), 0.0, changed, labels
        for prefix, rows in regular.items():
            if name.startswith(prefix) and len(rows) == len(old):
                old, new = old[rows], new[rows]
        scale = np.abs(old[np.isfinite(old)]).max(initial=0.0)
        gap = np.where((old == new) | np.isnan(old) & np.isnan(new), 0.0, np.abs(new - old))
        gap = gap / scale if scale > 0.0 else gap
        worst, same, total = (
            max(worst, gap.max(initial=0.0)),
            same + int((gap <= SAME).sum()),
            total + gap.size,
        )
    return float(worst), same / max(total, 1), changed, labels


def _regular(before: dict[str, np.ndarray], now: dict[str, np.ndarray], name: str) -> np.ndarray:
    """Rows that are periodic with the same period on both sides."""
    kind, period = before[name].astype(str), name.removesuffix("motion") + "period"
    rows = np.char.startswith(kind, "period") & (kind == now[name].astype(str))
    return rows & (before[period] == now[period]) if period in before else rows


def _counted(name: str, values: np.ndarray) -> np.ndarray:
    """Numbers of an array as they are compared."""
    numbers = np.atleast_1d(values).astype(complex)
    zero = (RESIDUALS | DIFFERENCES).get(name.rsplit("/", 1)[-1], 0.0)
    return np.where(np.abs(numbers) <= zero, 0.0, numbers)


def main(arguments: Sequence[str] | None = None) -> None:
    """Print the table, and write it where it is asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("commit")
    parser.add_argument("points", nargs="*", default=list(POINTS), help=", ".join(POINTS))
    parser.add_argument("--turns", type=int, default=TURNS)
    parser.add_argument("--table", type=Path, help="csv to be written")
    asked = parser.parse_args(arguments)
    rows = []
    with ExitStack() as stack:
        before = stack.enter_context(checked_out(asked.commit))
        folder = Path(stack.enter_context(TemporaryDirectory()))
        for name in asked.points:
            rows.append(ratio(name, POINTS[name], (before, Path.cwd()), folder, asked.turns))
            print(pd.DataFrame(rows[-1:]).to_string(index=False, header=len(rows) == 1), flush=True)
            if asked.table:
                pd.DataFrame(rows).to_csv(asked.table, index=False)


if __name__ == "__main__":
    main()
