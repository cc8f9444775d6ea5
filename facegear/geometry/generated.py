"""The pair without what moves or changes its flanks: limits and rays of the gear follow from this."""

from dataclasses import replace

from facegear.geometry.design import AssemblyErrors, Flanks, GearModifications, PairDesign, Relief


def generated(design: PairDesign) -> PairDesign:
    """The pair with flanks as they are generated, assembled without errors: many designs share one."""
    none = Relief()
    pinion = replace(design.pinion, tip_relief=none, root_relief=none, lead_crowning=none, flanks=Flanks())
    gear = replace(design.face_gear, modifications=GearModifications(), flanks=Flanks())
    return replace(design, pinion=pinion, face_gear=gear, assembly=AssemblyErrors())
