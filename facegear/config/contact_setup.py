"""The tooth pair with its elements and its contact analysis, from plain config values."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from facegear.config.base import parse
from facegear.config.contact import Contact, contact_plan
from facegear.config.mesh import Mesh, mesh_sizes
from facegear.config.tooth_pair import Pair, pair
from facegear.contact.options import ContactPlan
from facegear.contact.resolution import along_the_ellipse
from facegear.mesh.sizes import MeshSizes


@dataclass(frozen=True)
class ContactSetup:
    """A pair, the sizes of its elements and what is asked of the contact analysis."""

    pair: Pair
    sizes: MeshSizes
    plan: ContactPlan


def contact_setup(
    tooth_pair: Mapping[str, Any], mesh: Mapping[str, Any], contact: Mapping[str, Any]
) -> ContactSetup:
    """With as many cuts along the face as the contact ellipse of a crowned pinion asks for.

    Raises ConfigError for a pair without bodies, and for an ellipse that no cuts resolve.
    """
    teeth = pair(tooth_pair)
    sizes = mesh_sizes(parse(Mesh, mesh), teeth.design.module)
    plan = along_the_ellipse(teeth.design, teeth.materials, sizes, contact_plan(parse(Contact, contact)))
    return ContactSetup(teeth, sizes, plan)
