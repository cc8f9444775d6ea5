"""Largest values among equals: left and right twins of a machine differ by rounding alone.

Which of them is largest would else depend on the processor, and with it the name in a table or message.
"""

from typing import Any

import numpy as np
import pandas as pd

from facegear.arrays import Array, Integers

TIE = 1e-4
"""Relative difference from the largest value up to which a value counts as equally large."""


def first_largest(values: Array) -> int:
    """Find the first of the values that are as large as the largest, within TIE relative to it.

    Parameters
    ----------
    values : (n,)
        Numbers of one unit; NaN counts as smaller than all others.

    Returns
    -------
    int
        Position of the value, from 0 to n - 1.
    """
    return int(np.flatnonzero(values >= _smallest_tie(np.nanmax(values)))[0])


def first_largest_row(table: pd.DataFrame, column: str) -> pd.Series:
    """Find the first row of a table whose number is as large as the largest of its column, within TIE
    relative to it.

    Parameters
    ----------
    table : DataFrame
        At least one row, of any units.
    column : str
        Name of a column of numbers.

    Returns
    -------
    Series
        The row, in the units of the table.
    """
    return table.iloc[first_largest(table[column].to_numpy(float))]


def first_largest_rows(table: pd.DataFrame, column: str, keys: list[str], sort: bool = False) -> pd.DataFrame:
    """Find the first row of each group whose number is as large as the largest of its group.

    Parameters
    ----------
    table : DataFrame
        Rows of any units.
    column : str
        Name of a column of numbers.
    keys : list of str
        Columns whose values are equal within a group.
    sort : bool
        Whether groups come in the order of their keys, not of their appearance.

    Returns
    -------
    DataFrame
        One row for each group, in the units of the table.
    """
    largest = table.groupby(keys, sort=sort)[column].transform("max")
    levelled = table[column].mask(table[column] >= _smallest_tie(largest), largest)
    return table.loc[levelled.groupby([table[key] for key in keys], sort=sort).idxmax()]


def size_ranks(values: Array) -> Integers:
    """Rank numbers by size, 0 for the largest; numbers within TIE of the largest of a rank share it.

    Parameters
    ----------
    values : (n,)
        Finite numbers of one unit; their signs do not count.

    Returns
    -------
    (n,) array of int
        Rank of each. A stable sort by it keeps the order of twins, whatever rounding makes of them.
    """
    sizes, ranks = np.abs(values), np.zeros(len(values), dtype=np.int64)
    largest, rank = np.inf, -1
    for row in np.argsort(-sizes, kind="stable"):
        if rank < 0 or sizes[row] < _smallest_tie(largest):
            largest, rank = sizes[row], rank + 1
        ranks[row] = rank
    return ranks


def _smallest_tie(largest: Any) -> Any:
    """Return the smallest number that counts as equal to `largest`: largest - TIE abs(largest), for numbers
    or arrays.
    """
    return largest - TIE * abs(largest)
