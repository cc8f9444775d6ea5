"""Kinds of abrupt changes in a sweep, apart from what finds them, so that readers need no solver."""

from enum import StrEnum


class JumpKind(StrEnum):
    """Kind of an abrupt change of the response between two speeds.

    JUMP: the periodic motion before it ends or loses its stability there, and another periodic one follows.
    STEP: another periodic motion follows, but no loss of stability was found: the sweep left a motion that is
    stable at both speeds, because its step was too large, or the orbit could not be followed.
    IRREGULAR: the motion on one side is not periodic.
    """

    JUMP = "jump"
    STEP = "step"
    IRREGULAR = "irregular"
