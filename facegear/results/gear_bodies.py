"""Face gears that bend."""

from typing import TYPE_CHECKING, ClassVar

import pandas as pd

from facegear.results.base import Result

if TYPE_CHECKING:
    from facegear.plots.style import Figure


class GearBodiesResult(Result):
    """Modes and compliance of the face gears that bend, with their hubs held."""

    STAGE: ClassVar = "gear_bodies"

    def table(self) -> pd.DataFrame:
        """One row a mode: gear, nodal diameters, frequency at rest, waves in space, resonant speeds."""
        return self.content["modes"].copy()

    def bodies(self) -> pd.DataFrame:
        """One row a gear: mass and inertia of its section, compliance at a mesh, numerical error."""
        return self.content["bodies"].copy()

    def crossings(self) -> pd.DataFrame:
        """One row a speed at which a mesh harmonic meets a wave, with how the meshes' phases add up."""
        return self.content["crossings"].copy()

    def compliance(self) -> pd.DataFrame:
        """One row a gear and order: motions below a mesh by unit forces."""
        return self.content["compliance"].copy()

    def influence(self) -> pd.DataFrame:
        """One row for two flanks of a gear: motion of the first against its force, by 1 N on the second."""
        return self.content["influence"].copy()

    def plot(self) -> "Figure":
        """Sections with their first mode shapes."""
        from facegear.plots.gear_bodies import body_shapes

        return body_shapes(self.content["modes"], self.content["shapes"])
