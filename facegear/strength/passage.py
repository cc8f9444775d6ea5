"""Root stress of a tooth on its way through the mesh, from the loads of the contact analysis."""

import numpy as np

from facegear.arrays import Arrays
from facegear.contact.gear_flank import GearFlank
from facegear.contact.nodal_loads import loads_by_tooth
from facegear.errors import InvalidInput
from facegear.strength.root_stress import RootStress, root_stress


def passing(body: str, flank: GearFlank, loads: Arrays, variant: int = 0) -> RootStress:
    """Root stress of one body under the loads of stage contact on its flank, of one of its variants.

    What presses on its fillet is left out: the gauges below would read the dent. Raises InvalidInput where
    its fillets carry no gauges.
    """
    if flank.gauges is None:
        raise InvalidInput("gauges on the fillets", False, "true, for root stress")
    loaded = loads[f"{body}_tooth"]
    return root_stress(
        flank.compliance.readings,
        loads_by_tooth(loads, body, flank.side.flank_rows * flank.side.shape[1], variant),
        np.unique(loads["torque_n_m"]),
        np.unique(loads["position"]),
        flank.gauges.along(body),
        flank.gauges.tangent_angle,
        flank.gauges.error,
        np.arange(loaded.min() - 1, loaded.max() + 2),
    )
