"""The pair without what moves or changes its flanks: limits and rays of the gear follow from this."""

from dataclasses import replace

from facegear.geometry.design import AssemblyErrors, Flanks, GearModifications, PairDesign, Relief


def as_cut(design: PairDesign) -> PairDesign:
    """Return the pair with flanks as they are generated, assembled without errors.

    Many designs share one such pair.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    PairDesign
        Pair without modifications, deviations and errors.
    """
    no_flanks = Relief()
    pinion = replace(
        design.pinion, tip_relief=no_flanks, root_relief=no_flanks, lead_crowning=no_flanks, flanks=Flanks()
    )
    gear = replace(design.face_gear, modifications=GearModifications(), flanks=Flanks())
    return replace(design, pinion=pinion, face_gear=gear, assembly=AssemblyErrors())
