"""Generated blocks of the documentation, and the number of its words.

A block stands between the lines `<!-- generated: NAME -->` and `<!-- end -->`, so that a page shows its
tables wherever it is read. `python -m validation.pages` writes all blocks anew; a test fails where one is
obsolete.
"""

import re
import sys
from collections.abc import Callable
from pathlib import Path

import pandas as pd

from facegear.pipeline.table import listing
from validation import bearing_sharing, kinds_of_teeth, sharing_advice
from validation.mutation.modules import mutation_tables
from validation.mutation.modules import rows as mutation_rows
from validation.platforms import DIFFERENCES, OUTCOMES, outcomes_table, platforms_table
from validation.references import ROOT, comparison_tables, counts_table, read, shares_table

DOCS = ROOT / "docs"
BLOCKS: dict[str, Callable[[], str]] = {
    "shares": lambda: shares_table(read()),
    "capabilities": lambda: counts_table(read()),
    "comparisons": lambda: comparison_tables(read()),
    "platforms": lambda: platforms_table(pd.read_csv(DIFFERENCES)),
    "platform tests": lambda: outcomes_table(pd.read_csv(OUTCOMES)),
    "mutants": lambda: mutation_tables(mutation_rows()),
    "stages": listing,
    "bearing sharing": lambda: bearing_sharing.page_table(pd.read_csv(bearing_sharing.TABLE)),
    "kinds of teeth": lambda: kinds_of_teeth.page_table(pd.read_csv(kinds_of_teeth.TABLE)),
    "sharing advice": lambda: sharing_advice.advice_table(pd.read_csv(sharing_advice.TABLE)),
}
"""Text of every generated block, by its name in the pages."""
GENERATED_BLOCK = re.compile(r"(?ms)^<!-- generated: ([\w ]+) -->\n(.*?)^<!-- end -->$")
STORED_TABLE = re.compile(r"(?ms)^<!-- stored: (\S+) -->\n(.*?)^<!-- end -->$")
"""A table whose rows a test compares with the stored csv that is named."""
CODE_BLOCK = re.compile(r"(?ms)^ *```.*?^ *```$")
WHOLE = ("reference/config.md",)
"""Pages that are generated as a whole, each by its own command."""
MOST_WORDS = 48_500
"""Largest number of words that a person has written in all pages: what a reader can be asked to maintain.

It was 45,000 while spur teeth and springs as bearings were all; other teeth, rolling bearings and casings
came since.
"""


def pages() -> list[Path]:
    """List the pages of the documentation.

    Returns
    -------
    list of Path
        All Markdown files that Sphinx builds; the paper draft in `docs/joss` is none of them.
    """
    return [page for page in sorted(DOCS.rglob("*.md")) if page.relative_to(DOCS).parts[0] != "joss"]


def renew_blocks(text: str) -> str:
    """Write the generated blocks of a page anew.

    Parameters
    ----------
    text : str
        The page as Markdown.

    Returns
    -------
    str
        The page with each generated block as it would be made today.

    Raises
    ------
    KeyError
        For a block with a name that is none of BLOCKS.
    """

    def block(match: re.Match[str]) -> str:
        return f"<!-- generated: {match[1]} -->\n\n{BLOCKS[match[1]]().strip()}\n\n<!-- end -->"

    return GENERATED_BLOCK.sub(block, text)


def count_words(text: str) -> int:
    """Count the words of a page that a person has written.

    A word is a run of characters without spaces that holds a letter or a digit. Code blocks, generated blocks
    and tables that a test compares with a stored csv do not count.

    Parameters
    ----------
    text : str
        The page as Markdown.

    Returns
    -------
    int
        Number of words.
    """
    for pattern in (GENERATED_BLOCK, STORED_TABLE, CODE_BLOCK):
        text = pattern.sub("", text)
    return sum(re.search(r"[^\W_]", word) is not None for word in text.split())


def total_words() -> int:
    """Count the words of all pages.

    Returns
    -------
    int
        Sum over the pages that are not generated as a whole.
    """
    return sum(
        count_words(page.read_text(encoding="utf-8"))
        for page in pages()
        if page.relative_to(DOCS).as_posix() not in WHOLE
    )


def main() -> None:
    """Renew all pages and print which changed, and the number of words."""
    for page in pages():
        text = page.read_text(encoding="utf-8")
        renewed = renew_blocks(text)
        if renewed != text:
            page.write_text(renewed, encoding="utf-8")
            sys.stdout.write(f"renewed {page.relative_to(ROOT)}\n")
    sys.stdout.write(f"{total_words()} words, at most {MOST_WORDS}\n")


if __name__ == "__main__":
    main()
