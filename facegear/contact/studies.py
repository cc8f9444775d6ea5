"""Contact results of the cases of a study side by side: stiffness, transmission error, contact path."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from facegear.arrays import Arrays
from facegear.contact.summary import path_by_position


@dataclass(frozen=True, eq=False)
class StudiedContact:
    """Case of a study, or the machine itself (study and point `nominal`), and the results of its contact.

    `pair`: the record of its geometry; `ltca`, `by_torque`, `pressure`: as the contact stage stores them.
    """

    study: str
    point: str
    label: str
    pair: Mapping[str, Any]
    ltca: pd.DataFrame
    by_torque: pd.DataFrame
    pressure: Arrays

    @property
    def unloaded_path_mm(self) -> float:
        """Mean radius of the unloaded contact on the drive side, as assembled."""
        return float(np.mean(self.pair["unloaded"]["drive"]["path_pinion_y_mm"]))

    def torque_near(self, torque: float) -> float:
        """Return the solved torque nearest to a torque.

        Parameters
        ----------
        torque : float
            On the pinion, N m.

        Returns
        -------
        float
            Solved torque, N m.
        """
        return min(
            (float(solved_torque) for solved_torque in self.by_torque["torque_n_m"]),
            key=lambda t: abs(t - torque),
        )

    def label_at(self, torque: float) -> str:
        """Return the label, with the nearest solved torque where that differs.

        Parameters
        ----------
        torque : float
            On the pinion, N m.

        Returns
        -------
        str
            Text for a legend.
        """
        near = self.torque_near(torque)
        return self.label if near == torque else f"{self.label} ({near:g} N m)"

    @classmethod
    def from_columns(cls, points: Sequence[Sequence[str]], *fields: Sequence[Any]) -> "list[StudiedContact]":
        """Build cases from study, point and label of each, and columns of the other fields.

        Parameters
        ----------
        points : Sequence[Sequence[str]]
            Study, point and label of each case.
        fields : Sequence[Any]
            One sequence for each further field, in the order of the fields.

        Returns
        -------
        list of StudiedContact
            Cases in the order of `points`.
        """
        return [cls(*point, *parts) for point, *parts in zip(points, *fields, strict=True)]

    def over_pitch(self, torque: float) -> pd.DataFrame:
        """Return the rows of `ltca` at the solved torque nearest to a torque, with `path_radius_mm`, by
        position.

        Parameters
        ----------
        torque : float
            On the pinion, N m.

        Returns
        -------
        pd.DataFrame
            Columns LTCA_COLUMNS and `path_radius_mm`.
        """
        rows = self.ltca[self.ltca["torque_n_m"] == self.torque_near(torque)].sort_values("position")
        return rows.merge(path_by_position(self.pressure), on=["torque_n_m", "position"], how="left")


def study_table(cases: Sequence[StudiedContact]) -> pd.DataFrame:
    """Tabulate the cases of a study, one row a case and torque.

    Shifts (mm, positive outwards) are from the first case, the machine itself: `path_shift_mm` of the
    loaded path at the same torque (NaN where the machine was not solved at it), `unloaded_path_shift_mm`
    of the unloaded one.

    Parameters
    ----------
    cases : Sequence[StudiedContact]
        Cases, the machine itself first.

    Returns
    -------
    pd.DataFrame
        Columns study, point and label, those of `by_torque`, unloaded path radius, both shifts and
        backlash_um.
    """
    machine = cases[0]
    nominal_radius = machine.by_torque.set_index("torque_n_m")["path_radius_mm"]
    parts = []
    for case in cases:
        rows = case.by_torque.copy()
        for column, name in enumerate(("study", "point", "label")):
            rows.insert(column, name, getattr(case, name))
        rows["path_shift_mm"] = rows["path_radius_mm"] - rows["torque_n_m"].map(nominal_radius)
        rows["unloaded_path_radius_mm"] = case.unloaded_path_mm
        rows["unloaded_path_shift_mm"] = case.unloaded_path_mm - machine.unloaded_path_mm
        rows["backlash_um"] = float(case.pair["backlash_um"]["smallest"])
        parts.append(rows)
    return pd.concat(parts, ignore_index=True)
