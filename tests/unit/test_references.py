"""Docstrings name their sources by author and year, and docs/reference/references.md says what they are."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "reference" / "references.md").read_text(encoding="utf-8")
ENTRIES = re.findall(r"^- \*\*(.+? \d{4})\*\*\. ", PAGE, flags=re.MULTILINE)
CITED = re.compile(r"\b[A-Z]\w+(?: et al\.| and [A-Z]\w+)?,? (?:19|20)\d\d\b")


def texts():
    for folder in ("facegear", "docs"):
        for path in sorted((ROOT / folder).rglob("*")):
            if (
                path.suffix in (".py", ".hpp", ".cpp", ".md")
                and path.name != "references.md"
                and "joss" not in path.parts
            ):
                yield path, " ".join(path.read_text(encoding="utf-8").replace("\n//", "\n").split())


def test_each_reference_is_named_where_its_method_is_used():
    library = " ".join(text for path, text in texts())
    assert len(ENTRIES) == len(set(ENTRIES)) > 30
    assert [entry for entry in ENTRIES if entry not in library] == []


def test_each_source_that_a_text_names_by_year_is_on_the_page():
    named = [(path.name, words) for path, text in texts() for words in CITED.findall(text)]
    wrong = [(name, words) for name, words in named if not any(entry.endswith(words) for entry in ENTRIES)]
    assert wrong == []
