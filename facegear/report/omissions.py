"""The head of a page that lacks results: what could not be computed, and why."""

from collections.abc import Sequence
from html import escape

END = "</header>"
"""End of the page's header, where the list stands."""
STYLE = "flex:1 1 100%;border:2px solid #b3261e;border-radius:6px;padding:.4em .8em;margin:.4em 0 0"
"""Style of the list: as wide as the header, whose layout is a row that wraps."""
LIST_STYLE = "margin:.2em 0;padding-left:1.2em"
"""Style of its lines."""


def with_omissions(page: str, omissions: Sequence[str]) -> str:
    """Return a page with a list of what is missing at its head.

    Parameters
    ----------
    page : str
        The whole page, as HTML.
    omissions : sequence of str
        What could not be computed and why, a line each; nothing is inserted if there is none.

    Returns
    -------
    str
        The page.
    """
    if not omissions:
        return page
    head, end, rest = page.partition(END)
    lines = "".join(f"<li>{escape(line)}</li>" for line in omissions)
    note = (
        f'<section role="note" aria-label="Not computed" style="{STYLE}"><strong>Not computed. '
        f'The page shows everything else.</strong><ul style="{LIST_STYLE}">{lines}</ul></section>\n'
    )
    return f"{head}{note}{end}{rest}"
