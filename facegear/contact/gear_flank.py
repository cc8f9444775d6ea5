"""Loaded flank of one gear as the contact analysis takes it: its surface and its compliance."""

from dataclasses import dataclass, replace

import numpy as np

from facegear.arrays import AnyArray, Arrays
from facegear.contact.bodies import compliance
from facegear.contact.bodies.compliance import FlankCompliance
from facegear.contact.root_gauges import RootGauges
from facegear.contact.teeth import ContactSide


@dataclass(frozen=True, eq=False)
class GearFlank:
    """Contact surface of a tooth, compliance of the gear's flanks, and root gauges, if any."""

    side: ContactSide
    compliance: FlankCompliance
    gauges: RootGauges | None = None

    def softer(self, factor: float) -> "GearFlank":
        """Return the flank with Young's modulus divided by a factor; its gauges read the same stress.

        Parameters
        ----------
        factor : float
            Old over new Young's modulus, dimensionless.

        Returns
        -------
        GearFlank
            Flank whose displacements are `factor` times as large.
        """
        flank_compliance = self.compliance
        return replace(self, compliance=replace(flank_compliance, scale=factor * flank_compliance.scale))


ARRAY_SHAPES = {
    **compliance.ARRAY_SHAPES,
    "flank_nodes": (None, None),
    "flank_u": (None, None),
    "flank_v": (None, None),
    "flank_rows": (1,),
    "junction": (None,),
    "gauge_position_m": (None, None, None, None),
    "gauge_across": (None, None, None, None),
    "gauge_error": (None,),
}
"""Names and shapes of the arrays of a stored flank; u, v and junction as in `ContactSide`."""


def to_arrays(flank: GearFlank) -> dict[str, AnyArray]:
    """Return named arrays from which `from_arrays` rebuilds the flank.

    Parameters
    ----------
    flank : GearFlank
        Flank to store.

    Returns
    -------
    dict of arrays
        Arrays with the (...) shapes of ARRAY_SHAPES.
    """
    side, gauges = flank.side, flank.gauges
    empty_gauges = np.zeros((0, 0, 0, 3))
    return {
        **compliance.to_arrays(flank.compliance),
        "flank_nodes": side.nodes,
        "flank_u": side.u,
        "flank_v": side.v,
        "flank_rows": np.array([side.flank_rows]),
        "junction": side.junction,
        "gauge_position_m": empty_gauges if gauges is None else gauges.position,
        "gauge_across": empty_gauges if gauges is None else gauges.across,
        "gauge_error": np.zeros(0) if gauges is None else gauges.error,
    }


def from_arrays(arrays: Arrays) -> GearFlank:
    """Rebuild a flank from the arrays of `to_arrays`.

    Parameters
    ----------
    arrays : Arrays
        Arrays as ARRAY_SHAPES.

    Returns
    -------
    GearFlank
        The flank.
    """
    side = ContactSide(
        nodes=arrays["flank_nodes"],
        u=arrays["flank_u"],
        v=arrays["flank_v"],
        flank_rows=int(arrays["flank_rows"][0]),
        junction=arrays["junction"],
    )
    position, across = arrays["gauge_position_m"], arrays["gauge_across"]
    gauges = RootGauges(position, across, arrays["gauge_error"]) if position.size else None
    return GearFlank(side, compliance.from_arrays(arrays), gauges)
