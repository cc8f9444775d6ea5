"""Root stress of the running machine."""

from typing import ClassVar

import pandas as pd

from facegear.results.base import Kept, Result
from facegear.strength.columns import DYNAMIC_STRESS_FINITE


class DynamicStressResult(Result):
    """Largest root stress of every mesh at the nominal speed: with its mean force, and running."""

    FILES: ClassVar = {"dynamic_stress": Kept("strength/dynamic_stress.csv", DYNAMIC_STRESS_FINITE)}

    def table(self) -> pd.DataFrame:
        """A row a mesh: forces, dynamic factor, root stress of both bodies (docs/strength.md)."""
        return self.content["dynamic_stress"].copy()
