"""Results of the machine in motion: response, sweeps, branches of periodic motions."""

from typing import TYPE_CHECKING, ClassVar

import numpy as np
import pandas as pd

from facegear.errors import FacegearError, require_choice
from facegear.motion.plan import JumpKind
from facegear.pipeline.results.base import Result, fit_for_paper, require_answers
from facegear.report.figures.branches import amplitudes, fractions, loci, multipliers, typical_meshes
from facegear.report.figures.description import Figure
from facegear.report.figures.motion import SWEEP_FIGURES, deflections, drawn_machine, mesh_sweeps_beside

if TYPE_CHECKING:
    from collections.abc import Mapping

    import xarray as xr


class ResponseResult(Result):
    """Steady state at one speed: mesh deflections and forces, spectrum, class of motion, bearing forces."""

    STAGE: ClassVar = "dynamics_response"

    def table(self) -> pd.DataFrame:
        """Numbers of the steady state, one row a quantity (unit at its end) and body or mesh, as a
        sweep keeps them.

        `class` is the class of motion; symmetry_broken tells whether it has mirror images.

        Columns: speed_rpm, quantity, body_or_mesh, value, class, periodic, symmetry_broken.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["summary"].copy()

    def history(self) -> pd.DataFrame:
        """Deflection (um) and elastic force (N) of every mesh along the line of action, over at most 32
        mesh periods.

        Forces are negative on the back flank; mesh_cycle counts mesh periods.

        Columns: mesh_cycle, time_s, mesh, deflection_um, elastic_force_n.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["response"].copy()

    def bearings(self) -> pd.DataFrame:
        """Force of every body on its bearing (N) along x, y, z and radially: at rest, mean, RMS, peak.

        Columns: body, direction, static_n, mean_n, rms_n, ac_rms_n, ac_rms_interval_n, peak_n, class.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["bearings"].copy()

    @fit_for_paper
    def plot(self) -> "Figure":
        """Deflections along the line of action against time, and their spectra.

        Returns
        -------
        Figure
            The figure.
        """
        pinions = [pinion["name"] for pinion in self.values["transmission"]["pinions"]]
        return deflections(self.content["response"], self.content["spectrum"], pinions)


KEYS = ["direction", "speed_rpm"]
"""Columns by which rows of a sweep belong together."""
NO_ITEM = "machine"
"""Name in place of body or mesh, in rows that belong to the whole machine."""


def sweep_dataset(table: pd.DataFrame) -> "xr.Dataset":
    """Arrange the long table of a sweep as arrays over direction, speed_rpm and, by quantity, mesh or
    body or neither.

    The names of meshes hold a stroke, `pinion/side`, those of bodies do not. They keep the order of the
    table.

    Parameters
    ----------
    table : pd.DataFrame
        Table `sweep` of stage dynamics_sweep.

    Returns
    -------
    xr.Dataset
        Quantities by name, nan where the table has no row; `class`, `periodic`, `after_irregular` and
        `symmetry_broken` by direction and speed.
    """
    import xarray as xr  # a third of a second, and few answers are asked for as a dataset

    axes: dict[str, list] = {
        "direction": list(dict.fromkeys(table["direction"])),
        "speed_rpm": np.unique(table["speed_rpm"]).tolist(),
    }
    names = [str(name) for name in dict.fromkeys(table["body_or_mesh"]) if name != NO_ITEM]
    items = {
        "mesh": [name for name in names if "/" in name],
        "body": [name for name in names if "/" not in name],
    }
    speeds = table.drop_duplicates(KEYS)
    variables = {
        "class": _fill_array(speeds, "class", axes, ""),
        "periodic": _fill_array(speeds, "periodic", axes, ""),
        "after_irregular": _fill_array(speeds, "after_irregular", axes, ""),
        "symmetry_broken": _fill_array(speeds, "symmetry_broken", axes, ""),
    }
    for quantity, rows in table.groupby("quantity", sort=False):
        kind = _kind(rows["body_or_mesh"].iloc[0])
        variable_axes = {**axes, kind: items[kind]} if kind else axes
        variables[str(quantity)] = _fill_array(
            rows.rename(columns={"body_or_mesh": kind}), "value", variable_axes, np.nan
        )
    return xr.Dataset(variables)


def _kind(name: str) -> str:
    """Return `mesh` for a name with a stroke, `body` for one without, empty text for the whole machine."""
    return "" if name == NO_ITEM else "mesh" if "/" in name else "body"


def _fill_array(rows: pd.DataFrame, column: str, axes: dict[str, list], empty: object) -> "xr.DataArray":
    """Put one column of rows into an array over `axes`, whose values select the place; `empty` where
    there is no row.
    """
    import xarray as xr  # as above

    values = np.full([len(axis) for axis in axes.values()], empty, dtype=object if empty == "" else float)
    item_indices = tuple(pd.Index(axis).get_indexer(rows[name]) for name, axis in axes.items())
    values[item_indices] = rows[column].to_numpy()
    return xr.DataArray(values, coords=axes, dims=list(axes))


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
        """One row for each abrupt change at which irregular (not periodic) motion begins or ends;
        columns as of `jumps`.

        Where irregular motion ends is a matter of chance: there `error_rpm` is the step of the sweep.

        Returns
        -------
        pd.DataFrame
            The table.
        """
        jumps = self.content["jumps"]
        return jumps[jumps["kind"] == JumpKind.IRREGULAR].reset_index(drop=True)

    def resonances(self) -> pd.DataFrame:
        """One row a peak over speed of the AC RMS (RMS without mean) of a deflection or displacement,
        with its natural mode.

        resonance_rpm is where `order` times the mesh frequency meets the mode, which has
        `energy_fraction` of the energy.

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
        figure: str = "meshes",
        label: str = "as configured",
        beside: "Mapping[str, SweepResult] | None" = None,
    ) -> "Figure":
        """RMS of `meshes`, `pinions` or `gears` over speed, `campbell` diagram or `waterfall`.

        `beside`: sweeps of other gearboxes with the same meshes by label, drawn in the same axes; of the
        meshes alone.

        Parameters
        ----------
        figure : str
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
        draw = SWEEP_FIGURES[require_choice(figure, tuple(SWEEP_FIGURES), "plot")]
        teeth = self.values["tooth_pair"]["pinion_teeth"]
        machine = drawn_machine(self.values["transmission"], teeth)
        if not beside:
            return draw(self.content, machine)
        require_choice(figure, ("meshes",), "plot beside other sweeps")
        require_answers(beside, SweepResult)
        sweeps = {name: result.content["sweep"] for name, result in {label: self, **beside}.items()}
        meshes = [f"{pinion}/{side}" for side in machine.sides for pinion in machine.pinions_shown]
        item_names = [set(sweep["body_or_mesh"]) for sweep in sweeps.values()]
        if not all(set(meshes) <= names for names in item_names):
            raise FacegearError("beside: must be sweeps of machines with the same meshes")
        return mesh_sweeps_beside(sweeps, meshes)


FIGURES = ("amplitudes", "fractions", "multipliers")
"""Names of the figures of branches."""


class BranchesResult(Result):
    """Periodic motions found over speed, stable or not, and the points where motions end or change.

    Mirror images of motions that break a symmetry of the machine are branches of their own, see images().
    """

    STAGE: ClassVar = "branches"
    BESIDE: ClassVar = {"sweep": ("dynamics_sweep", "sweep")}

    def table(self) -> pd.DataFrame:
        """One row a branch, point and mesh: speed, stable or not, deflections, peak force, contact.

        Columns, among others: branch, point, arc, speed_rpm, period, stable, mesh, deflection_ac_rms_um,
        deflection_rms_um, deflection_minimum_um, deflection_maximum_um, peak_force_n, open_fraction,
        drive_fraction, back_fraction.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["branches"].copy()

    def images(self) -> pd.DataFrame:
        """Return which branches are mirror images, under a symmetry of the machine, and of which
        followed branch.

        Columns: branch, image_of; both are numbers of branches. They come from the table of ends, whose
        columns are, among others: branch, period, points, image_of, tried.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        ends = self.content["ends"]
        rows = ends[ends["image_of"].astype(str) != ""]
        return rows[["branch", "image_of"]].astype(int).reset_index(drop=True)

    def special_points(self) -> pd.DataFrame:
        """One row a fold, period doubling, Neimark-Sacker point, branch point or graze, with its proof.

        Columns, among others: branch, period, kind, speed_rpm, arc, meshes, edge, proof.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["special"].copy()

    def margins(self) -> pd.DataFrame:
        """Margin of each stable motion at the nominal speed until it ends or loses stability, in speed
        and in torque.

        Columns, among others: branch, parameter, margin.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["margins"].copy()

    def ranges(self) -> pd.DataFrame:
        """Ranges of speed (rpm) in which several stable motions exist, with the numbers of their
        branches.

        Columns, among others: from_rpm, to_rpm, branches.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["ranges"].copy()

    def coexistence(self) -> pd.DataFrame:
        """Fraction of random starts at a speed that ends on each motion, with its standard error, and
        the branch of the motion.

        Columns, among others: speed_rpm, fraction, error, branch, motion.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["coexistence"].copy()

    def jumps(self) -> pd.DataFrame:
        """Each jump of the sweep with the special point that its motion runs into, or why there is none.

        Columns, among others: direction, speed_before_rpm, speed_after_rpm, class_before, branch, kind, note.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["jumps"].copy()

    def swept(self) -> pd.DataFrame:
        """Each periodic motion of the sweep with the branch it lies on, or why it lies on none.

        Columns, among others: direction, period, branch, note.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["swept"].copy()

    @fit_for_paper
    def plot(self, figure: str = "amplitudes", branch: int = 0) -> "Figure":
        """Draw `amplitudes` over speed, `fractions` of random starts, or the `multipliers` of one branch.

        Parameters
        ----------
        figure : str
            Kind of the figure, one of those above.
        branch : int
            Number of the branch, for `multipliers`.

        Returns
        -------
        Figure
            The figure.
        """
        require_choice(figure, FIGURES, "plot")
        if figure == "fractions":
            return fractions(self.content["coexistence"])
        if figure == "multipliers":
            return multipliers(self.content["multipliers"], branch)
        meshes = typical_meshes(self.values["transmission"]["pinions"], self.content["branches"]["mesh"])
        speed = self.values["dynamics"]["speed_rpm"]
        return amplitudes(
            self.content["branches"], self.content["special"], self.content["sweep"], meshes, speed
        )


class BranchLociResult(Result):
    """Loci where motions end or double their period, in the plane of speed and a second parameter."""

    STAGE: ClassVar = "branches_loci"

    def table(self) -> pd.DataFrame:
        """One row a point of a curve: locus, kind of point, second parameter, factor on that
        parameter's value in the config, speed.

        `corner` marks a cusp.

        Columns, among others: locus, kind, factor, speed_rpm, corner.

        Returns
        -------
        pd.DataFrame
            The table, with units in the names of its columns.
        """
        return self.content["loci"].copy()

    @fit_for_paper
    def plot(self) -> "Figure":
        """All loci with the operating point, a panel for each parameter.

        Returns
        -------
        Figure
            The figure.
        """
        return loci(self.content["loci"], self.values["dynamics"]["speed_rpm"])
