"""Flanks as measured or as prescribed, beside nominal points and normals."""

import pandas as pd

from facegear.config.flank_table import flank_table
from facegear.config.tooth_pair import ToothPair
from facegear.stages.outcome import Outcome


def topography(tooth_pair: ToothPair) -> Outcome:
    """Tabulate the deviation of the flanks of both gears.

    Parameters
    ----------
    tooth_pair : ToothPair
        Section `tooth_pair` of the config.

    Returns
    -------
    Outcome
        Table `points`: nominal points and normals of both flanks of both gears, and the mean deviation of all
        teeth there.

    Raises
    ------
    ConfigError
        For a pair without bodies.
    """
    table = flank_table(tooth_pair)
    largest = table.groupby("body", sort=False)["deviation_um"].agg(lambda part: part.abs().max())
    deviations = ", ".join(f"{body.replace('_', ' ')} {value:.3g} um" for body, value in largest.items())
    return Outcome({"points": pd.DataFrame(table)}, f"largest deviation: {deviations}")
