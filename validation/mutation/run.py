"""Mutation testing: do the tests of the core modules fail when the code is wrong?

Cosmic Ray makes the mutants; a sample of each module, the same each time, is tried by the module's own tests
in a copy of the checkout. `make mutation` runs this in an environment of its own.
"""

import argparse
import csv
import json
import os
import random
import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from cosmic_ray.ast import ast_nodes, get_ast
from cosmic_ray.mutating import mutate_code
from cosmic_ray.plugins import get_operator

from validation.mutation.modules import COLUMNS, MODULES, SURVIVED, Module, reasons

SEED = 34
"""Seed of the samples, which are the same each time."""
SAMPLE = 15
"""Number of mutants of each module."""
COMPARISONS = ("Eq", "NotEq", "Lt", "LtE", "Gt", "GtE")
ARITHMETIC = (
    "Add_Sub",
    "Sub_Add",
    "Mul_Div",
    "Div_Mul",
    "Pow_Mul",
    "Mod_Mul",
    "FloorDiv_Mul",
    "BitAnd_BitOr",
)
OPERATORS = (
    *(f"core/ReplaceComparisonOperator_{a}_{b}" for a in COMPARISONS for b in COMPARISONS if a != b),
    *(f"core/ReplaceBinaryOperator_{pair}" for pair in ARITHMETIC),
    "core/ReplaceUnaryOperator_Delete_USub",
    "core/ReplaceUnaryOperator_Delete_Not",
    "core/ReplaceUnaryOperator_Delete_Invert",
    "core/AddNot",
    "core/NumberReplacer",
    "core/ReplaceAndWithOr",
    "core/ReplaceOrWithAnd",
    "core/ReplaceTrueWithFalse",
    "core/ReplaceFalseWithTrue",
    "core/ReplaceBreakWithContinue",
    "core/ReplaceContinueWithBreak",
    "core/ZeroIterationForLoop",
)


@dataclass(frozen=True)
class Mutant:
    """The nth position of an operator in a file, and its line."""

    file: str
    operator: str
    occurrence: int
    line: int


def mutants(file: str, source: str) -> list[Mutant]:
    """List all mutants of a file by the operators in use, those of decorators left out.

    Parameters
    ----------
    file : str
        Path of the file.
    source : str
        Its text.

    Returns
    -------
    list[Mutant]
        The mutants.
    """
    tree = get_ast(source)
    lines = source.splitlines()
    found_mutants = []
    for name in OPERATORS:
        operator = get_operator(name)()
        positions = [position for node in ast_nodes(tree) for position in operator.mutation_positions(node)]
        found_mutants += [Mutant(file, name, number, start[0]) for number, (start, _) in enumerate(positions)]
    return [mutant for mutant in found_mutants if not lines[mutant.line - 1].lstrip().startswith("@")]


def sample(all_mutants: list[Mutant], count: int) -> list[Mutant]:
    """Sample mutants evenly over the lines: no line has a second mutant before all have a first.

    Parameters
    ----------
    all_mutants : list[Mutant]
        Mutants of a module.
    count : int
        Number of mutants.

    Returns
    -------
    list[Mutant]
        The sample.
    """
    rng = random.Random(SEED)
    by_line: dict[tuple[str, int], list[Mutant]] = {}
    for mutant in all_mutants:
        by_line.setdefault((mutant.file, mutant.line), []).append(mutant)
    for line in by_line.values():
        rng.shuffle(line)
    selection: list[Mutant] = []
    while len(selection) < min(count, len(all_mutants)):
        lines = [line for line in by_line.values() if line]
        rng.shuffle(lines)
        selection += [line.pop() for line in lines[: count - len(selection)]]
    return sorted(
        selection, key=lambda mutant: (mutant.file, mutant.line, mutant.operator, mutant.occurrence)
    )


def changed_line(before: str, after: str) -> tuple[str, str]:
    """Return the line in which two texts differ.

    Parameters
    ----------
    before : str
        First text.
    after : str
        Second text.

    Returns
    -------
    tuple[str, str]
        The line before and after.
    """
    pairs = zip(before.splitlines(), after.splitlines(), strict=False)
    return next(((old.strip(), new.strip()) for old, new in pairs if old != new), ("", ""))


def of_sample(module: Module, sources: dict[str, str], count: int) -> list[dict[str, str]]:
    """Return the rows of a module's sample, without their ends.

    Parameters
    ----------
    module : Module
        The module.
    sources : dict[str, str]
        Text of each file.
    count : int
        Number of mutants.

    Returns
    -------
    list[dict[str, str]]
        Rows by column.
    """
    all_mutants = [mutant for file in module.files for mutant in mutants(file, sources[file])]
    return [row_of(mutant, sources[mutant.file], len(all_mutants)) for mutant in sample(all_mutants, count)]


def row_of(mutant: Mutant, source: str, total: int) -> dict[str, str]:
    """Return the row of a mutant before it is tried.

    Parameters
    ----------
    mutant : Mutant
        The mutant.
    source : str
        Text of its file.
    total : int
        Number of mutants of the module.

    Returns
    -------
    dict[str, str]
        Values by column.
    """
    before, after = changed_line(source, text_of(mutant, source))
    numbers = total, mutant.line, mutant.operator.removeprefix("core/"), mutant.occurrence
    return dict(zip(COLUMNS[1:8], (mutant.file, *map(str, numbers), before, after), strict=True))


def text_of(mutant: Mutant, source: str) -> str:
    """Return the text of the mutant's file.

    Parameters
    ----------
    mutant : Mutant
        The mutant.
    source : str
        Text of the file without it.

    Returns
    -------
    str
        Text with the mutant.
    """
    return str(mutate_code(source, get_operator(mutant.operator)(), mutant.occurrence))


def of_survivors(rows: list[dict[str, str]], sources: dict[str, str]) -> list[dict[str, str]]:
    """Return the rows of a stored table at the lines of today.

    Parameters
    ----------
    rows : list[dict[str, str]]
        Rows of survivors.
    sources : dict[str, str]
        Text of each file.

    Returns
    -------
    list[dict[str, str]]
        Rows by column.

    Raises
    ------
    SystemExit
        If a mutant is gone.
    """
    current = []
    for row in rows:
        source = sources[row["file"]]
        same_operator = [
            mutant for mutant in mutants(row["file"], source) if mutant.operator == f"core/{row['operator']}"
        ]
        today = [row_of(mutant, source, int(row["mutants"])) for mutant in same_operator]
        equal_rows = [
            candidate
            for candidate in today
            if (candidate["before"], candidate["after"]) == (row["before"], row["after"])
        ]
        if not equal_rows:
            raise SystemExit(
                f"{row['file']}: no line gives the mutant {row['after']!r}: sample the module anew"
            )
        current.append(
            min(equal_rows, key=lambda candidate: abs(int(candidate["occurrence"]) - int(row["occurrence"])))
        )
    return current


def try_mutants(
    name: str, rows: list[dict[str, str]], sources: dict[str, str], python: Path, tree: Path
) -> Iterator[dict[str, str]]:
    """Yield the rows of one module with their ends, each as soon as its tests have ended.

    Parameters
    ----------
    name : str
        Name of the module.
    rows : list[dict[str, str]]
        Rows without ends.
    sources : dict[str, str]
        Text of each file.
    python : Path
        Interpreter of the tests.
    tree : Path
        Copy of the checkout.

    Yields
    ------
    dict of str
        Values by column.
    """
    module, why = MODULES[name], reasons()
    mutants_to_try = [
        Mutant(row["file"], f"core/{row['operator']}", int(row["occurrence"]), int(row["line"]))
        for row in rows
    ]
    work = [{"file": mutant.file, "text": text_of(mutant, sources[mutant.file])} for mutant in mutants_to_try]
    (tree / "job.json").write_text(json.dumps({"tests": module.tests, "mutants": work}), encoding="utf-8")
    environment = {
        **os.environ,
        "PYTHONDONTWRITEBYTECODE": "1",
        "PYTHONPATH": str(tree),
        "OMP_NUM_THREADS": "1",
    }
    command = [str(python), str(tree / "validation/mutation/worker.py"), "job.json"]
    with subprocess.Popen(command, cwd=tree, env=environment, stdout=subprocess.PIPE, text=True) as running:
        assert running.stdout is not None
        for row, line in zip(rows, running.stdout, strict=True):
            end = line.strip()
            reason = why.get((row["file"], row["before"], row["after"]), "") if end == SURVIVED else ""
            yield {"module": name, **row, "end": end, "reason": reason}
    if running.returncode:
        raise SystemExit(f"{name}: the tests of mutants failed to run")


def copy_of(checkout: Path, tree: Path) -> Path:
    """Copy the parts of a checkout that tests need.

    Parameters
    ----------
    checkout : Path
        The checkout.
    tree : Path
        Folder of the copy.

    Returns
    -------
    Path
        The same folder.
    """
    for name in ("facegear", "tests", "validation", "config"):
        shutil.copytree(checkout / name, tree / name, ignore=shutil.ignore_patterns("__pycache__"))
    for name in ("conftest.py", "pyproject.toml"):
        shutil.copy(checkout / name, tree)
    return tree


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("table", type=Path)
    parser.add_argument("--python", type=Path, default=Path(".venv/bin/python"))
    parser.add_argument("--modules", nargs="*", choices=MODULES, default=list(MODULES))
    parser.add_argument("--count", type=int, default=SAMPLE, help="mutants of each module")
    parser.add_argument("--survivors", action="store_true", help="only those that survive in the table")
    options = parser.parse_args()
    table = list(csv.DictReader(options.table.open(encoding="utf-8"))) if options.table.exists() else []
    sources = {
        file: Path(file).read_text(encoding="utf-8") for module in MODULES.values() for file in module.files
    }
    with tempfile.TemporaryDirectory() as folder:
        tree = copy_of(Path.cwd(), Path(folder))
        for name in options.modules:
            module_rows = [row for row in table if row["module"] == name]
            new_rows = [row for row in module_rows if options.survivors and row["end"] != SURVIVED]
            left = [row for row in module_rows if row["end"] == SURVIVED]
            rows = (
                of_survivors(left, sources)
                if options.survivors
                else of_sample(MODULES[name], sources, options.count)
            )
            new_rows += try_mutants(name, rows, sources, options.python.absolute(), tree) if rows else []
            new_rows.sort(key=lambda row: (row["file"], int(row["line"])))
            table = [row for row in table if row["module"] != name] + new_rows
            write(table, options.table)


def write(rows: list[dict[str, str]], path: Path) -> None:
    """Write the table, modules in order.

    Parameters
    ----------
    rows : list[dict[str, str]]
        All rows.
    path : Path
        Path of the table.
    """
    order = {name: number for number, name in enumerate(MODULES)}
    with path.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.DictWriter(stream, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(sorted(rows, key=lambda row: order[row["module"]]))


if __name__ == "__main__":
    main()
