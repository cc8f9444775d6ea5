"""A machine in short for the terminal: status, key numbers, verdicts and gear data of what is known."""

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Never

from facegear.pipeline.reported import REPORT_TABLES, asked_for, table_name
from facegear.pipeline.table import STAGES
from facegear.report.data_sheet import DATA_SHEET, data_sheet_table
from facegear.report.first_screen import found_in_words, key_cards
from facegear.report.verdicts import status_line, verdicts
from facegear.results.chain import Chain

if TYPE_CHECKING:
    import pandas as pd


def summary_text(chain: Chain) -> str:
    """Write what is known of a machine as lines for the terminal.

    Parameters
    ----------
    chain : Chain
        The stages of the machine. The geometry of the teeth is computed if it is not known, nothing else is.

    Returns
    -------
    str
        Status, key numbers, verdicts with their reasons, and gear data.
    """
    has_bodies = chain.values["tooth_pair"]["pinion"] is not None
    pair = chain.part("geometry", "pair") if has_bodies else None
    tables = dict(_known_tables(chain))
    judgements = verdicts(chain.values, tables, pair)
    _, first, sentence = status_line(judgements, found_in_words(tables))
    keys = [
        (card.name, card.value, f"({card.beside})" if card.beside else "")
        for card in key_cards(chain.values, tables, pair)
    ]
    reasons = [
        (
            verdict.colour,
            verdict.subject,
            " ".join([verdict.reason, *(f"[{mark}]" for mark in verdict.caveats)]),
        )
        for verdict in judgements
    ]
    head = f"{chain.values['case']}. {first} {sentence}"
    parts = [head, "\n".join(_align_columns(keys)), "\n".join(_align_columns(reasons))]
    if pair is not None:
        rows = data_sheet_table(pair)
        sheet = [tuple(rows.columns), *rows.itertuples(index=False, name=None)]
        parts.append("\n".join([f"{DATA_SHEET}:", *_align_columns(sheet)]))
    return "\n\n".join(parts)


def _known_tables(chain: Chain) -> "Iterator[tuple[str, pd.DataFrame]]":
    """Yield the tables of the report that were computed in this session or are stored and current."""
    for name, files in REPORT_TABLES.items():
        if not asked_for(name, chain.case):
            continue
        try:
            content: Mapping[str, Any] = chain.store.output(name, chain.values, _refuse_to_compute).content
        except _NotKnownError:
            continue
        for file in files:
            yield table_name(STAGES[name].files[file].path), content[file].reset_index(drop=True)


class _NotKnownError(Exception):
    """Raised for a stage whose results are not known."""


def _refuse_to_compute() -> Never:
    raise _NotKnownError


def _align_columns(rows: Sequence[tuple[str, ...]]) -> list[str]:
    """Return rows of text with their columns below each other."""
    widths = [max(len(cell) for cell in column) for column in zip(*rows, strict=True)]
    return [
        "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows
    ]
