"""The machine code of a contact, compiled once for all processes that start together."""

from functools import cache

import numpy as np

from facegear.contact.averages import HatPoints
from facegear.contact.bodies.surface import areas_at, face_functions
from facegear.contact.fillet_contact import kept_hats
from facegear.contact.flanks import PinionPoints
from facegear.contact.influence import Surface
from facegear.contact.loads import EdgePoints, gathered
from facegear.contact.solver import NEWTON_STEPS, TOLERANCE
from facegear.contact.spreading import Faces
from facegear.contact.strip_of_hats import Strip
from facegear.contact.touching import Cover, Facing, touching

NONE, NUMBERS, MARKS, BEGIN = np.zeros(0), np.zeros(0, np.int64), np.zeros(0, bool), np.zeros(1, np.int64)
PLACES, RAYS = np.zeros((0, 2)), np.zeros((0, 3))
FOUR = np.zeros((0, 4), np.int64), np.zeros((0, 4))


@cache
def prepare() -> None:
    """Load the stored machine code of a contact, or compile and store it while others wait.

    Nothing is set against nothing: the types are those of any pair.
    """
    _touch()
    _gather()
    face_functions(PLACES, (3, 3))
    areas_at(RAYS, np.zeros((0, 9), np.int64), np.zeros((0, 9, 2)), NONE)
    kept_hats(NUMBERS, NUMBERS, MARKS, NONE, 0.0)


def _touch() -> None:
    """No point of either tooth faces the other."""
    faces = Faces((1, 1), (1, 1), np.zeros((1, 2), np.int64))
    surface = Surface(faces, (BEGIN, NUMBERS, NONE), np.zeros((1, 1)), np.zeros((1, 1, 1)), 1.0)
    touching(
        Facing(HatPoints(NONE, NONE, PLACES, PLACES, *FOUR, NONE), BEGIN, NUMBERS),
        Cover(NONE, 0, (1, 1), (0.0, 0.0)),
        (surface, surface),
        np.ones(1),
        1.0,
        Strip(1.0, 1.0, 1.0, 1.0, 1.0, np.zeros((0, 0), bool)),
        True,
        (NEWTON_STEPS, TOLERANCE),
    )


def _gather() -> None:
    """No points of no pairs."""
    points = PinionPoints(RAYS, RAYS, PLACES, NONE, *FOUR, NONE)
    under = np.zeros((0, 2), np.int64), PLACES
    edge = EdgePoints(np.zeros((0, 0)), np.zeros((0, 0)), np.zeros((0, 0, 2)), PLACES, *under)
    gathered(points, 0, (NUMBERS, BEGIN, NONE, PLACES), edge)
