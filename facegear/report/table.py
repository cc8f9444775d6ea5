"""Tables of a report: columns, units in their names, and how cells are written."""

import base64
import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from math import isfinite

import numpy as np
import pandas as pd

from facegear.number_format import format_number

UNITS = {
    "kn": "kN",
    "n_per_um": "N/µm",
    "n_per_mm": "N/mm",
    "n_per_m": "N/m",
    "n_s_per_m": "N s/m",
    "n_m_per_rad": "N m/rad",
    "n_m": "N m",
    "rpm": "rpm",
    "deg": "deg",
    "mpa": "MPa",
    "hz": "Hz",
    "um": "µm",
    "mm": "mm",
    "kw": "kW",
    "kwh": "kWh",
    "kg_m2": "kg m2",
    "kg": "kg",
    "urad": "µrad",
    "percent": "%",
    "m_per_s": "m/s",
    "rad_per_s": "rad/s",
    "per_s": "1/s",
    "w_per_m": "W/m",
    "w_per_k": "W/K",
    "hours": "h",
    "w": "W",
    "k": "K",
    "c": "°C",
    "s": "s",
    "n": "N",
}
"""Units that end a column's name, as they are written; those that end another one stand after it."""
ENGINEERING = {"n_per_m": ("n_per_um", 1e-6, 0.0), "n": ("kn", 1e-3, 1e3), "w": ("kw", 1e-3, 1e3)}
"""Unit in which a table is written instead, its factor, and the largest number from which it is."""

UNNAMED = ("transmission", "tooth_pair", "dynamics", "contact", "load_sharing")
"""Sections whose keys say what they are without the section's name."""


def unit_of(name: str) -> str:
    """Return the unit in a column's name or a key of the config, as it is written.

    Parameters
    ----------
    name : str
        Name of the column, or the key.

    Returns
    -------
    str
        The unit, such as `N/µm`; empty where the name has none.
    """
    return UNITS.get(ending_of(name), "")


def ending_of(name: str) -> str:
    """Return the unit in a column's name, as it stands there: the first key of UNITS between `_` and
    the end or a blank.

    Parameters
    ----------
    name : str
        Name of the column.

    Returns
    -------
    str
        A key of UNITS, such as `n_per_um`; empty where the name has no unit.
    """
    return next((ending for ending in UNITS if f"_{ending} " in f"{name} "), "")


def value_in_words(key: str, value: object) -> str:
    """Write a changed key of the config with its value as a legend reads it.

    Parameters
    ----------
    key : str
        Dotted key of the config; its unit ends its name.
    value : object
        The value, in the unit of the key.

    Returns
    -------
    str
        Words, number and unit.

    Examples
    --------
    >>> value_in_words("transmission.backlash_um", 80)
    'backlash 80 µm'
    >>> value_in_words("mesh_stiffness.mean_n_per_m", 4.1e8)
    'mesh stiffness mean 410 N/µm'
    """
    parts = [part for part in key.split(".") if not part.isdigit()]
    key_parts = parts[1:] if parts[0] in UNNAMED and len(parts) > 1 else parts
    ending = next(filter(None, map(ending_of, reversed(key_parts))), "")
    words = " ".join(f"{part} ".replace(f"_{ending} ", " ").strip() for part in key_parts).replace("_", " ")
    if isinstance(value, bool) or not isinstance(value, int | float):
        return f"{words} {value}"
    unit, factor, least = ENGINEERING.get(ending, (ending, 1.0, 0.0))
    if least > 0.0:  # which depends on all numbers of a table
        unit, factor = ending, 1.0
    number = format_number(factor * value, 4)
    return f"{words} {number} {UNITS[unit]}" if unit else f"{words} {number}"


CAPTION_WORDS = 5
"""Words of a caption that name its file."""
PAPER_PT, COLUMN_GAP_PT, LETTER_WIDTH = 532.0, 8.0, 0.64
"""On A4: width of a table, room beside a column (pt), and the mean width of a letter in its height."""
PRINT_SIZES = (4.0, 8.0)
"""Smallest and largest size of letters in a printed table, in pt."""
LONG, LONG_COLUMN = 60, 22
"""Letters of a cell from which on a printed table may break it anywhere, and of a line of it then."""
ROUNDING = 1e-9
"""A number below this part of the largest one with its unit is zero but for rounding, and is written as 0."""
SHOWN_COLUMNS = 8
"""Columns of a table that are shown at once: as many as are read on 1280 px without scrolling sideways."""
EXACT = 12
"""Significant digits of the config's numbers."""


@dataclass(frozen=True)
class Table:
    """Rows under a caption.

    Attributes
    ----------
    caption : str
        What the rows are.
    frame : DataFrame
        The rows; a unit ends a column's name.
    digits : int
        Significant digits of numbers, dimensionless.
    is_folded : bool
        Whether a click opens the table.
    main : sequence of str
        Columns shown at once, in this order; the first SHOWN_COLUMNS if empty. A click shows the others.
    exact : bool
        Whether numbers stand as in a config: with all digits, ungrouped.
    """

    caption: str
    frame: pd.DataFrame
    digits: int = 4
    is_folded: bool = False
    main: Sequence[str] = ()
    exact: bool = False

    @cached_property
    def page_frame(self) -> pd.DataFrame:
        """Rows with the columns in the order of the page, `main` first, in the units of ENGINEERING
        unless `exact`.
        """
        main_columns = [name for name in self.main if name in self.frame]
        other_columns = [name for name in self.frame.columns if name not in main_columns]
        table = self.frame[[*main_columns, *other_columns]] if main_columns else self.frame
        return table if self.exact else _engineering(table)

    def on_demand(self) -> list[bool]:
        """Return for each column of `page_frame` whether a click is needed to show it.

        With more than SHOWN_COLUMNS columns these are all behind `main`, or behind SHOWN_COLUMNS.

        Returns
        -------
        list of bool
            One flag a column.
        """
        main = sum(name in self.frame for name in self.main) or SHOWN_COLUMNS
        columns = len(self.frame.columns)
        return [columns > SHOWN_COLUMNS and at >= min(main, SHOWN_COLUMNS) for at in range(columns)]

    def header(self) -> list[str]:
        """Return column names as words, with their units as they are written.

        Returns
        -------
        list of str
            One text for each column of `page_frame`.
        """
        return [words(str(name)) for name in self.page_frame.columns]

    def numeric(self) -> list[bool]:
        """Return for each column whether it holds numbers.

        Returns
        -------
        list of bool
            One flag for each column of `page_frame`; truth values are no numbers.
        """
        return [
            pd.api.types.is_numeric_dtype(kind) and not pd.api.types.is_bool_dtype(kind)
            for kind in self.page_frame.dtypes
        ]

    def rows(self) -> list[list[str]]:
        """Return the cells as text.

        Returns
        -------
        list of list of str
            Row by row, in the columns of `page_frame`; numbers with `digits`, missing values blank.
        """
        units = [ending_of(str(name)) for name in self.page_frame.columns]
        largest = {unit: self._largest(unit, units) for unit in set(units)}
        zero = [ROUNDING * largest[unit] for unit in units]
        return [
            [self._cell(*cell) for cell in zip(row, zero, strict=True)]
            for row in self.page_frame.itertuples(index=False)
        ]

    def print_pt(self) -> float:
        """Return the largest size of letters at which no word or number is broken on A4, estimated by
        LETTER_WIDTH.

        Returns
        -------
        float
            Size within PRINT_SIZES, in points of 0.353 mm.
        """
        cells = [self.header(), *self.rows()]
        longest = [
            max((_longest_word(text) for text in column), default=1) for column in zip(*cells, strict=True)
        ]
        free_width = PAPER_PT - COLUMN_GAP_PT * len(longest)
        return round(float(np.clip(free_width / (LETTER_WIDTH * sum(longest)), *PRINT_SIZES)), 2)

    def csv_name(self, chapter: str) -> str:
        """Return the name of the file in which a reader keeps the table.

        Parameters
        ----------
        chapter : str
            Anchor of the chapter.

        Returns
        -------
        str
            Anchor and first CAPTION_WORDS words of the caption, with the ending csv.
        """
        caption_words = re.findall(r"[a-z0-9]+", self.caption.lower())[:CAPTION_WORDS]
        return f"{chapter}-{'-'.join(caption_words)}.csv"

    def csv_uri(self) -> str:
        """Return `frame`, in its own units and with all digits, as csv.

        Returns
        -------
        str
            A data URI.
        """
        text = self.frame.to_csv(index=False)
        return f"data:text/csv;base64,{base64.b64encode(text.encode()).decode()}"

    def _largest(self, unit: str, units: Sequence[str]) -> float:
        """Return the largest finite magnitude in all columns of floats with a unit; 0 for an empty unit
        or no numbers. `units`: key of UNITS of each column, empty for none.
        """
        columns = [self.page_frame.iloc[:, i] for i, ending in enumerate(units) if unit and ending == unit]
        floats = [column for column in columns if pd.api.types.is_float_dtype(column)]
        sizes = [column[np.isfinite(column)].abs().max() for column in floats]
        return max((float(size) for size in sizes if isfinite(size)), default=0.0)

    def _cell(self, value: object, zero: float) -> str:
        """Return a value as text of a cell: yes or no, blank for None and nan, numbers with `digits`. A
        float below `zero` in magnitude is written as 0.
        """
        if isinstance(value, bool | np.bool_):
            return "yes" if value else "no"
        if value is None or value != value:
            return ""
        if isinstance(value, int | np.integer):
            return str(value) if self.exact else f"{value:,}"
        if not isinstance(value, float):
            return "face gear" if value == "face_gear" else str(value)
        number = 0.0 if abs(value) < zero else value
        return format_number(number, EXACT if self.exact else self.digits, group_digits=not self.exact)


def _engineering(table: pd.DataFrame) -> pd.DataFrame:
    """Return a table whose columns of floats in N, N/m and W are in the larger units of ENGINEERING,
    with new names, if the largest magnitude of all columns in that unit reaches the limit given there.
    """
    columns_scaled, names = {}, {}
    for name in table.columns:
        ending = ending_of(str(name))
        if ending not in ENGINEERING or not pd.api.types.is_float_dtype(table[name]):
            continue
        larger_unit, factor, least = ENGINEERING[ending]
        columns = [column for column in table.columns if ending_of(str(column)) == ending]
        numbers = table[columns].select_dtypes("number").to_numpy(float)
        largest = np.abs(numbers[np.isfinite(numbers)]).max(initial=0.0)
        if largest >= least:
            columns_scaled[name] = factor * table[name]
            names[name] = f"{name} ".replace(f"_{ending} ", f"_{larger_unit} ").rstrip()
    return table.assign(**{str(name): column for name, column in columns_scaled.items()}).rename(
        columns=names
    )


def words(name: str) -> str:
    """Return a column's name as words, with its unit as it is written.

    Parameters
    ----------
    name : str
        Name of the column, whose unit is its end.

    Returns
    -------
    str
        Words and the unit in brackets, such as `force as assembled (N)`.
    """
    ending = ending_of(name)
    return (
        (f"{name} ".replace(f"_{ending} ", f" ({UNITS[ending]}) ") if ending else name)
        .replace("_", " ")
        .strip()
    )


def _longest_word(text: str) -> int:
    """Return the number of letters of the longest part of a cell that a printed table does not break: a
    word, with a unit in brackets; LONG_COLUMN for cells of more than LONG letters.
    """
    return (
        LONG_COLUMN if len(text) > LONG else max((len(word) for word in unbroken(text).split(" ")), default=0)
    )


def unbroken(text: str) -> str:
    """Return text in which the unit `(N m)` is not broken between lines.

    Parameters
    ----------
    text : str
        Any text.

    Returns
    -------
    str
        The text with a space in that unit that does not break.
    """
    return re.sub(r"\(N m\)", "(N\u00a0m)", text)
