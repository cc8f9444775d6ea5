"""Options of a contact analysis; light to import, so that configs need no solver."""

from dataclasses import dataclass
from typing import Literal

Ends = Literal["ring", "free", "clamped"]
CutFaces = Literal["free", "clamped"]
Element = Literal["hex27", "hex8", "tet4"]


@dataclass(frozen=True)
class Refinement:
    """How often the elements under the flank are cut: across the profile, along the width and in depth.

    `grading` is the ratio of neighbouring sizes in depth, the smallest at the surface.
    """

    profile: int = 1
    width: int = 1
    depth: int = 1
    grading: float = 1.0


@dataclass(frozen=True)
class Sector:
    """How much of each gear is modelled: all teeth (None) or so many, and what holds the cut faces then."""

    pinion_teeth: int | None = None
    face_gear_teeth: int | None = None
    cut_faces: CutFaces = "free"


@dataclass(frozen=True)
class ContactOptions:
    """Parts of the model that take part: fillets and tip lands as surfaces, coupling between neighbours,
    loads on tip edges.

    `path_only` leaves out the pairs that touch off the path of contact, where load bends teeth together.
    """

    fillet: bool = True
    is_coupled: bool = True
    edges: bool = True
    path_only: bool = False


@dataclass(frozen=True)
class ContactPlan:
    """Torques (N m, on the pinion, per mesh), positions a pitch, model and options.

    `root_stress`: whether the fillets carry gauges.
    """

    torques: tuple[float, ...]
    positions: int
    refinement: Refinement
    sector: Sector
    options: ContactOptions
    element: Element = "hex27"
    root_stress: bool = False
