"""What the analysis of a pair found, in one line each."""

from math import isfinite

from facegear.geometry.analysis import PairAnalysis
from facegear.geometry.jam import Jam


def jam_in_words(analysis: PairAnalysis, stuck: Jam) -> str:
    """Where and how deep bodies jam."""
    gap = analysis.interference
    assert gap is not None
    depth = f"by {1e6 * stuck.depth:.1f} um along the line of action"
    return (
        f"tooth_pair: the bodies jam {depth if isfinite(stuck.depth) else 'at every turn'}: at gear radius "
        f"{1e3 * gap.radius:.1f} mm the gear's {gap.gear_part} stands {-1e6 * gap.gap:.1f} um deep in the "
        f"pinion's {gap.pinion_part}, and the backlash leaves no room for that"
    )


def summary_in_words(analysis: PairAnalysis) -> str:
    """Contact ratio, backlash and smallest gap."""
    gap = analysis.interference or analysis.smallest
    verdict = "interference" if analysis.interference else "smallest gap"
    return (
        f"contact ratio {analysis.contact_ratio:.3f}, backlash {1e6 * analysis.backlash.min():.1f} um, "
        f"{verdict} {1e6 * gap.gap:.1f} um (gear {gap.gear_part} against pinion {gap.pinion_part}, "
        f"gear radius {1e3 * gap.radius:.1f} mm)"
    )
