"""Matrices of Nastran: bulk data DMIG in small, large and free field, as EXTSEOUT(DMIGPCH) punches them."""

import re
from pathlib import Path

import numpy as np

from facegear.io.matrices.labelled_matrix import LabelledMatrix, MatrixFault, from_entries, read_lines

ONE_TRIANGLE = 6
"""IFO of a symmetric matrix, of which the file holds one triangle."""
SQUARE = 1
"""IFO of a square matrix, of which the file holds all entries."""
REAL = (1, 2)
"""TIN of real numbers, of single and double precision."""
NAMES = {
    "stiffness": ("KAAX", "KAA", "K2GG", "KGG", "STIFF"),
    "mass": ("MAAX", "MAA", "M2GG", "MGG", "MASS"),
    "damping": ("BAAX", "BAA", "B2GG", "BGG", "DAMP"),
}
"""Names of DMIG matrices that hold stiffness, mass and damping, first those of an external superelement."""


def read_dmig(path: Path, quantity: str) -> LabelledMatrix | None:
    """Read a matrix from a punch file.

    Scalar points have component 0 and are taken as modes, numbered by their points.

    Parameters
    ----------
    path : Path
        The file.
    quantity : str
        `stiffness`, `mass` or `damping`; matrices are found by NAMES, or one that is alone.

    Returns
    -------
    LabelledMatrix or None
        The matrix; None where the file holds none of that quantity.

    Raises
    ------
    MatrixFault
        For a file that is not valid.
    """
    cards: dict[str, list[list[str]]] = {}
    current: list[str] | None = None
    for line in read_lines(path):
        text = line.split("$")[0].rstrip()
        if not text.strip():
            continue
        fields = _fields(text)
        head = fields[0].upper()
        if head in ("DMIG", "DMIG*"):
            current = fields[1:]
            cards.setdefault(fields[1].upper(), []).append(current)
        elif current is not None and (head in ("", "*") or head[:1] in "+*"):
            current += fields[1:]
        else:
            current = None
    if not cards:
        raise MatrixFault("it holds no DMIG matrix")
    name = next((name for name in NAMES[quantity] if name in cards), None)
    if name is None:
        known_names = {other_name for names in NAMES.values() for other_name in names}
        unknown_names = [other_name for other_name in cards if other_name not in known_names]
        if quantity == "stiffness" and len(unknown_names) == 1 and len(cards) == 1:
            name = unknown_names[0]
        elif quantity == "stiffness":
            raise MatrixFault(f"it holds {', '.join(cards)}, but none of {', '.join(NAMES[quantity])}")
        else:
            return None
    return _matrix(name, cards[name])


def _fields(text: str) -> list[str]:
    """Return the fields of a line of bulk data: of 8 letters, of 16 where the first ends with *, or between
    commas. The continuation field at the end of a line is left out.
    """
    if "," in text:
        fields = [field.strip() for field in text.split(",")]
        return fields[:9] if not fields[0].endswith("*") else fields[:5]
    head = text[:8].strip()
    width, count = (16, 4) if head.endswith("*") else (8, 8)
    body = text[8 : 8 + width * count]
    return [head, *(body[k : k + width].strip() for k in range(0, max(len(body), 1), width))]


def _matrix(name: str, cards: list[list[str]]) -> LabelledMatrix:
    """Return one matrix from its cards, the header first: name, column node, component, blank, entries."""
    header = next((card for card in cards if _integer(card[1]) == 0 and len(card) > 2 and card[2]), None)
    if header is None or _integer(_field(header, 2)) not in (ONE_TRIANGLE, SQUARE):
        raise MatrixFault(
            f"matrix {name}: its first DMIG card must say that it is square (1) or symmetric (6)"
        )
    if _integer(_field(header, 3)) not in REAL:
        raise MatrixFault(f"matrix {name}: its entries are complex; a casing has real ones")
    rows, columns, values = [], [], []
    for card in cards:
        if card is header:
            continue
        column = _label(name, card[1], _field(card, 2))
        # A column card has an empty field before its first entry, and each entry of a large-field card one
        # behind it: node, component, value.
        entries = [field for field in card[3:] if field]
        if len(entries) % 3:
            raise MatrixFault(
                f"matrix {name}: column {card[1]} does not hold node, component and value in turn"
            )
        for node, component, value in zip(*[iter(entries)] * 3, strict=True):
            rows.append(_label(name, node, component))
            columns.append(column)
            values.append(_real(name, value))
    if not values:
        raise MatrixFault(f"matrix {name} has no entries")
    node, direction, matrix = from_entries(
        np.array(rows, np.int64),
        np.array(columns, np.int64),
        np.array(values),
        triangle=_integer(_field(header, 2)) == ONE_TRIANGLE,
    )
    is_scalar = direction == 0
    direction = np.where(is_scalar, np.cumsum(is_scalar), direction)
    return LabelledMatrix(np.where(is_scalar, 0, node), direction, matrix)


def _field(card: list[str], number: int) -> str:
    """Return a field of a card behind its name, counted from 0; empty beyond its end."""
    return card[number] if number < len(card) else ""


def _integer(text: str) -> int | None:
    """Return a whole number, None for any other text."""
    return int(text) if re.fullmatch(r"[+-]?\d+", text) else None


def _label(name: str, node: str, component: str) -> int:
    """Return `8 * node + component` of a row or column."""
    point, direction = _integer(node), _integer(component or "0")
    if point is None or direction is None or not 0 <= direction <= 6 or point < 1:
        raise MatrixFault(f"matrix {name}: {node!r}, {component!r} is no node and component from 0 to 6")
    return 8 * point + direction


def _real(name: str, text: str) -> float:
    """Return a real number as Nastran writes it: 1.5D+06, 1.5+6 and 1.5E6 are equal."""
    plain = re.sub(r"(?<=[\d.])([+-]\d+)$", r"E\1", text.upper().replace("D", "E"))
    try:
        return float(plain)
    except ValueError:
        raise MatrixFault(f"matrix {name}: {text!r} is no real number") from None
