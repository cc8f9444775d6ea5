"""Largest values among equals: left and right twins of a machine differ by rounding alone.

Which of them is largest would else depend on the processor, and with it the name in a table or message.
"""

from typing import Any

import numpy as np
import pandas as pd

from facegear.arrays import Array

TIE = 1e-4
"""Relative difference from the largest value up to which a value counts as equally large."""


def first_largest(values: Array) -> int:
    """Position of the first of values (n,) that are as large as the largest; NaN counts as smaller."""
    return int(np.flatnonzero(values >= _least_tied(np.nanmax(values)))[0])


def first_largest_row(table: pd.DataFrame, column: str) -> pd.Series:
    """Row of a table whose number in a column is as large as the largest, the first of several."""
    return table.iloc[first_largest(table[column].to_numpy(float))]


def first_largest_rows(table: pd.DataFrame, column: str, keys: list[str], sort: bool = False) -> pd.DataFrame:
    """One row for each group of `keys`, the first as large as its largest, in the order of appearance or,
    with `sort`, of the keys.
    """
    grouped = table.groupby(keys, sort=sort)[column]
    tied = table[column] >= _least_tied(grouped.transform("max"))
    levelled = table[column].mask(tied, grouped.transform("max"))
    return table.loc[levelled.groupby([table[key] for key in keys], sort=sort).idxmax()]


def _least_tied(largest: Any) -> Any:
    """Smallest number that counts as equal to the largest, of numbers or arrays of them."""
    return largest - TIE * abs(largest)
