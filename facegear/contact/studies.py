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
    """A case of a study, or the machine itself (study and point `nominal`), and what its contact gave.

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
        """The solved torque (N m) nearest to `torque`."""
        return min((float(solved) for solved in self.by_torque["torque_n_m"]), key=lambda t: abs(t - torque))

    def label_at(self, torque: float) -> str:
        """The label, with the torque of `torque_near` where that is another."""
        near = self.torque_near(torque)
        return self.label if near == torque else f"{self.label} ({near:g} N m)"

    @classmethod
    def several(cls, points: Sequence[Sequence[str]], *stored: Sequence[Any]) -> "list[StudiedContact]":
        """Cases of which study, point and label are given; `stored`: the other fields of each, in order."""
        return [cls(*point, *parts) for point, *parts in zip(points, *stored, strict=True)]

    def over_pitch(self, torque: float) -> pd.DataFrame:
        """Rows of `ltca` at the torque nearest to `torque` (N m) with `path_radius_mm`, by position."""
        rows = self.ltca[self.ltca["torque_n_m"] == self.torque_near(torque)].sort_values("position")
        return rows.merge(path_by_position(self.pressure), on=["torque_n_m", "position"], how="left")


def study_table(cases: Sequence[StudiedContact]) -> pd.DataFrame:
    """One row a case and torque: columns of `by_torque`, backlash, unloaded path, and both paths' shifts.

    Shifts (mm, positive outwards) are from the first case, the machine itself: `path_shift_mm` of the loaded
    path at the same torque (NaN where the machine was not solved at it), `unloaded_path_shift_mm` of the
    unloaded one.
    """
    machine = cases[0]
    loaded = machine.by_torque.set_index("torque_n_m")["path_radius_mm"]
    parts = []
    for case in cases:
        rows = case.by_torque.copy()
        for column, name in enumerate(("study", "point", "label")):
            rows.insert(column, name, getattr(case, name))
        rows["path_shift_mm"] = rows["path_radius_mm"] - rows["torque_n_m"].map(loaded)
        rows["unloaded_path_radius_mm"] = case.unloaded_path_mm
        rows["unloaded_path_shift_mm"] = case.unloaded_path_mm - machine.unloaded_path_mm
        rows["backlash_um"] = float(case.pair["backlash_um"]["smallest"])
        parts.append(rows)
    return pd.concat(parts, ignore_index=True)
