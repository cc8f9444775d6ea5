"""Exact geometry of the tooth pair: limits, contact path, backlash, smallest gaps."""

from collections.abc import Mapping
from typing import Any

from facegear.config.tooth_pair import pair
from facegear.geometry.analysis import PairAnalysis, analyse
from facegear.geometry.document import contact_arrays, flank_arrays, pair_record
from facegear.geometry.easeoff import ease_off
from facegear.stages.outcome import Outcome

EASE_OFF_GRID = (37, 29)


def geometry(tooth_pair: Mapping[str, Any]) -> Outcome:
    """`pair` (record), `flanks` and `contact` (arrays). Raises ConfigError for a pair without bodies."""
    design = pair(tooth_pair).design
    analysis = analyse(design)
    contours = ease_off(design, float(analysis.drive.transmission_error.mean()), EASE_OFF_GRID)
    content = {
        "pair": pair_record(design, analysis),
        "flanks": flank_arrays(design),
        "contact": contact_arrays(design, analysis, contours),
    }
    return Outcome(content, _summary(analysis))


def _summary(analysis: PairAnalysis) -> str:
    gap = analysis.interference or analysis.smallest
    verdict = "interference" if analysis.interference else "smallest gap"
    return (
        f"contact ratio {analysis.contact_ratio:.3f}, backlash {1e6 * analysis.backlash.min():.1f} um, "
        f"{verdict} {1e6 * gap.gap:.1f} um (gear {gap.gear_part} against pinion {gap.pinion_part}, "
        f"gear radius {1e3 * gap.radius:.1f} mm)"
    )
