"""Places of the expressions in f-strings, which `ast` of Python 3.11 gets wrong."""

import io
import re
import tokenize
from collections.abc import Iterator

PREFIX = re.compile(r"([a-zA-Z]*)('''|\"\"\"|'|\")")
"""Letters before a string, and its quotes."""


def find_expressions(text: str) -> Iterator[tuple[int, str]]:
    """Yield the expressions in an f-string, with those in its format specifications.

    Parameters
    ----------
    text
        Text of the string with prefix and quotes, maybe of several strings in a row.

    Yields
    ------
    tuple of int and str
        Index of the expression's first character in `text`, and the expression.
    """
    lines = text.splitlines(keepends=True)
    # Parentheses keep the lines of a concatenated string together.
    for token in tokenize.generate_tokens(io.StringIO(f"({text})").readline):
        if token.type == tokenize.STRING:
            row, column = token.start
            begin = sum(map(len, lines[: row - 1])) + column - (row == 1)
            match = PREFIX.match(token.string)
            if match and "f" in match[1].lower():
                body = token.string[match.end() : -len(match[2])]
                yield from _braces(body, begin + match.end(), literal=True)


def _braces(body: str, begin: int, literal: bool) -> Iterator[tuple[int, str]]:
    at = 0
    while at < len(body):
        if literal and body[at : at + 2] in ("{{", "}}"):
            at += 2
        elif body[at] == "{":
            end = _expression_end(body, at + 1)
            expression = body[at + 1 : end]
            yield begin + at + 1, expression
            close = _find_closing_brace(body, end)
            if ":" in body[end:close]:
                spec = body.index(":", end)
                yield from _braces(body[spec + 1 : close], begin + spec + 1, literal=False)
            at = close + 1
        else:
            at += 1


def _expression_end(body: str, at: int) -> int:
    """Index behind the expression that begins at `at`: of `=`, `!r`, `:` or the closing brace."""
    depth, quote = 0, ""
    while at < len(body):
        sign = body[at]
        if quote:
            if body.startswith(quote, at):
                at += len(quote) - 1
                quote = ""
        elif sign in "'\"":
            quote = body[at : at + 3] if body[at : at + 3] == sign * 3 else sign
            at += len(quote) - 1
        elif sign in "([{":
            depth += 1
        elif depth and sign in ")]}":
            depth -= 1
        elif depth == 0 and (sign in "}:" or re.match(r"(![rsa]|=\s*(![rsa])?)[:}]", body[at:])):
            return at
        at += 1
    raise ValueError("an f-string has a field without an end")


def _find_closing_brace(body: str, at: int) -> int:
    depth = 0
    while True:
        if body[at] == "{":
            depth += 1
        elif body[at] == "}":
            if depth == 0:
                return at
            depth -= 1
        at += 1
