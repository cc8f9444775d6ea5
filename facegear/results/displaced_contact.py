"""Contact of a pair whose two bodies stand displaced."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from facegear.errors import extras_named
from facegear.stages.displaced_contact import DisplacedFlank, unloaded_table
from facegear.stages.outcome import Outcome

Torques = float | Iterable[float] | None
"""Torques on the pinion, N m; None: those of the config."""


@dataclass(frozen=True, eq=False, repr=False)
class DisplacedContact:
    """Where both flanks of a mesh meet, and by how much they close, with both of its bodies displaced.

    Attributes
    ----------
    flanks
        Unloaded contact of the flanks `drive` and `back`.
    solve
        Function from torques to the tables of the loaded contact.
    """

    flanks: Mapping[str, DisplacedFlank]
    solve: Callable[[Torques], Outcome]

    def table(self) -> pd.DataFrame:
        """One row a flank, drive and back: what it meets without load.

        - offset_um, axial_shift_um, shaft_angle_error_deg: errors of assembly that the displacements amount
          to, those of the config included, as the flank meets them; outward_um: shift of the pinion along its
          axis, which moves the ends of its face alone.
        - approach_um: how far the flanks have come together along the line of action from as assembled,
          exactly; deflection_um: its first order, which a lumped mesh counts as its deflection; closing_um:
          the rest, as in `operating_pose().table()`. A positive approach presses or turns the gear ahead.
        - backlash_um: normal backlash of the displaced pair.
        - unloaded_path_mm: place of the contact along the pinion's axis; to_inner_end_mm, to_outer_end_mm:
          its distances from the ends of the face, negative beyond them.
        - pressure_angle_deg: slope of the common normal there; NaN for flanks with modifications or
          deviations and beyond the ends of the face, where the contact is searched.

        Returns
        -------
        pd.DataFrame
            The table.
        """
        return unloaded_table(self.flanks)

    def loaded(self, torques: Torques = None) -> pd.DataFrame:
        """Solve the contact of both flanks under torques; see `contact()`.

        Parameters
        ----------
        torques : Torques
            Torques on the pinion, N m, rising; None for those of the config.

        Returns
        -------
        pd.DataFrame
            A row for each flank and torque: stiffness, transmission error, pressure, path. Raises what
            `contact` raises.
        """
        table: pd.DataFrame = self.solve(torques).content["by_torque"]
        return table.copy()

    def to_excel(self, path: str | Path) -> Path:
        """Write `table()` as a sheet of a workbook (.xlsx).

        Parameters
        ----------
        path : str or Path
            File to write.

        Returns
        -------
        Path
            The path. Raises MissingExtra where openpyxl is not installed.
        """
        from facegear.io.workbook import write

        with extras_named():
            return write(path, {"unloaded": self.table()})

    def __repr__(self) -> str:
        approaches = ", ".join(f"{name} {1e6 * flank.approach:.4g} um" for name, flank in self.flanks.items())
        return f"DisplacedContact(approach of flanks: {approaches})"
