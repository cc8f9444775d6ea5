"""The tooth pair with its elements and its contact analysis."""

from dataclasses import dataclass

from facegear.config.contact import Contact, contact_plan
from facegear.config.mesh import Mesh, mesh_sizes
from facegear.config.tooth_pair import Pair, ToothPair, pair
from facegear.contact.options import ContactPlan
from facegear.contact.resolution import along_the_ellipse, estimated_memory
from facegear.mesh.sizes import MeshSizes


@dataclass(frozen=True)
class ContactSetup:
    """A pair, the sizes of its elements and what is asked of the contact analysis."""

    pair: Pair
    sizes: MeshSizes
    plan: ContactPlan

    @property
    def memory(self) -> float:
        """Estimated bytes of the larger body's compliance."""
        return estimated_memory(self.pair.design, self.sizes, self.plan)


def contact_setup(tooth_pair: ToothPair, mesh: Mesh, contact: Contact) -> ContactSetup:
    """Set up the contact analysis, with as many cuts along the face as the contact ellipse asks for.

    Parameters
    ----------
    tooth_pair : ToothPair
        Section `tooth_pair` of the config.
    mesh : Mesh
        Section `mesh` of the config.
    contact : Contact
        Section `contact` of the config.

    Returns
    -------
    ContactSetup
        The pair, the sizes of its elements and the plan, in SI units.

    Raises
    ------
    ConfigError
        For a pair without bodies, and for an ellipse that no cuts resolve.
    """
    teeth = pair(tooth_pair)
    sizes = mesh_sizes(mesh, teeth.design.module)
    plan = along_the_ellipse(teeth.design, teeth.materials, sizes, contact_plan(contact))
    return ContactSetup(teeth, sizes, plan)
