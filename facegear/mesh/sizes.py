"""How fine a mesh is: three lengths, and the named resolutions."""

from dataclasses import dataclass


@dataclass(frozen=True)
class MeshSizes:
    """Element sizes (m). Quadratic elements carry nodes at half these distances.

    profile: along the flank's profile at its surface; width: along the face; thickness: largest size inside
    the tooth and the body below it. Between surface and inside the mesh coarsens three to one per level.
    fillet: along the fillet's profile, None as along the flank's.
    """

    profile: float
    width: float
    thickness: float
    fillet: float | None = None


RESOLUTIONS = {
    "coarse": (0.20, 0.64, 0.60),
    "medium": (0.10, 0.40, 0.40),
    "fine": (0.05, 0.27, 0.32),
    "finest": (0.027, 0.16, 0.27),
}
"""Profile, width and thickness in modules: at m = 3.75 mm the finest resolves 0.1 mm across the profile."""


def named_sizes(name: str, module: float) -> MeshSizes:
    """Sizes of a named resolution for a module (m). Raises KeyError for an unknown name."""
    profile, width, thickness = RESOLUTIONS[name]
    return MeshSizes(profile * module, width * module, thickness * module)
