"""Load sharing of one machine at one speed."""

from collections.abc import Mapping
from typing import Any

import pandas as pd

from facegear.config.base import parse
from facegear.config.dynamics import Accuracy, settings
from facegear.config.load_sharing import LoadSharing, sharing_options
from facegear.config.machines import wired_machine
from facegear.load_sharing.run import load_sharing as shared
from facegear.load_sharing.tables import curve_table, summary_table
from facegear.stages.outcome import Outcome


def load_sharing(
    harmonics: pd.DataFrame,
    transmission: Mapping[str, Any],
    teeth: Mapping[str, Any],
    accuracy: Mapping[str, Any],
    speed_rpm: float,
    options: Mapping[str, Any],
    friction: pd.DataFrame | None = None,
) -> Outcome:
    """`curve` and `summary` (tables). Raises NotConverged naming the speed."""
    found = shared(
        wired_machine(transmission, teeth, harmonics, friction=friction),
        speed_rpm,
        settings(parse(Accuracy, accuracy)),
        sharing_options(parse(LoadSharing, options)),
    )
    summary = summary_table(found)
    means = ", ".join(f"{row.group} {row.mean:.3f}" for row in summary.itertuples())
    return Outcome(
        {"curve": curve_table(found), "summary": summary},
        f"{found.response.label}; mean coefficients: {means or 'no meshes share a load'}",
    )
