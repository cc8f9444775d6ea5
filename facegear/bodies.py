"""Names of the two bodies of a tooth pair, in the order of every table and file."""

from typing import Literal

Body = Literal["pinion", "face_gear"]
BODIES: tuple[Body, ...] = ("pinion", "face_gear")
"""Names of the bodies of a pair, pinion first."""
