"""What e(t) does from mesh to mesh: the readings of the paper, and all patterns of half turns."""

import itertools
from collections.abc import Mapping
from types import MappingProxyType

Phasing = str | Mapping[str, float]
"""Value of the config key transmission.transmission_error.phasing."""

HALF_TURN = 0.5
CLASSES = ("tail/lower", "idler/lower", "input/lower", "idler/upper", "input/upper")
"""Meshes that a left-right symmetric pattern treats alike, but for tail/upper, the reference."""

READINGS: Mapping[str, Phasing] = MappingProxyType(
    {
        "in_step": "in_step",
        "mesh": "mesh",
        "back_flank": {"tail/lower": HALF_TURN, "idler/lower": HALF_TURN},
    }
)
"""What a reader of the paper may take e(t) to do: the same everywhere, shifted like k(t), or half a turn
later where a pinion drives with its back flank.
"""
READING_PATTERNS = (
    "none",
    "tail/lower+idler/upper+input/upper",
    "tail/lower+idler/lower+input/lower+idler/upper+input/upper",
    "tail/lower+idler/lower",
)
"""The readings as patterns of half turns: in step, shifted like k(t) by equation (11) as gears have it and as
printed, and reversed at the back flanks.
"""


def phasing_of(pattern: str) -> Phasing:
    """Value of the config's key for a pattern or a reading by its name. Raises KeyError."""
    return {**READINGS, **half_turn_patterns()}[pattern]


def half_turn_patterns() -> dict[str, Phasing]:
    """The 32 left-right symmetric patterns of half turns over the meshes that differ, by name.

    Half a turn at every mesh is a change of the phase of e(t), so one mesh, tail/upper, stays the reference.
    """
    choices = itertools.product((False, True), repeat=len(CLASSES))
    turned = [[name for name, turn in zip(CLASSES, choice, strict=True) if turn] for choice in choices]
    return {"+".join(names) or "none": dict.fromkeys(names, HALF_TURN) for names in turned}
