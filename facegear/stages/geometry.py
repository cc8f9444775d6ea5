"""Exact geometry of the tooth pair: limits, contact path, backlash, smallest gaps."""

from facegear.config.tooth_pair import ToothPair, pair
from facegear.errors import FacegearError
from facegear.geometry.analysis import analyse
from facegear.geometry.document import contact_arrays, flank_arrays, pair_record
from facegear.geometry.easeoff import ease_off
from facegear.geometry.jam import jam
from facegear.geometry.words import jam_in_words, summary_in_words
from facegear.stages.outcome import Outcome

EASE_OFF_GRID = (37, 29)


def geometry(tooth_pair: ToothPair) -> Outcome:
    """Compute limits, contact path, backlash and smallest gaps of the tooth pair.

    Parameters
    ----------
    tooth_pair : ToothPair
        Section `tooth_pair` of the config.

    Returns
    -------
    Outcome
        Record `pair`, arrays `flanks` and `contact`.

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
