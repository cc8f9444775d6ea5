"""Exact geometry of the tooth pair: limits, contact path, backlash, smallest gaps."""

from math import isfinite

from facegear.config.tooth_pair import ToothPair, pair
from facegear.errors import FacegearError
from facegear.geometry.analysis import PairAnalysis, analyse
from facegear.geometry.document import contact_arrays, flank_arrays, pair_record
from facegear.geometry.easeoff import ease_off
from facegear.geometry.jam import Jam, jam
from facegear.stages.outcome import Outcome

EASE_OFF_GRID = (37, 29)


def geometry(tooth_pair: ToothPair) -> Outcome:
    """`pair` (record), `flanks` and `contact` (arrays). Raises ConfigError for a pair without bodies,
    FacegearError for bodies that jam.
    """
    design = pair(tooth_pair).design
    analysis = analyse(design)
    stuck = jam(design, analysis)
    if stuck is not None:
        raise FacegearError(_jammed(analysis, stuck))
    contours = ease_off(design, float(analysis.drive.transmission_error.mean()), EASE_OFF_GRID)
    content = {
        "pair": pair_record(design, analysis),
        "flanks": flank_arrays(design),
        "contact": contact_arrays(design, analysis, contours),
    }
    return Outcome(content, _summary(analysis))


def _jammed(analysis: PairAnalysis, stuck: Jam) -> str:
    gap = analysis.interference
    assert gap is not None
    depth = f"by {1e6 * stuck.depth:.1f} um along the line of action"
    return (
        f"tooth_pair: the bodies jam {depth if isfinite(stuck.depth) else 'at every turn'}: at gear radius "
        f"{1e3 * gap.radius:.1f} mm the gear's {gap.gear_part} stands {-1e6 * gap.gap:.1f} um deep in the "
        f"pinion's {gap.pinion_part}, and the backlash leaves no room for that"
    )


def _summary(analysis: PairAnalysis) -> str:
    gap = analysis.interference or analysis.smallest
    verdict = "interference" if analysis.interference else "smallest gap"
    return (
        f"contact ratio {analysis.contact_ratio:.3f}, backlash {1e6 * analysis.backlash.min():.1f} um, "
        f"{verdict} {1e6 * gap.gap:.1f} um (gear {gap.gear_part} against pinion {gap.pinion_part}, "
        f"gear radius {1e3 * gap.radius:.1f} mm)"
    )
