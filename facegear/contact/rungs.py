"""The ladder of resolutions that the contact benchmark measures, the finest last."""

from dataclasses import replace

from facegear.contact.benchmark import Rung
from facegear.contact.options import ContactPlan, Refinement, Sector
from facegear.geometry.design import PairDesign
from facegear.mesh.sizes import named_sizes

CUTS = {
    "coarse_1x1x1": ("coarse", Refinement()),
    "coarse_2x1x1": ("coarse", Refinement(2, 1, 1)),
    "coarse_2x1x2": ("coarse", Refinement(2, 1, 2, 2.0)),
    "coarse_4x1x2": ("coarse", Refinement(4, 1, 2, 2.0)),
    "coarse_2x2x2": ("coarse", Refinement(2, 2, 2, 2.0)),
    "coarse_4x2x2": ("coarse", Refinement(4, 2, 2, 2.0)),
    "medium_2x1x2": ("medium", Refinement(2, 1, 2, 2.0)),
    "medium_2x2x2": ("medium", Refinement(2, 2, 2, 2.0)),
}
"""Mesh resolution and cuts of the flank layer across the profile, along the width and in depth."""

SECTORS = {"coarse_4x1x2_sector_5": 5, "coarse_4x1x2_sector_9": 9}
LINEAR = {"coarse_4x1x2_hex8": "hex8", "coarse_4x1x2_tet4": "tet4"}

FINEST = "medium_2x2x2"
RUNGS = (*CUTS, *SECTORS, *LINEAR)


def rung(name: str, design: PairDesign, plan: ContactPlan) -> Rung:
    """A rung of the ladder with the positions and torques of `plan`. Raises KeyError for an unknown name."""
    resolution, cuts = CUTS["coarse_4x1x2" if name in SECTORS or name in LINEAR else name]
    changed = replace(plan, refinement=cuts, sector=Sector(), element="hex27")
    if name in SECTORS:
        changed = replace(changed, sector=Sector(SECTORS[name], SECTORS[name], "free"))
    if name in LINEAR:
        changed = replace(changed, element=LINEAR[name])
    return Rung(name, named_sizes(resolution, design.module), changed)
