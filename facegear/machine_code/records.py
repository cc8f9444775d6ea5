"""NamedTuples that compiled functions hand over by their address."""

from abc import ABC


class Record(ABC):  # noqa: B024
    """Registered here is a NamedTuple of many arrays and numbers, which compiled functions only read.

    As numba takes any other NamedTuple, each call hands over every word of every field: with a hundred arrays
    these are hundreds, and most of what is compiled is their way from function to function.
    Arrays stay the caller's: what a function returns are copies.
    """
