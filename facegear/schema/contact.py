"""Config sections `mesh`, `contact` and `modal`: resolution, loads and positions, stiffness of modes."""

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from facegear.schema.base import Section, refuse


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
    """Mesh resolution of both bodies."""

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


class RefinementSection(Section):
    """Subdivision of the layer of elements under the flank."""

    profile: int = Field(default=3, ge=1, le=32, description="across the profile")
    width: int = Field(default=1, ge=1, le=16, description="along the face")
    depth: int = Field(default=2, ge=1, le=16, description="below the flank")
    depth_grading: float = Field(default=2.0, ge=1, le=4, description="ratio of neighbouring sizes in depth")


class SectorSection(Section):
    """Modelled part of each gear."""

    pinion_teeth: Literal["full"] | Annotated[int, Field(ge=5, le=500)] = Field(
        default="full", description="teeth of the pinion that are modelled"
    )
    face_gear_teeth: Literal["full"] | Annotated[int, Field(ge=5, le=2000)] = Field(
        default="full", description="teeth of the face gear that are modelled"
    )
    cut_faces: Literal["free", "clamped"] = Field(default="free", description="of a sector")


class Contact(Section):
    """Loaded tooth contact of one mesh: pinion bore turned against the gear, whose rim back is clamped."""

    torques_n_m: tuple[Annotated[float, Field(ge=1e-6, le=1e7)], ...] = Field(
        default=(100.0, 300.0, 600.0, 1000.0),
        min_length=1,
        max_length=64,
        description="on the pinion, per mesh",
    )
    positions_per_pitch: int = Field(
        default=32, ge=4, le=4096, description="positions solved over one pitch of the pinion"
    )
    refinement: RefinementSection = RefinementSection()
    sector: SectorSection = SectorSection()
    element: Literal["hex27", "hex8", "tet4"] = Field(
        default="hex27", description="the linear ones, on the same nodes, only for comparison"
    )
    fillet_contact: bool = Field(default=True, description="tips may touch fillets")
    neighbour_coupling: bool = Field(default=True, description="a loaded tooth moves its neighbours")

    edge_contact: bool = Field(default=True, description="tip edges carry loads of their own")
    root_stress: bool = Field(
        default=False, description="gauges on the fillets of both gears; section strength brings them"
    )

    @model_validator(mode="after")
    def _check_torques(self) -> "Contact":
        """Refuse torques that do not rise, and root stress with elements that cannot give it."""
        if list(self.torques_n_m) != sorted(set(self.torques_n_m)):
            refuse("torques_n_m", list(self.torques_n_m), "rising, each once")
        if self.root_stress and self.element != "hex27":
            refuse("element", self.element, "hex27, where contact.root_stress is asked for")
        return self


class Modal(Section):
    """Natural modes about the loaded machine."""

    stiffness: Literal["local", "average"] = Field(
        "local",
        description="small vibrations feel the slope dF / d deflection at the load, some 30 % above average, "
        "F / deflection; both at mesh_stiffness.torque_n_m. A mean given for modes (source fem) or with "
        "harmonics is taken as it is",
    )


def modes_need_contact(values: Mapping[str, Any]) -> bool:
    """Whether modes take their stiffness from the contact analysis.

    They take the config's own mean with given harmonics, where source fem has one (for the modes only), and
    where average is asked for and source fem_scaled scales to it.

    Parameters
    ----------
    values : Mapping[str, Any]
        Plain values of a whole config.

    Returns
    -------
    bool
        True if they need it.
    """
    section = values["mesh_stiffness"]
    if section["source"] == "harmonics":
        return False
    has_mean = section["mean_n_per_m"] is not None
    return not has_mean or (section["source"] == "fem_scaled" and values["modal"]["stiffness"] == "local")
