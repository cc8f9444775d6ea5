"""Numbers and counts as people read them: one format for reports, verdicts and messages."""

from math import floor, isfinite, log10

PLAIN = (1e-3, 1e6)
"""Numbers from the first up to the second are written without a power of ten, a free choice."""


def format_number(value: float, digits: int = 3, *, group_digits: bool = True) -> str:
    """Write a number with `digits` significant digits; digits before the point are never rounded to
    zeros.

    Parameters
    ----------
    value : float
        The number, any unit.
    digits : int
        Significant digits, dimensionless. Below 1e-3 and from 1e6 on a power of ten follows, as in
        `1.2e7`.
    group_digits : bool
        Whether a comma stands before every three digits of the whole part.

    Returns
    -------
    str
        The number without zeros at the end of its fraction; empty for nan.

    Examples
    --------
    >>> [format_number(value) for value in (2500.0, 0.95949, -0.0, float("inf"))]
    ['2,500', '0.959', '0', 'inf']
    """
    if value != value:
        return ""
    if value == 0.0 or not isfinite(value):
        return f"{value + 0.0:g}"
    if not PLAIN[0] <= abs(value) < PLAIN[1]:
        mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
        return f"{_without_end_zeros(mantissa)}e{int(exponent)}"
    decimals = max(digits - 1 - floor(log10(abs(value))), 0)
    return _without_end_zeros(f"{value:{',' if group_digits else ''}.{decimals}f}")


def begin_with_capital(text: str) -> str:
    """Write the first letter of a text as a capital, and all others as they are, such as those of names.

    Parameters
    ----------
    text : str
        A sentence or a name.

    Returns
    -------
    str
        The text with a capital at its beginning.

    Examples
    --------
    >>> begin_with_capital("engine A")
    'Engine A'
    """
    return text[:1].upper() + text[1:]


def count_noun(number: int, singular: str, plural: str = "") -> str:
    """Write a count with its noun.

    Parameters
    ----------
    number : int
        How many, dimensionless.
    singular, plural : str
        The noun; its plural is the singular with an s unless given.

    Returns
    -------
    str
        Number and noun.

    Examples
    --------
    >>> count_noun(1, "case"), count_noun(0, "case"), count_noun(3200, "mesh", "meshes")
    ('1 case', '0 cases', '3,200 meshes')
    """
    return f"{number:,} {singular if number == 1 else plural or singular + 's'}"


def _without_end_zeros(text: str) -> str:
    """Remove zeros at the end of the fraction of a decimal number, and its point if none is left."""
    return text.rstrip("0").rstrip(".") if "." in text else text
