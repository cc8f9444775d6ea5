"""Answers of two commits: `python -m validation.ratios.equality [CASE ...] [--before FOLDER]`.

Contact, statics and one mesh period from given starts are compared up to rounding. Orbits, multipliers and
the regular speeds of sweeps are compared more widely, since many periods magnify rounding; irregular motions
by their labels. Each commit runs in the environment of its own lock file, as for the ratios of time.
"""

import argparse
import json
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from types import MappingProxyType
from typing import Any

import numpy as np
import pandas as pd

from facegear.schema.motion import SWEEP_ACCURACY
from validation.dynamics.problems import OIL
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
STEP_TOLERANCE = 1e-12
"""Local error of the steps of all motions, over the length scale."""
SPREAD = "spread"
"""Folder of the answers of the earlier commit where NumPy and OpenBLAS round otherwise."""
MOVES_FOLDER = "moved"
"""Folder of folders of the answers of the earlier commit to contact, the gear moved by less than a coordinate
can be rounded.
"""
SHIFT_UM = 1e-11
"""Size of these moves: 1e-17 m, less than the last place of a coordinate of 0.1 m. They are 5e-13 of the
approach under load and alike for all points, but every ray from pinion to gear is rounded anew.
"""
MOVES: Mapping[str, Mapping[str, float]] = {
    f"{key}_{sign:+d}": {f"tooth_pair.assembly.{key}_um": sign * SHIFT_UM}
    for key in ("offset", "gear_axial")
    for sign in (1, -1)
}
"""Changes of the config that move the gear, by the folder of their answers."""
TWO_CODES = 2.0
"""Times its spread by moves that a number of contact may change: both codes round a gap, each in its own way,
and the largest of four draws is not the largest that there can be.
"""
NOT_COMPARED = ("own_displacement", "own_velocity", "residual", "own_residual")
"""States in reduced coordinates, which may come in another order, and what is left of solved equations."""
ROOTS = ("own_modal",)
"""Roots of differences of squares, of which 1e-8 is rounding: their squares are compared."""
COLUMNS = (
    *("case", "answer", "numbers", "largest_change", "spread", "limit", "above"),
    *("labels", "labels_changed", "labels_spread", "holds"),
)
MOTION = ("statics", "mesh_period", "response")
CLASS_OF_SPEED = "chunk/own_motion"
"""Array of the class of motion at each speed of a sweep; the other arrays begin alike."""
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

    @property
    def is_contact(self) -> bool:
        """Whether teeth in contact are asked for."""
        return self.calls[:1] == ("contact",)

    def with_changes(self, changes: Mapping[str, Any]) -> "Case":
        """Return the case of a config that is changed further.

        Parameters
        ----------
        changes : mapping
            Values by dotted keys.

        Returns
        -------
        Case
            The same calls.
        """
        return replace(self, changes={**self.changes, **changes})

    @property
    def is_motion(self) -> bool:
        """Whether the case has a machine."""
        return bool(self.direction or self.calls[:1] == MOTION[:1])

    @property
    def accuracy(self) -> dict[str, Any]:
        """Changes by which the choice of the steps moves no digit that counts."""
        sweep = {**SWEEP_ACCURACY.model_dump(), "tolerance": STEP_TOLERANCE}
        return {"dynamics.accuracy.tolerance": STEP_TOLERANCE, "dynamics.sweep.accuracy": sweep}

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
            "changes": {**(self.accuracy if self.is_motion else {}), **self.changes},
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
    "sweep_irregular_up": _sweep(EXAMPLE, "up"),
    "sweep_irregular_down": _sweep(EXAMPLE, "down"),
    "oscillators": Case("facegear/example.yaml", ("oscillators",)),
}
"""Teeth, one machine for each law and element, sweeps, and the classes of random oscillators."""
OTHER_ROUNDING = {
    "NPY_DISABLE_CPU_FEATURES": "X86_V3 X86_V4 AVX512_ICL AVX512_SPR",
    "OPENBLAS_CORETYPE": "Nehalem",
}
"""Environment in which NumPy and OpenBLAS round otherwise than on this processor."""


def answer(
    tree: Tree, folder: Path, cases: Mapping[str, Case], variables: Mapping[str, str] = MappingProxyType({})
) -> None:
    """Compute cases with a tree, each in a process of its own, unless the folder has them already.

    Parameters
    ----------
    tree : Tree
        The code.
    folder : Path
        One npz file a case is written here.
    cases : mapping
        Cases by name.
    variables : mapping
        Further variables of the processes' environment.
    """
    folder.mkdir(parents=True, exist_ok=True)
    with TemporaryDirectory() as scratch:
        for name, case in cases.items():
            path, job = folder / f"{name}.npz", Path(scratch) / "job.json"
            if path.exists():
                continue
            job.write_text(json.dumps(case.job(tree)), encoding="utf-8")
            answers = Path(scratch) / "answers.npz"
            process = Job(tree, job, answers, Path(scratch) / "inputs", False, variables)
            seconds = process.call()["seconds"]
            process.close()
            answers.replace(path)
            print(f"{path}: {seconds:.1f} CPU s", file=sys.stderr, flush=True)


def answer_spread(earlier: Tree, before: Path, cases: Mapping[str, Case]) -> None:
    """Compute what the earlier commit answers where its numbers are rounded otherwise.

    Parameters
    ----------
    earlier : Tree
        Code of the earlier commit.
    before : Path
        Folder of its answers; those of `SPREAD` and `MOVES_FOLDER` are written below it.
    cases : mapping
        Cases by name.
    """
    answer(earlier, before / SPREAD, cases, OTHER_ROUNDING)
    in_contact = {name: case for name, case in cases.items() if case.is_contact}
    for move, changes in MOVES.items() if in_contact else ():
        cases_of_move = {name: case.with_changes(changes) for name, case in in_contact.items()}
        answer(earlier, before / MOVES_FOLDER / move, cases_of_move)


def compare(before: Path, now: Path, cases: Mapping[str, Case] = CASES) -> pd.DataFrame:
    """Compare the stored answers of two trees.

    Parameters
    ----------
    before, now : Path
        Folders of npz files; that of the earlier commit has the folder SPREAD, too.
    cases : mapping
        Those that are compared.

    Returns
    -------
    DataFrame
        COLUMNS, a row for each answer of each case: numbers that are compared, their largest change, that of
        the earlier commit between ways of rounding (`spread`), and how many are `above`: they change by more
        than the limit and by more than their column's spread, of contact by TWO_CODES times that. The same of
        labels.
    """
    rows: list[tuple[object, ...]] = []
    for name in cases:
        moves = MOVES if cases[name].is_contact else ()
        otherwise = [before / SPREAD, *(before / MOVES_FOLDER / move for move in moves)]
        sides = [read_answers(folder / f"{name}.npz") for folder in (before, now, *otherwise)]
        if CLASS_OF_SPEED in sides[0]:
            rows.append((name, "sweep", *_sweep_row(sides)))
            continue
        for call in dict.fromkeys(key.partition("/")[0] for key in sides[0]):
            part = _beginning(sides, f"{call}/")
            row = _oscillators_row(part) if call == "oscillators" else _numbers_row(part, LIMITS[call])
            rows.append((name, call, *row))
    return pd.DataFrame(rows, columns=list(COLUMNS))


def _files_before(before: Path, cases: Mapping[str, Case]) -> Iterator[Path]:
    """Files of all answers of the earlier commit."""
    for name, case in cases.items():
        moves = [before / MOVES_FOLDER / move for move in MOVES] if case.is_contact else []
        yield from (folder / f"{name}.npz" for folder in (before, before / SPREAD, *moves))


def _beginning(sides: Sequence[Answers], start: str) -> list[Answers]:
    return [{name: side[name] for name in side if name.startswith(start)} for side in sides]


def _numbers_row(sides: Sequence[Answers], limit: float) -> tuple[object, ...]:
    """Columns from `numbers` on: those of regular motions and of what does not move."""
    gaps, spreads, above = [np.zeros(1)], [np.zeros(1)], 0
    for old, new, *otherwise in _by_quantity(sides):
        for name in _numbers(old):
            gaps.append(_gap(old, new, name))
            spreads.append(np.array([_spread(old, rounding, name) for rounding in otherwise]))
            threshold = max(limit, spreads[-1][0], TWO_CODES * spreads[-1][1:].max(initial=0.0))
            above += int((gaps[-1] > threshold).sum())
    labels, labels_changed, labels_spread = _labels(sides[:3])
    count = sum(gap.size for gap in gaps[1:])
    largest = [float(np.concatenate(part).max()) for part in (gaps, spreads)]
    holds = above == 0 and labels_changed <= labels_spread
    return count, *largest, limit, above, labels, labels_changed, labels_spread, holds


def _sweep_row(sides: Sequence[Answers]) -> tuple[object, ...]:
    """Columns of a sweep, whose numbers are its regular speeds. Only those must hold that no irregular motion
    of the sweep comes before, as rounding decides where the sweep comes out of one.
    """
    old, new, rounding = _beginning(sides, CLASS_OF_SPEED.removesuffix("motion"))
    regular, limit = is_regular(old, new, CLASS_OF_SPEED), LIMITS["sweep"]
    gaps, spreads, above = (np.zeros(regular.size) for _ in range(3))
    for name in _numbers(old):
        if len(old[name]) != regular.size:
            continue
        gap, spread = (_gap_of_rows(old, side, name) for side in (new, rounding))
        above += gap > max(limit, spread.max())
        gaps, spreads = np.maximum(gaps, gap), np.maximum(spreads, spread)
    first = regular.size if regular.all() else int(np.argmin(regular))
    same_class = old[CLASS_OF_SPEED] == new[CLASS_OF_SPEED]
    holds = bool(not above[:first].any() and same_class[: first + 1].all())
    counts = int(regular.sum()), gaps.max(), spreads.max(), limit, int((above > 0).sum())
    return *counts, *_labels([old, new, rounding]), holds


def _gap_of_rows(old: Answers, new: Answers, name: str) -> np.ndarray:
    """Largest change of a number in each row; zero where the motion is not regular on both sides."""
    regular = is_regular(old, new, CLASS_OF_SPEED)
    gaps = np.zeros(regular.size)
    gaps[regular] = _gap(old, new, name).reshape(regular.sum(), -1).max(axis=1, initial=0.0)
    return gaps


def _oscillators_row(sides: Sequence[Answers]) -> tuple[object, ...]:
    """Columns of the oscillators: classes may differ where second looks leave them open on both sides."""
    classes = [side["oscillators/label"] for side in sides]
    is_open = [side["oscillators/second_look"] == NOT_SETTLED for side in sides]
    differs = classes[0] != classes[1]
    holds = bool(differs.sum() <= MAY_DIFFER and not (differs & ~(is_open[0] & is_open[1])).any())
    counts = classes[0].size, int(differs.sum()), int((classes[0] != classes[2]).sum())
    return 0, 0.0, 0.0, 0.0, 0, *counts, holds


def _by_quantity(sides: Sequence[Answers]) -> Iterator[Sequence[Answers]]:
    """Tables, and of a table with one quantity a row the rows of each: numbers of a column are alike then."""
    for table in dict.fromkeys(key.rpartition("/")[0] for key in sides[0]):
        part = [
            {key: side[key] for key in side if key.rpartition("/")[0] == table and _is_compared(key)}
            for side in sides
        ]
        names = part[0].get(f"{table}/quantity")
        if names is None or any(len(values) != len(names) for side in part for values in side.values()):
            yield part
            continue
        for quantity in dict.fromkeys(names):
            if quantity not in NOT_COMPARED:
                rows = names == quantity
                yield [{key: values[rows] for key, values in side.items()} for side in part]


def _is_compared(name: str) -> bool:
    return name.rpartition("/")[2] not in NOT_COMPARED


def _numbers(answers: Answers) -> list[str]:
    return [name for name, values in answers.items() if values.dtype.kind != "U" and _is_compared(name)]


def _gap(old: Answers, new: Answers, name: str) -> np.ndarray:
    """Relative changes of the numbers of an array; infinite where it is missing or has another shape."""
    texts = [text for text, values in old.items() if values.dtype.kind == "U"]
    if any(text not in new or old[text].shape != new[text].shape for text in (name, *texts)):
        return np.full(old[name].size, np.inf)
    if name.rpartition("/")[2] in ROOTS:
        old, new = ({**side, name: side[name] ** 2} for side in (old, new))
    return relative_change(old, new, name, texts)


def _spread(old: Answers, rounding: Answers, name: str) -> float:
    """Largest change by other rounding; 0 of whole numbers and where a table has other rows then."""
    if old[name].dtype.kind == "i":
        return 0.0
    gap = _gap(old, rounding, name)
    return float(gap.max(initial=0.0)) if np.isfinite(gap).all() else 0.0


def _labels(sides: Sequence[Answers]) -> tuple[int, int, int]:
    """Count of texts, of those that changed now, and of those that change between two ways of rounding."""
    old = sides[0]
    texts = [name for name, values in old.items() if values.dtype.kind == "U"]
    differences = [
        sum(
            int((old[name] != side[name]).sum())
            if name in side and old[name].shape == side[name].shape
            else old[name].size
            for name in texts
        )
        for side in sides[1:]
    ]
    return sum(old[name].size for name in texts), differences[0], differences[1]


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
    table_help = f"csv that is written; pages show {TABLE.relative_to(ROOT)}"
    parser.add_argument("--table", type=Path, help=table_help)
    options = parser.parse_args(arguments)
    invalid = [name for name in options.cases if name not in CASES]
    if invalid:
        parser.error(f"unknown cases {', '.join(invalid)}; allowed: {', '.join(CASES)}")
    cases = {name: CASES[name] for name in options.cases}
    root = options.tree
    tree = present() if root is None else Tree(root, root, root / ".venv" / "bin" / "python")
    with TemporaryDirectory() as scratch:
        before, now = options.before or Path(scratch, "before"), options.now or Path(scratch, "now")
        if any(not path.exists() for path in _files_before(before, cases)):
            with checked_out(options.since) as earlier:
                answer(earlier, before, cases)
                answer_spread(earlier, before, cases)
        answer(tree, now, cases)
        table = compare(before, now, cases)
    print(table.to_string(index=False, float_format="{:.2g}".format))
    if options.table:
        table.to_csv(options.table, index=False, float_format="%.3g", lineterminator="\n")
    return int(not table["holds"].all())


if __name__ == "__main__":
    sys.exit(main())
