"""Criteria on natural frequencies and mode classes; table `frequencies`."""

from facegear.number_format import count_noun
from paper.scorecard.outcome import ClaimOutcome, Tables, number, statement

EQUAL_HZ = 1e-6


def count_rigid(tables: Tables) -> ClaimOutcome:
    """Number of modes at exactly 0 Hz."""
    return number(int((tables["frequencies"]["frequency_hz"] == 0.0).sum()))


def frequency(tables: Tables, order: int) -> ClaimOutcome:
    """Natural frequency of an order, counted from 1."""
    frame = tables["frequencies"].set_index("order")
    return number(frame.loc[order, "frequency_hz"], 7)


def multiplicity(tables: Tables, order: int) -> ClaimOutcome:
    """Number of modes within 1e-6 Hz of an order's frequency."""
    values = tables["frequencies"].set_index("order")["frequency_hz"]
    return number(int((abs(values - values[order]) < EQUAL_HZ).sum()))


def mode_class(tables: Tables, orders: list[int], mode_class: str) -> ClaimOutcome:
    """The orders of a class, found from the mode shapes, are exactly the paper's."""
    frame = tables["frequencies"]
    orders_of_class = sorted(frame.loc[frame["class"] == mode_class, "order"].astype(int))
    return statement(orders_of_class == sorted(orders), f"orders {', '.join(map(str, orders_of_class))}")


def class_count(tables: Tables) -> ClaimOutcome:
    """Number of classes among the modes that are not rigid."""
    frame = tables["frequencies"]
    return number(int(frame.loc[frame["frequency_hz"] > 0.0, "class"].nunique()))


def coupled_share(tables: Tables, lower: float) -> ClaimOutcome:
    """More than the stated share of the elastic modes has bodies that both translate and rotate."""
    frame = tables["frequencies"]
    symbols = frame.loc[frame["frequency_hz"] > 0.0, "symbols"]
    coupled = symbols.str.contains(r"T(?:\([xy]\))?-R")
    return statement(coupled.mean() > lower, f"{coupled.sum()} of {count_noun(coupled.size, 'mode')}")
