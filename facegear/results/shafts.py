"""Shafts of pinions, and turning masses behind torsional springs."""

from typing import ClassVar

import pandas as pd

from facegear.results.base import Result


class ShaftsResult(Result):
    """What pinions sit on and what torques turn, with the machine at rest under its mean torques."""

    STAGE: ClassVar = "shafts"

    def table(self) -> pd.DataFrame:
        """One row a pinion with a shaft: stiffness without moments, displacement and slope under load."""
        return self.content["seats"].copy()

    def stiffness(self) -> pd.DataFrame:
        """Five rows a pinion with a shaft: its stiffness in x, y, z, tilt_x, tilt_y."""
        return self.content["stiffness"].copy()

    def bearings(self) -> pd.DataFrame:
        """One row a bearing of a shaft: its forces and moments."""
        return self.content["bearings"].copy()

    def torsion(self) -> pd.DataFrame:
        """One row a turning mass: its spring, twist under load, natural frequencies of its chain."""
        return self.content["torsion"].copy()
