"""The whole config and the checks that reach across its sections."""

from pydantic import Field, model_validator

from facegear.config.base import Section, refuse
from facegear.config.buildable import require_buildable
from facegear.config.contact import Contact, contact_plan
from facegear.config.dynamics import Dynamics
from facegear.config.load_sharing import LoadSharing
from facegear.config.mesh import Mesh, mesh_sizes
from facegear.config.stiffness import MeshStiffness
from facegear.config.studies import NAME, Study
from facegear.config.tooth_pair import ToothPair, materials, pair_design
from facegear.config.transmission import Transmission, tooth_numbers
from facegear.contact.resolution import check_resolution
from facegear.errors import ConfigError


class Config(Section):
    """One machine and what is to be computed for it."""

    case: str = Field(pattern=NAME, description="names the folder under results/")
    tooth_pair: ToothPair
    mesh: Mesh = Mesh()
    contact: Contact = Contact()
    mesh_stiffness: MeshStiffness
    transmission: Transmission
    dynamics: Dynamics = Dynamics()
    load_sharing: LoadSharing = LoadSharing()
    studies: tuple[Study, ...] = ()
    reproduction: str | None = Field(
        None,
        min_length=1,
        description="yaml file, from this file's folder: claims of a publication and what it leaves out",
    )

    @model_validator(mode="after")
    def _buildable(self) -> "Config":
        pair = self.tooth_pair
        if pair.pinion is None and self.mesh_stiffness.source != "harmonics":
            allowed = "required, as mesh_stiffness.source is not harmonics"
            refuse("tooth_pair.pinion", None, allowed)
        try:
            require_buildable(
                self.transmission,
                tooth_numbers(
                    pair.pinion_teeth, pair.face_gear_teeth, pair.module_mm, pair.pressure_angle_deg
                ),
            )
            if self.mesh_stiffness.source != "harmonics":
                design = pair_design(pair)
                sizes = mesh_sizes(self.mesh, design.module)
                check_resolution(design, materials(pair), sizes, contact_plan(self.contact))
        except ConfigError as error:
            refuse(error.key, error.value, error.allowed)
        return self
