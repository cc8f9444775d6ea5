"""Stages of the exact geometry of the tooth pair, and of the topography of its flanks."""

import pandas as pd

from facegear.build.tooth_pair import ToothPair, pair
from facegear.errors import FacegearError
from facegear.exchange.flank_table import flank_table
from facegear.pipeline.outcome import Outcome
from facegear.teeth.analysis import analyse, jam, jam_in_words, summary_in_words
from facegear.teeth.document import contact_arrays, ease_off, flank_arrays, pair_record

EASE_OFF_GRID = (37, 29)
"""Points along profile and width of the separation's map; only the drawing depends on it."""


def geometry(tooth_pair: ToothPair) -> Outcome:
    """Compute limits, contact path, backlash and smallest gaps of the unloaded tooth pair.

    Parameters
    ----------
    tooth_pair : ToothPair
        Section `tooth_pair` of the config.

    Returns
    -------
    Outcome
        Record `pair` (a nested mapping of numbers, units in their names), arrays `flanks` (points of
        both flanks) and `contact` (contact path, and the gaps around it, EASE_OFF_GRID).

    Raises
    ------
    ConfigError
        For a pair without bodies.
    FacegearError
        For bodies that jam.
    """
    design = pair(tooth_pair).design
    analysis = analyse(design)
    stuck = jam(design, analysis)
    if stuck is not None:
        raise FacegearError(jam_in_words(analysis, stuck))
    contours = ease_off(design, float(analysis.drive.transmission_error.mean()), EASE_OFF_GRID)
    content = {
        "pair": pair_record(design, analysis),
        "flanks": flank_arrays(design),
        "contact": contact_arrays(design, analysis, contours),
    }
    return Outcome(content, summary_in_words(analysis))


def topography(tooth_pair: ToothPair) -> Outcome:
    """Tabulate the deviation of both flanks of both gears from the nominal flanks, as the config gives
    it.

    Parameters
    ----------
    tooth_pair : ToothPair
        Section `tooth_pair` of the config.

    Returns
    -------
    Outcome
        Table `points`: nominal points (mm) and unit normals of both flanks of both gears, and the mean
        deviation of all teeth there, um. `TopographyResult.table` lists the columns.

    Raises
    ------
    ConfigError
        For a pair without bodies.
    """
    table = flank_table(tooth_pair)
    largest = table.groupby("body", sort=False)["deviation_um"].agg(lambda part: part.abs().max())
    deviations = ", ".join(f"{body.replace('_', ' ')} {value:.3g} um" for body, value in largest.items())
    return Outcome({"points": pd.DataFrame(table)}, f"largest deviation: {deviations}")
