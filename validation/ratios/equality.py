"""Answers of two commits: `python -m validation.ratios.equality [CASE ...] [--before FOLDER]`.

Contact, statics and one mesh period from given starts are compared up to rounding. Orbits, multipliers and
the regular speeds of sweeps are compared more widely, since many periods magnify rounding; irregular motions
by their labels. Each commit runs in the environment of its own lock file, as for the ratios of time.
"""

import argparse
import json
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pandas as pd

from validation.ratios.points import EXAMPLE, ROOT
from validation.ratios.run import BASELINE, Job, is_regular, read_answers, relative_change
from validation.ratios.trees import Tree, checked_out, present

TABLE = ROOT / "docs" / "measured" / "equality.csv"
ROUNDING, MAGNIFIED = 1e-12, 1e-9
"""Largest relative change of numbers that are solved directly, and of those that many periods lie before."""
LIMITS = {
    "contact": ROUNDING,
    "stiffness": ROUNDING,
    "statics": ROUNDING,
    "mesh_period": ROUNDING,
    "response": MAGNIFIED,
    "load_sharing": MAGNIFIED,
    "sweep": MAGNIFIED,
}
"""Largest relative change of the numbers of each answer, over the largest of the same quantity."""
OSCILLATORS, MAY_DIFFER = 500, 5
"""Random oscillators, and of how many the class may differ if second looks leave each undecided in both."""
NOT_SETTLED = "not settled"
"""Class of a motion that second looks do not confirm."""
ASIDE = 1e-11
"""Relative change of the mean mesh stiffness that shows how far an irregular sweep moves by itself."""
COLUMNS = (
    "case",
    "answer",
    "numbers",
    "largest_change",
    "limit",
    "above",
    "labels",
    "labels_changed",
    "holds",
)
MOTION = ("statics", "mesh_period", "response")
Answers = Mapping[str, np.ndarray]


@dataclass(frozen=True)
class Case:
    """A machine, and what is asked of it.

    Attributes
    ----------
    config, changes
        The machine, and what is changed in it by dotted keys.
    calls
        Answers by the names of `worker`.
    direction
        Of a sweep, in place of calls.
    oscillators
        Number of random oscillators that are classified.
    """

    config: str
    calls: tuple[str, ...] = ()
    changes: Mapping[str, Any] = field(default_factory=dict)
    direction: str = ""
    oscillators: int = OSCILLATORS

    def job(self, tree: Tree) -> dict[str, Any]:
        """Return the request to a process.

        Parameters
        ----------
        tree : Tree
            The code that the process runs.

        Returns
        -------
        dict
            Plain values, as the module `worker` says.
        """
        return {
            "config": str(ROOT / self.config),
            "changes": dict(self.changes),
            "stage": "dynamics_sweep_chunk" if self.direction else "",
            "wildcards": {"direction": self.direction, "number": "0"},
            "calls": list(self.calls),
            "count": self.oscillators,
            "sources": str(tree.sources),
        }


def _example(**changes: Any) -> Case:
    return Case("facegear/example.yaml", MOTION, changes)


def _given_stiffness(*calls: str, **changes: Any) -> Case:
    return Case("config/branches.yaml", (*MOTION, *calls), changes)


def _sweep(config: str, direction: str, **changes: Any) -> Case:
    return Case(config, changes=changes, direction=direction)


def _irregular(direction: str, factor: float = 1.0) -> Case:
    return _sweep(EXAMPLE, direction, **{"mesh_stiffness.mean_n_per_m": 4.1e8 * factor})


OIL = {
    "oil": "polyol_ester_5_cst",
    "supply_temperature_c": 100,
    "pinion": {"ra_um": 0.3},
    "face_gear": {"ra_um": 0.3},
    "bulk": {"source": "cooling", "pinion_w_per_k": 60, "face_gear_w_per_k": 200},
}
CLEARANCE, FLANKS, LAW = (
    "transmission.pinion.clearance_um",
    "transmission.damping.open_flanks",
    "mesh_stiffness.mesh_law",
)
CASES: Mapping[str, Case] = {
    "contact_example": Case("facegear/example.yaml", ("contact", "stiffness")),
    "contact_measured_flanks": Case("config/measured_flanks.yaml", ("contact", "stiffness")),
    "contact_paper": Case("config/paper.yaml", ("contact", "stiffness")),
    "law_of_load": Case("facegear/example.yaml", (*MOTION, "load_sharing")),
    "one_stiffness": _example(**{LAW: "constant_load"}),
    "printed_kinematics": Case("config/harmonics_only.yaml", (*MOTION, "load_sharing")),
    "geometric_kinematics": _given_stiffness("load_sharing"),
    "damper_in_contact": _given_stiffness(**{FLANKS: "contact_only"}),
    "push_only": _given_stiffness(**{FLANKS: "push_only"}),
    "clearance": _given_stiffness(**{CLEARANCE: 20}),
    "clearance_and_law": _example(**{CLEARANCE: 20}),
    "friction": _example(lubrication=OIL, **{LAW: "constant_load"}),
    "friction_law_clearance_push": _example(lubrication=OIL, **{CLEARANCE: 20, FLANKS: "push_only"}),
    "shafts": Case("config/shafts.yaml", MOTION),
    "elastic_gears": Case("config/webs.yaml", MOTION),
    "pose": _example(**{"transmission.operating_pose": "static"}),
    "sweep_example_up": _sweep("facegear/example.yaml", "up"),
    "sweep_example_down": _sweep("facegear/example.yaml", "down"),
    "sweep_given_stiffness_up": _sweep("config/branches.yaml", "up"),
    "sweep_irregular_up": _irregular("up"),
    "sweep_irregular_down": _irregular("down"),
    "oscillators": Case("facegear/example.yaml", ("oscillators",)),
}
"""Teeth, one machine for each law and element, sweeps, and the classes of random oscillators."""
SPREAD: Mapping[str, Case] = {
    "sweep_irregular_up": _irregular("up", 1.0 + ASIDE),
    "sweep_irregular_down": _irregular("down", 1.0 + ASIDE),
}
"""Sweeps that only the earlier commit computes, to be set beside its own."""


def answer(tree: Tree, folder: Path, cases: Mapping[str, Case], ending: str = "") -> None:
    """Compute cases with a tree, each in a process of its own, unless the folder has them already.

    Parameters
    ----------
    tree : Tree
        The code.
    folder : Path
        One npz file a case is written here.
    cases : mapping
        Cases by name.
    ending : str
        End of the files' names.
    """
    folder.mkdir(parents=True, exist_ok=True)
    with TemporaryDirectory() as scratch:
        for name, case in cases.items():
            path, job = folder / f"{name}{ending}.npz", Path(scratch) / "job.json"
            if path.exists():
                continue
            job.write_text(json.dumps(case.job(tree)), encoding="utf-8")
            answers = Path(scratch) / "answers.npz"
            process = Job(tree, job, answers, Path(scratch) / "inputs", whole_process=False)
            seconds = process.call()["seconds"]
            process.close()
            answers.replace(path)
            print(f"{name}{ending}: {seconds:.1f} CPU s", file=sys.stderr, flush=True)


def compare(before: Path, now: Path, cases: Mapping[str, Case] = CASES) -> pd.DataFrame:
    """Compare the stored answers of two trees.

    Parameters
    ----------
    before, now : Path
        Folders of npz files.
    cases : mapping
        Those that are compared, if the folder `now` has them.

    Returns
    -------
    DataFrame
        COLUMNS, a row for each answer of each case. `above` counts numbers that change by more than the
        limit. The row of a sweep whose answer is `spread` compares the earlier commit with itself, the mesh
        stiffness larger by ASIDE.
    """
    rows = []
    for name in cases:
        old, new = (read_answers(folder / f"{name}.npz") for folder in (before, now))
        rows += list(_rows(name, old, new))
        if name in SPREAD:
            rows += list(_rows(name, old, read_answers(before / f"{name}_spread.npz"), "spread"))
    return pd.DataFrame(rows, columns=list(COLUMNS))


def _rows(name: str, old: Answers, new: Answers, title: str = "") -> Iterator[tuple[object, ...]]:
    """Rows of a case, one an answer."""
    if "own_motion" in old:
        yield name, title or "sweep", *_sweep_row(old, new)
        return
    for call in dict.fromkeys(key.partition("/")[0] for key in old):
        before, now = ({key: side[key] for key in side if key.startswith(f"{call}/")} for side in (old, new))
        labels = call == "oscillators"
        yield name, call, *(_labels_row(before, now) if labels else _numbers_row(before, now, call))


def _numbers_row(old: Answers, new: Answers, call: str) -> tuple[object, ...]:
    """Columns from `numbers` on: those of regular motions and of what does not move."""
    limit, labels = LIMITS[call], _changed_labels(old, new)
    gaps = np.concatenate([gap for part in _by_quantity(old, new) for gap in _gaps(*part)] or [np.zeros(0)])
    above = int((gaps > limit).sum())
    return gaps.size, gaps.max(initial=0.0), limit, above, *labels, above == 0 and labels[1] == 0


def _sweep_row(old: Answers, new: Answers) -> tuple[object, ...]:
    """Columns of a sweep: all regular speeds are counted, but only those must hold that no irregular motion
    of the sweep comes before, as rounding decides where the sweep comes out of one.
    """
    limit = LIMITS["sweep"]
    before, now = ({key: side[key] for key in side if key.startswith("own_")} for side in (old, new))
    class_of = "own_motion"
    labels = _changed_labels(before, now)
    regular = is_regular(before, now, class_of)
    gaps = np.zeros(regular.size)
    for name, values in before.items():
        if values.dtype.kind != "U" and len(values) == regular.size and values.shape == now[name].shape:
            change = relative_change(before, now, name, [class_of])
            gaps[regular] = np.maximum(
                gaps[regular], change.reshape(regular.sum(), -1).max(axis=1, initial=0.0)
            )
    first = int(np.argmin(regular)) if not regular.all() else regular.size
    above = gaps > limit
    holds = not above[:first].any() and bool(regular.all() or (old[class_of] == new[class_of])[first])
    return int(regular.sum()), gaps.max(initial=0.0), limit, int(above.sum()), *labels, holds


def _labels_row(old: Answers, new: Answers) -> tuple[object, ...]:
    """Columns of the oscillators: classes may differ where second looks leave them undecided in both."""
    differ = old["oscillators/label"] != new["oscillators/label"]
    open_class = [side["oscillators/second_look"] == NOT_SETTLED for side in (old, new)]
    holds = differ.sum() <= MAY_DIFFER and not (differ & ~(open_class[0] & open_class[1])).any()
    return 0, 0.0, 0.0, 0, differ.size, int(differ.sum()), bool(holds)


def _by_quantity(old: Answers, new: Answers) -> Iterator[tuple[Answers, Answers]]:
    """Parts of the answers whose numbers are of one quantity a column; another shape is a part of its own."""
    for table in dict.fromkeys(key.rpartition("/")[0] for key in old):
        part = [{key: side[key] for key in side if key.rpartition("/")[0] == table} for side in (old, new)]
        names = part[0].get(f"{table}/quantity")
        if names is None or any(len(side.get(key, ())) != len(names) for side in part for key in part[0]):
            yield part[0], part[1]
            continue
        for quantity in dict.fromkeys(names):
            rows = names == quantity
            yield tuple({key: values[rows] for key, values in side.items()} for side in part)  # type: ignore[misc]


def _gaps(old: Answers, new: Answers) -> Iterator[np.ndarray]:
    """Relative changes of all numbers; one infinite where an array is missing or has another shape."""
    texts = [name for name, values in old.items() if values.dtype.kind == "U"]
    for name in old.keys() - set(texts):
        comparable = name in new and old[name].shape == new[name].shape
        yield relative_change(old, new, name, texts) if comparable else np.full(1, np.inf)


def _changed_labels(old: Answers, new: Answers) -> tuple[int, int]:
    """How many texts there are, and how many of them changed."""
    texts = [name for name, values in old.items() if values.dtype.kind == "U"]
    count = sum(old[name].size for name in texts)
    if any(name not in new or old[name].shape != new[name].shape for name in texts):
        return count, count
    return count, sum(int((old[name] != new[name]).sum()) for name in texts)


def main(arguments: Sequence[str] | None = None) -> int:
    """Compute what is missing, print the table, and write it where it is asked for.

    Parameters
    ----------
    arguments : sequence of str, optional
        Of the command line, by default those of this process.

    Returns
    -------
    int
        Exit code: 1 where an answer does not hold, else 0.
    """
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("cases", nargs="*", default=list(CASES), help=", ".join(CASES))
    parser.add_argument("--since", default=BASELINE, metavar="COMMIT", help=f"by default {BASELINE}")
    parser.add_argument("--before", type=Path, help="folder that keeps the answers of the earlier commit")
    parser.add_argument("--now", type=Path, help="folder that keeps the answers of this code")
    parser.add_argument("--tree", type=Path, help="root of another checkout with its .venv")
    parser.add_argument(
        "--table", type=Path, help=f"csv that is written; pages show {TABLE.relative_to(ROOT)}"
    )
    options = parser.parse_args(arguments)
    invalid = [name for name in options.cases if name not in CASES]
    if invalid:
        parser.error(f"unknown cases {', '.join(invalid)}; allowed: {', '.join(CASES)}")
    cases = {name: CASES[name] for name in options.cases}
    spread = {name: case for name, case in SPREAD.items() if name in cases}
    root = options.tree
    tree = present() if root is None else Tree(root, root, root / ".venv" / "bin" / "python")
    with TemporaryDirectory() as scratch:
        before, now = options.before or Path(scratch, "before"), options.now or Path(scratch, "now")
        files = [f"{name}.npz" for name in cases] + [f"{name}_spread.npz" for name in spread]
        if not all((before / name).exists() for name in files):
            with checked_out(options.since) as earlier:
                answer(earlier, before, cases)
                answer(earlier, before, spread, "_spread")
        answer(tree, now, cases)
        table = compare(before, now, cases)
    print(table.to_string(index=False))
    if options.table:
        table.to_csv(options.table, index=False, float_format="%.3g", lineterminator="\n")
    return int(not table["holds"][table["answer"] != "spread"].all())


if __name__ == "__main__":
    sys.exit(main())
