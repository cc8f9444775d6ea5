"""Speed sweep."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, ClassVar

import pandas as pd

from facegear.dynamics.sweeps.jump_kinds import JumpKind
from facegear.errors import FacegearError, require_choice
from facegear.results.base import Result, require_answers
from facegear.results.paper_figure import fit_for_paper

if TYPE_CHECKING:
    import xarray as xr

    from facegear.plots.description import Figure


class SweepResult(Result):
    """Steady states over speed, up and down, with jumps and resonances."""

    STAGE: ClassVar = "dynamics_sweep"
    BESIDE: ClassVar = {"frequencies": ("modal", "frequencies")}

    def table(self) -> pd.DataFrame:
        """Return every number of the sweep, one row each.

        Columns: direction, speed_rpm, quantity, body_or_mesh, value, class, periodic, after_irregular,
        symmetry_broken.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["sweep"].copy()

    def dataset(self) -> "xr.Dataset":
        """Every quantity (unit at the end of its name) over direction, speed_rpm and mesh or body.

        Returns
        -------
        xarray.Dataset
            Quantities by name; `class` is the class of motion, and a value that does not exist at a speed is
            NaN.
        """
        from facegear.results.sweep_dataset import sweep_dataset

        return sweep_dataset(self.content["sweep"])

    def jumps(self) -> pd.DataFrame:
        """One row for each jump from one periodic motion to another.

        Columns are its bracket of speeds and their error (rpm), `kind`, classes of motion and the resonance
        it belongs to. `kind` is `jump` where the motion before it ends or loses its stability, and `step`
        where the sweep left a stable motion because its own step was too large. The true speed of a jump lies
        in the bracket or at most `error_rpm` beside it.

        Columns: direction, kind, speed_before_rpm, speed_after_rpm, error_rpm, mesh,
        deflection_ac_rms_before_um, deflection_ac_rms_after_um, class_before, class_after,
        leading_multiplier_before, resonance, resonance_rpm, energy_fraction, mode, order, periodic_before,
        periodic_after, after_irregular, symmetry_broken.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        jumps = self.content["jumps"]
        return jumps[jumps["kind"] != JumpKind.IRREGULAR].reset_index(drop=True)

    def irregular_ends(self) -> pd.DataFrame:
        """One row for each abrupt change at which irregular motion begins or ends; columns as of `jumps`.

        Where irregular motion ends is a matter of chance: there `error_rpm` is the step of the sweep.

        Returns
        -------
        pd.DataFrame
            The table.
        """
        jumps = self.content["jumps"]
        return jumps[jumps["kind"] == JumpKind.IRREGULAR].reset_index(drop=True)

    def resonances(self) -> pd.DataFrame:
        """One row a peak of the RMS without mean, with the mode it belongs to.

        Columns: direction, speed_rpm, quantity, body_or_mesh, value, class, resonance, resonance_rpm,
        energy_fraction, mode, order, periodic, after_irregular, symmetry_broken.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["resonances"].copy()

    @fit_for_paper
    def plot(
        self,
        what: str = "meshes",
        label: str = "as configured",
        beside: "Mapping[str, SweepResult] | None" = None,
    ) -> "Figure":
        """RMS of `meshes`, `pinions` or `gears` over speed, `campbell` diagram or `waterfall`.

        `beside`: sweeps of other gearboxes with the same meshes by label, drawn in the same axes; of the
        meshes alone.

        Parameters
        ----------
        what : str
            Kind of the figure, one of those above.
        label : str
            Name of this result in the legend.
        beside : 'Mapping[str, SweepResult] | None'
            Results of other gearboxes by label, drawn in the same axes; None for this one alone.

        Returns
        -------
        Figure
            The figure.
        """
        from facegear.plots.dynamics import SWEEP_FIGURES, drawn_machine

        draw = SWEEP_FIGURES[require_choice(what, tuple(SWEEP_FIGURES), "plot")]
        teeth = self.values["tooth_pair"]["pinion_teeth"]
        machine = drawn_machine(self.values["transmission"], teeth)
        if not beside:
            return draw(self.content, machine)
        from facegear.plots.sweeps_beside import mesh_sweeps_beside

        require_choice(what, ("meshes",), "plot beside other sweeps")
        require_answers(beside, SweepResult)
        sweeps = {name: result.content["sweep"] for name, result in {label: self, **beside}.items()}
        meshes = [f"{pinion}/{side}" for side in machine.sides for pinion in machine.pinions_shown]
        item_names = [set(sweep["body_or_mesh"]) for sweep in sweeps.values()]
        if not all(set(meshes) <= names for names in item_names):
            raise FacegearError("beside: must be sweeps of machines with the same meshes")
        return mesh_sweeps_beside(sweeps, meshes)
