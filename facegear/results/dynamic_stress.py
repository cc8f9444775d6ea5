"""Root stress of the running machine."""

from typing import ClassVar

import pandas as pd

from facegear.results.base import Result


class DynamicStressResult(Result):
    """Largest root stress of every mesh at the nominal speed: with its mean force, and running."""

    STAGE: ClassVar = "dynamic_root_stress"

    def table(self) -> pd.DataFrame:
        """A row a mesh: forces, dynamic factor, root stress of both bodies (docs/strength.md)."""
        return self.content["dynamic_stress"].copy()
