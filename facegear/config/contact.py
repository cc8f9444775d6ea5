"""Config section `contact`: loads and positions of the loaded tooth contact analysis; what is modelled."""

from typing import Annotated, Literal

from pydantic import Field, model_validator

from facegear.config.base import Section, refuse
from facegear.contact.options import ContactOptions, ContactPlan, Refinement, Sector


class RefinementSection(Section):
    """How often the layer of elements under the flank is cut."""

    profile: int = Field(default=3, ge=1, le=32, description="across the profile")
    width: int = Field(default=1, ge=1, le=16, description="along the face")
    depth: int = Field(default=2, ge=1, le=16, description="below the flank")
    depth_grading: float = Field(default=2.0, ge=1, le=4, description="ratio of neighbouring sizes in depth")


class SectorSection(Section):
    """How much of each gear is modelled."""

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
        if list(self.torques_n_m) != sorted(set(self.torques_n_m)):
            refuse("torques_n_m", list(self.torques_n_m), "rising, each once")
        if self.root_stress and self.element != "hex27":
            refuse("element", self.element, "hex27, where contact.root_stress is asked for")
        return self


def contact_plan(section: Contact) -> ContactPlan:
    """Return the plan of the contact analysis in SI units.

    Parameters
    ----------
    section : Contact
        Section `contact` of the config.

    Returns
    -------
    ContactPlan
        Torques (N m), positions, refinement, sector and options.
    """
    layer, sector = section.refinement, section.sector
    return ContactPlan(
        torques=section.torques_n_m,
        positions=section.positions_per_pitch,
        refinement=Refinement(layer.profile, layer.width, layer.depth, layer.depth_grading),
        sector=Sector(_number(sector.pinion_teeth), _number(sector.face_gear_teeth), sector.cut_faces),
        options=ContactOptions(section.fillet_contact, section.neighbour_coupling, section.edge_contact),
        element=section.element,
        root_stress=section.root_stress,
    )


def _number(teeth: int | str) -> int | None:
    return teeth if isinstance(teeth, int) else None
