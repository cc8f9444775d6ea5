"""The refinement levels that the contact benchmark measures; light to import, as rules list it."""

from facegear.contact.options import Element, Refinement

CUTS = {
    "coarse_1x1x1": ("coarse", Refinement()),
    "coarse_2x1x1": ("coarse", Refinement(2, 1, 1)),
    "coarse_2x1x2": ("coarse", Refinement(2, 1, 2, 2.0)),
    "coarse_2x2x2": ("coarse", Refinement(2, 2, 2, 2.0)),
    "coarse_3x1x2": ("coarse", Refinement(3, 1, 2, 2.0)),
    "coarse_4x1x2": ("coarse", Refinement(4, 1, 2, 2.0)),
    "coarse_4x2x2": ("coarse", Refinement(4, 2, 2, 2.0)),
    "coarse_8x1x3": ("coarse", Refinement(8, 1, 3, 2.0)),
    "medium_2x1x2": ("medium", Refinement(2, 1, 2, 2.0)),
    "medium_4x1x2": ("medium", Refinement(4, 1, 2, 2.0)),
}
"""Mesh resolution and cuts of the flank layer across the profile, along the width and in depth."""

DEFAULT = "coarse_3x1x2"
"""The level that the default config stands for; sectors and linear elements are measured at it."""

SECTORS = {f"{DEFAULT}_sector_{teeth}": teeth for teeth in (5, 9)}
LINEAR: dict[str, Element] = {f"{DEFAULT}_hex8": "hex8", f"{DEFAULT}_tet4": "tet4"}

FINEST = "medium_4x1x2"
LEVELS = (*CUTS, *SECTORS, *LINEAR)

LIMITS = {"mean": 0.5, "amplitude_1": 3.0}
"""Percent that the default resolution may be off the finest, mean and first harmonic."""
