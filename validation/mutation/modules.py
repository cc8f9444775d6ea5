"""Core modules whose tests are tried on mutants, the table of how they end, and why survivors may survive."""

import csv
from dataclasses import dataclass
from pathlib import Path

TESTS = "tests/unit/"
EXPLANATIONS = Path(__file__).with_name("survivors.csv")
"""Survivors that no test can or should notice: file, before, after, and the reason in one line."""
TABLE = Path(__file__).parents[2] / "docs/measured/mutation.csv"
COLUMNS = ("module", "file", "mutants", "line", "operator", "occurrence", "before", "after", "end", "reason")
"""Columns of the table: one row a mutant; `mutants`: how many the module has, of which the table holds a
sample."""
SURVIVED, KILLED_END, ENDLESS = "survived", "killed", "endless"
"""Ends of a mutant: no test fails, one does, or the tests take far longer than usual."""


@dataclass(frozen=True)
class Module:
    """Files of facegear, and the tests that are their own."""

    files: tuple[str, ...]
    tests: tuple[str, ...]


def _tests(folder: str, *names: str) -> tuple[str, ...]:
    return tuple(f"{TESTS}{folder}/test_{name}.py" for name in names)


MODULES = {
    "contact solver": Module(("facegear/contact/position_solver.py",), _tests("contact", "contact_solver")),
    "mesh law": Module(
        (
            "facegear/meshing/linear.py",
            "facegear/meshing/load_dependent.py",
            "facegear/meshing/force_table.py",
        ),
        _tests("meshing", "linear_law", "load_dependent_law"),
    ),
    "statics": Module(
        ("facegear/machine/statics.py",),
        _tests("machine", "statics", "statics_by_energy", "geometric_statics"),
    ),
    "geometry": Module(
        (
            "facegear/teeth/generated_flank.py",
            "facegear/teeth/generated_fillet.py",
            "facegear/teeth/face_gear.py",
            "facegear/teeth/pinion.py",
        ),
        _tests(
            "teeth", "face_gear", "limits", "pinion", "validate", "public_flanks", "spur_limit", "deviations"
        ),
    ),
    "rating": Module(("facegear/strength/rating.py",), _tests("strength", "rating")),
}


def reasons() -> dict[tuple[str, str, str], str]:
    """Read why survivors may survive.

    Returns
    -------
    dict[tuple[str, str, str], str]
        Reason by file and the line before and after.
    """
    with EXPLANATIONS.open(newline="", encoding="utf-8") as stream:
        return {(row["file"], row["before"], row["after"]): row["reason"] for row in csv.DictReader(stream)}


def rows() -> list[dict[str, str]]:
    """Read the stored table.

    Returns
    -------
    list[dict[str, str]]
        Values by column, one dict a row.
    """
    with TABLE.open(newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


def mutation_tables(table: list[dict[str, str]]) -> str:
    """Write how the mutants of each module ended, and all survivors with their reasons.

    Parameters
    ----------
    table : list[dict[str, str]]
        Rows of the table.

    Returns
    -------
    str
        Two tables of Markdown.
    """
    ends = (KILLED_END, ENDLESS, SURVIVED)
    lines = ["| module | mutants | tried | " + " | ".join(ends) + " |", "|---" * (3 + len(ends)) + "|"]
    for name in MODULES:
        module_rows = [row for row in table if row["module"] == name]
        counts = [str(sum(row["end"] == end for row in module_rows)) for end in ends]
        lines.append(f"| {name} | {module_rows[0]['mutants']} | {len(module_rows)} | {' | '.join(counts)} |")
    lines += ["", "| survivor | changed to | why no test notices it |", "|---|---|---|"]
    for row in table:
        if row["end"] == SURVIVED:
            before, after = (f"`` {row[key].replace('|', chr(92) + '|')} ``" for key in ("before", "after"))
            lines.append(
                f"| `{row['file'].removeprefix('facegear/')}` {before} | {after} | {row['reason']} |"
            )
    return "\n".join(lines)
