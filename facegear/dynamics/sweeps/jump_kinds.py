"""Kinds of abrupt changes in a sweep, apart from what finds them, so that readers need no solver."""

from enum import StrEnum


class JumpKind(StrEnum):
    """What an abrupt change of the response between two speeds is.

    JUMP: the periodic motion before it ends or loses its stability there, and another periodic one follows.
    STEP: the sweep left a periodic motion that is stable at both speeds, because its step was too large.
    IRREGULAR: the motion on one side is not periodic.
    """

    JUMP = "jump"
    STEP = "step"
    IRREGULAR = "irregular"
