"""Root stress of both gears."""

from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

import pandas as pd

from facegear.errors import chosen
from facegear.results.base import Kept, Result
from facegear.strength.columns import (
    ALONG_FACE_COLUMNS,
    PASSAGE_COLUMNS,
    ROOT_STRESS_ARRAYS,
    ROOT_STRESS_FINITE,
)

if TYPE_CHECKING:
    import xarray as xr

    from facegear.plots.style import Figure


class RootStressResult(Result):
    """Stress at the fillets of both gears while a tooth passes through the mesh."""

    FILES: ClassVar = {
        "summary": Kept("strength/root_stress.csv", ROOT_STRESS_FINITE),
        "passage": Kept("strength/passage.csv", PASSAGE_COLUMNS),
        "along_face": Kept("strength/along_face.csv", ALONG_FACE_COLUMNS),
        "stress": Kept("strength/root_stress.npz", ROOT_STRESS_ARRAYS),
    }

    def table(self) -> pd.DataFrame:
        """Peak of each fillet with its place, a row a torque, body and fillet (docs/strength.md)."""
        return self.content["summary"].copy()

    def stress(self, body: str = "face_gear") -> "xr.DataArray":
        """Stress (MPa) of `pinion` or `face_gear` over torque, passage, fillet and the fillet's gauges."""
        import xarray as xr

        chosen(body, ("pinion", "face_gear"), "body")
        arrays = self.content["stress"]
        return xr.DataArray(
            1e-6 * arrays[f"{body}_stress_pa"],
            dims=("torque_n_m", "passage", "fillet", "down", "along"),
            coords={
                "torque_n_m": arrays["torque_n_m"],
                "passage": arrays[f"{body}_passage"],
                "fillet": ["loaded", "other"],
            },
            attrs={"units": "MPa"},
        )

    def save(self, folder: str | Path) -> list[Path]:
        """Write three tables, `root_stress.npz` and, for ParaView, `root_stress.vtu`."""
        from facegear.io.meshes import write_vtu
        from facegear.strength.fillet_surface import stress_surface

        vtu = Path(folder) / "strength" / "root_stress.vtu"
        paths = super().save(folder)
        write_vtu(vtu, *stress_surface(self.content["stress"]))
        return [*paths, vtu]

    def plot(self, what: str = "passage") -> "Figure":
        """Root stress over a tooth's `passage` through the mesh, or along the `face`."""
        from facegear.plots.strength import along_face, passage

        if chosen(what, ("passage", "face"), "plot") == "passage":
            return passage(self.content["passage"])
        return along_face(self.content["along_face"])
