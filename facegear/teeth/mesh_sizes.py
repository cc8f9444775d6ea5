"""Element sizes of a mesh: three lengths, separate sizes at the fillet, and the named resolutions."""

from dataclasses import dataclass, replace


@dataclass(frozen=True)
class MeshSizes:
    """Element sizes (m).

    Attributes
    ----------
    profile
        Along the flank's profile at its surface.
    width
        Along the face.
    thickness
        Largest size inside the tooth and the body below it. Between surface and inside the mesh coarsens
        three to one per level.
    fillet
        Along the lower half of the fillet's profile, None as along the flank's.
    fillet_depth
        Of the first row of elements below the fillet, down to half of it below a sharp one; the second row is
        at most twice as deep. None as below the flank.
    second_row
        Depth of a second row as fine along the profile as the surface, before the mesh coarsens inwards; None
        where it coarsens below the first.
    """

    profile: float
    width: float
    thickness: float
    fillet: float | None = None
    fillet_depth: float | None = None
    second_row: float | None = None


RESOLUTIONS = {
    "coarse": (0.20, 0.64, 0.60),
    "medium": (0.10, 0.40, 0.40),
    "fine": (0.05, 0.27, 0.32),
    "finest": (0.027, 0.16, 0.27),
}
"""Profile, width and thickness in modules: at m = 3.75 mm the finest resolves 0.1 mm across the profile."""

THIN_ROW, SECOND_ROW = 0.4, 0.5
"""First row below the fillet where stress is read and the row after it, in `profile`, of the named
resolutions; from convergence (docs/explanation/strength.md)."""
OWN_ROW = 0.8
"""First row below the fillet of sizes of one's own."""
THIN_COLUMN = 0.5
"""Elements along the lower half of that fillet, in `profile`."""


def thin_fillet(sizes: MeshSizes, name: str = "") -> MeshSizes:
    """Return sizes with thin elements at the fillet, as root stress needs; given fillet sizes stay.

    Parameters
    ----------
    sizes : MeshSizes
        Element sizes.
    name : str
        Key of RESOLUTIONS from which the sizes came; empty for sizes that were given as lengths.

    Returns
    -------
    MeshSizes
        Element sizes, m.
    """
    return replace(
        sizes,
        fillet=sizes.fillet or THIN_COLUMN * sizes.profile,
        fillet_depth=sizes.fillet_depth or (THIN_ROW if name else OWN_ROW) * sizes.profile,
        second_row=SECOND_ROW * sizes.profile if name else sizes.second_row,
    )


def named_sizes(name: str, module: float) -> MeshSizes:
    """Return the sizes of a named resolution.

    Parameters
    ----------
    name : str
        Key of RESOLUTIONS.
    module : float
        m.

    Returns
    -------
    MeshSizes
        Element sizes, m.

    Raises
    ------
    KeyError
        For an unknown name.
    """
    profile, width, thickness = RESOLUTIONS[name]
    return MeshSizes(profile * module, width * module, thickness * module)
