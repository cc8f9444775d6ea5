"""Modes at speed of a machine whose face gears bend."""

from typing import ClassVar

import pandas as pd

from facegear.results.base import Result


class GearWavesResult(Result):
    """Damped modes at the nominal speed about the static load, and the waves of the face gears in them."""

    STAGE: ClassVar = "gear_waves"

    def table(self) -> pd.DataFrame:
        """One row a mode, gear and nodal diameters: frequency, damping, energy, how much travels forward."""
        return self.content["waves"].copy()
