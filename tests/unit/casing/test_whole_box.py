"""The small machine on every node of the public box: stored results against the page and the reductions.

`python -m tests.helpers.whole_boxes` makes the stored file.
"""

import numpy as np
import pandas as pd
import pytest
from references import against, agrees

from facegear.machine.loaded_modes import loaded_modes
from tests.helpers.public_casing import mount_public
from tests.helpers.seated_machines import make_small_machine, place_on
from tests.helpers.whole_boxes import FILE

PRINTED = {
    "frequency_hz": (0, 747.9139, 790.7152, 808.2496, 845.3806, 885.0186, 1035.2479, 1256.0432)
    + (1324.2696, 1339.4792, 1384.9249, 1705.4576, 1756.5160),
    "acceleration_1000_hz_m_per_s2": (1.544027, 10.352610, 3.853581),
    "acceleration_1600_hz_m_per_s2": (4.225836, 19.199924, 5.050839),
}


@pytest.fixture(scope="module")
def stored():
    return pd.read_csv(FILE).set_index("quantity")["value"]


@against(
    "second implementation",
    "public casing: a program of its own for 20-node bricks",
    capability="casing",
    module="facegear.casing.reduction",
)
@pytest.mark.parametrize("quantity", list(PRINTED))
def test_whole_elements_have_the_printed_modes_and_vibration(stored, quantity):
    expected = PRINTED[quantity]
    tolerance = {"absolute": 5.1e-5} if quantity == "frequency_hz" else {"relative": 1e-6}
    agrees(f"{quantity} of whole elements", stored.loc[quantity].to_numpy(), expected, **tolerance)


@against(
    "second implementation",
    "all rows of the public box",
    capability="casing casing_loads",
    module="facegear.casing.reduction",
)
def test_thirty_modes_are_as_near_to_whole_elements_as_the_page_says(stored):
    frequencies = loaded_modes(make_small_machine(casing=place_on(mount_public(30)))).frequencies[:13]
    whole = stored.loc["frequency_hz"].to_numpy()
    above = frequencies[1:] / whole[1:] - 1.0
    # A reduced casing is stiffer than its elements.
    assert (above > 0.0).all()
    agrees("modes on 30 modes over those of whole elements", above, np.zeros(12), absolute=4e-4)
