"""Criteria on natural frequencies and mode classes; table `frequencies`."""

from facegear.number_format import count_noun
from paper.scorecard.outcome import ClaimOutcome, Tables, number, statement

EQUAL_HZ = 1e-6


def count_rigid(tables: Tables) -> ClaimOutcome:
    """Number of modes at exactly 0 Hz.

    Parameters
    ----------
    tables : Tables
        Stored results by name.

    Returns
    -------
    ClaimOutcome
        The number, in the unit of the claim.
    """
    return number(int((tables["frequencies"]["frequency_hz"] == 0.0).sum()))


def frequency(tables: Tables, order: int) -> ClaimOutcome:
    """Natural frequency of an order, counted from 1.

    Parameters
    ----------
    tables : Tables
        Stored results by name.
    order : int
        Order of the mode, from 1.

    Returns
    -------
    ClaimOutcome
        The number, in the unit of the claim.
    """
    frame = tables["frequencies"].set_index("order")
    return number(frame.loc[order, "frequency_hz"], 7)


def multiplicity(tables: Tables, order: int) -> ClaimOutcome:
    """Number of modes within 1e-6 Hz of an order's frequency.

    Parameters
    ----------
    tables : Tables
        Stored results by name.
    order : int
        Order of the mode, from 1.

    Returns
    -------
    ClaimOutcome
        The number, in the unit of the claim.
    """
    values = tables["frequencies"].set_index("order")["frequency_hz"]
    return number(int((abs(values - values[order]) < EQUAL_HZ).sum()))


def mode_class(tables: Tables, orders: list[int], mode_class: str) -> ClaimOutcome:
    """The orders of a class, found from the mode shapes, are exactly the paper's.

    Parameters
    ----------
    tables : Tables
        Stored results by name.
    orders : list[int]
        The paper's orders of the class.
    mode_class : str
        Name of the class.

    Returns
    -------
    ClaimOutcome
        Whether the statement holds, with the evidence.
    """
    frame = tables["frequencies"]
    orders_of_class = sorted(frame.loc[frame["class"] == mode_class, "order"].astype(int))
    return statement(orders_of_class == sorted(orders), f"orders {', '.join(map(str, orders_of_class))}")


def class_count(tables: Tables) -> ClaimOutcome:
    """Number of classes among the modes that are not rigid.

    Parameters
    ----------
    tables : Tables
        Stored results by name.

    Returns
    -------
    ClaimOutcome
        The number, in the unit of the claim.
    """
    frame = tables["frequencies"]
    return number(int(frame.loc[frame["frequency_hz"] > 0.0, "class"].nunique()))


def coupled_share(tables: Tables, lower: float) -> ClaimOutcome:
    """More than the stated share of the elastic modes has bodies that both translate and rotate.

    Parameters
    ----------
    tables : Tables
        Stored results by name.
    lower : float
        The stated share, 0 to 1.

    Returns
    -------
    ClaimOutcome
        Whether the statement holds, with the evidence.
    """
    frame = tables["frequencies"]
    symbols = frame.loc[frame["frequency_hz"] > 0.0, "symbols"]
    is_coupled = symbols.str.contains(r"T(?:\([xy]\))?-R")
    return statement(
        is_coupled.mean() > lower, f"{is_coupled.sum()} of {count_noun(is_coupled.size, 'mode')}"
    )
