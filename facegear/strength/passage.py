"""Root stress of a tooth on its way through the mesh, from the loads of the contact analysis."""

import numpy as np

from facegear.arrays import Arrays
from facegear.contact.gear_flank import GearFlank
from facegear.contact.nodal_loads import loads_by_tooth
from facegear.errors import InvalidInput
from facegear.strength.root_stress import RootStress, root_stress


def passing(body: str, flank: GearFlank, loads: Arrays, variant: int = 0) -> RootStress:
    """Superpose the root stress of one body under the loads of stage contact on its flank.

    Forces on its fillet are left out: the gauges below would read the dent.

    Parameters
    ----------
    body : str
        `pinion` or `face_gear`.
    flank : GearFlank
        Flank of the body, with gauges on its fillets.
    loads : Arrays
        Arrays of nodal loads (LOAD_ARRAYS).
    variant : int
        Index of the variant of assembly errors.

    Returns
    -------
    RootStress
        Root stress over torque and passage.

    Raises
    ------
    InvalidInput
        Where the fillets carry no gauges.
    """
    if flank.gauges is None:
        raise InvalidInput("gauges on the fillets", False, "true, for root stress")
    loaded_teeth = loads[f"{body}_tooth"]
    return root_stress(
        flank.compliance.readings,
        loads_by_tooth(loads, body, flank.side.flank_rows * flank.side.shape[1], variant),
        np.unique(loads["torque_n_m"]),
        np.unique(loads["position"]),
        flank.gauges.along(body),
        flank.gauges.tangent_angle,
        flank.gauges.error,
        np.arange(loaded_teeth.min() - 1, loaded_teeth.max() + 2),
    )
