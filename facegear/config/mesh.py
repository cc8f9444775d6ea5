"""The section mesh: a named resolution or sizes of one's own."""

from dataclasses import replace
from typing import Literal

from pydantic import Field

from facegear.config.base import Section
from facegear.mesh.sizes import MeshSizes, named_sizes, thin_fillet


class SizesSection(Section):
    """Element sizes; quadratic elements carry nodes at half these distances."""

    profile_mm: float = Field(ge=1e-7, le=100, description="across the flank's profile, at its surface")
    width_mm: float = Field(ge=1e-7, le=100, description="along the face")
    thickness_mm: float = Field(ge=1e-7, le=100, description="largest inside the tooth and the body below")
    fillet_mm: float | None = Field(
        default=None,
        ge=1e-7,
        le=100,
        description="along the lower half of the fillet's profile; null: as across the flank, half of that "
        "below a thin fillet",
    )
    fillet_depth_mm: float | None = Field(
        default=None,
        ge=1e-7,
        le=100,
        description="first row below a thin fillet, less below a sharp one; null: 0.8 of profile_mm",
    )


class Mesh(Section):
    """How fine both bodies are meshed."""

    resolution: Literal["coarse", "medium", "fine", "finest"] | SizesSection = Field(
        default="coarse", description="sizes that follow from the module, or own sizes"
    )
    thin_fillet: bool | None = Field(
        default=None,
        description="finer elements at and below the fillets; null: where root stress is asked for",
    )
    exported_teeth: int = Field(
        default=3, ge=1, le=2000, description="teeth in mesh files, at most all of them"
    )


def mesh_sizes(section: Mesh, module: float) -> MeshSizes:
    """Return the sizes of the finite elements in SI units.

    Parameters
    ----------
    section : Mesh
        Section `mesh` of the config.
    module : float
        Module of the pair, m.

    Returns
    -------
    MeshSizes
        Sizes, m.
    """
    resolution = section.resolution
    name = resolution if isinstance(resolution, str) else ""
    sizes = own_sizes(resolution) if isinstance(resolution, SizesSection) else named_sizes(resolution, module)
    return thin_fillet(sizes, name) if section.thin_fillet else replace(sizes, fillet_depth=None)


def own_sizes(sizes: SizesSection) -> MeshSizes:
    """Convert the sizes that a config gives itself to SI units.

    Parameters
    ----------
    sizes : SizesSection
        Sizes of the config.

    Returns
    -------
    MeshSizes
        Sizes, m.
    """
    return MeshSizes(
        profile=1e-3 * sizes.profile_mm,
        width=1e-3 * sizes.width_mm,
        thickness=1e-3 * sizes.thickness_mm,
        fillet=None if sizes.fillet_mm is None else 1e-3 * sizes.fillet_mm,
        fillet_depth=None if sizes.fillet_depth_mm is None else 1e-3 * sizes.fillet_depth_mm,
    )
