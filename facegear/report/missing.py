"""The head of a page that lacks results: what could not be computed, and why."""

from collections.abc import Sequence
from html import escape

END = "</header>"
"""End of the page's header, where the list stands."""
STYLE = "border:2px solid #b3261e;border-radius:6px;padding:.6em 1em;margin:1em auto;max-width:75em"


def with_missing(page: str, missing: Sequence[str]) -> str:
    """Return a page with a list of what is missing at its head.

    Parameters
    ----------
    page : str
        The whole page, as HTML.
    missing : sequence of str
        What could not be computed and why, a line each; nothing is inserted if there is none.

    Returns
    -------
    str
        The page.
    """
    if not missing:
        return page
    head, end, rest = page.partition(END)
    lines = "".join(f"<li>{escape(line)}</li>" for line in missing)
    note = (
        f'<section role="note" aria-label="Not computed" style="{STYLE}"><strong>Not computed. '
        f"The page shows everything else.</strong><ul>{lines}</ul></section>\n"
    )
    return f"{head}{note}{end}{rest}"
