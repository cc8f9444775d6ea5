"""The table of mutants that the documentation shows."""

from pathlib import Path

from validation.mutation.modules import (
    COLUMNS,
    ENDLESS,
    KILLED_END,
    MODULES,
    SURVIVED,
    mutation_tables,
    reasons,
    rows,
)

ROOT = Path(__file__).parents[2]
TABLE = rows()


def test_mutants_of_every_core_module_were_tried():
    assert {tuple(row) for row in TABLE} == {COLUMNS}
    assert [*dict.fromkeys(row["module"] for row in TABLE)] == list(MODULES)
    assert {row["end"] for row in TABLE} <= {SURVIVED, KILLED_END, ENDLESS}
    assert all(row["file"] in MODULES[row["module"]].files and row["before"] != row["after"] for row in TABLE)


def test_every_mutant_that_survives_has_its_reason_and_every_reason_its_mutant():
    survivors = {(row["file"], row["before"], row["after"]): row["reason"] for row in TABLE if row["reason"]}
    assert all((row["end"] == SURVIVED) == bool(row["reason"]) for row in TABLE)
    assert survivors == reasons()


def test_modules_name_files_and_tests_that_exist():
    for module in MODULES.values():
        for name in (*module.files, *module.tests):
            file, _, test = name.partition("::")
            assert (
                f"def {test}(" in (ROOT / file).read_text(encoding="utf-8")
                if test
                else (ROOT / file).is_file()
            )


def test_the_page_shows_every_survivor():
    assert mutation_tables(TABLE).count("\n| `") == sum(row["end"] == SURVIVED for row in TABLE)
