"""The loaded flank of one gear as the contact analysis takes it: its surface and its compliance."""

from dataclasses import dataclass, replace

import numpy as np

from facegear.arrays import AnyArray, Arrays
from facegear.contact.bodies import compliance
from facegear.contact.bodies.compliance import FlankCompliance
from facegear.contact.root_gauges import RootGauges
from facegear.contact.teeth import ContactSide


@dataclass(frozen=True, eq=False)
class GearFlank:
    """Contact surface of a tooth, how the gear's flanks give way, and the gauges that it reads, if any."""

    side: ContactSide
    compliance: FlankCompliance
    gauges: RootGauges | None = None

    def softer(self, factor: float) -> "GearFlank":
        """The flank with Young's modulus smaller by a factor; its gauges read the same stress."""
        given = self.compliance
        return replace(self, compliance=replace(given, scale=factor * given.scale))


STORED = {
    **compliance.STORED,
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
    """Named arrays from which `from_arrays` rebuilds the flank."""
    side, gauges = flank.side, flank.gauges
    none = np.zeros((0, 0, 0, 3))
    return {
        **compliance.to_arrays(flank.compliance),
        "flank_nodes": side.nodes,
        "flank_u": side.u,
        "flank_v": side.v,
        "flank_rows": np.array([side.flank_rows]),
        "junction": side.junction,
        "gauge_position_m": none if gauges is None else gauges.position,
        "gauge_across": none if gauges is None else gauges.across,
        "gauge_error": np.zeros(0) if gauges is None else gauges.error,
    }


def from_arrays(arrays: Arrays) -> GearFlank:
    """Inverse of `to_arrays`."""
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
