"""The csv tables of a sweep."""

from dataclasses import asdict

import numpy as np
import pandas as pd

from facegear.dynamics.sweeps.assemble import Seam
from facegear.dynamics.sweeps.campbell import peaks, resonance
from facegear.dynamics.sweeps.sweep import DEFLECTION, FACTS, TRANSLATION, Piece
from facegear.dynamics.sweeps.whole_sweep import Direction
from facegear.transmission.layout import Layout
from facegear.transmission.modes import Modes

UM = 1e6
SHARES = ("open_share", "drive_share", "back_share")


def sweep_table(layout: Layout, direction: str, piece: Piece) -> pd.DataFrame:
    """Columns direction, speed_rpm, quantity, body_or_mesh, value, class; the unit stands in the quantity."""
    order = np.argsort(piece.speeds)
    frames = []

    def add(quantity: str, item: str, values: np.ndarray) -> None:
        frames.append(
            pd.DataFrame(
                {
                    "direction": direction,
                    "speed_rpm": piece.speeds[order],
                    "quantity": quantity,
                    "body_or_mesh": item,
                    "value": values[order],
                    "class": piece.labels[order],
                }
            )
        )

    for m, mesh in enumerate(layout.mesh_names):
        for row, name in enumerate(DEFLECTION):
            add(f"deflection_{name}_um", mesh, UM * piece.deflection[:, row, m])
        add("mean_force_n", mesh, piece.force[:, 0, m])
        add("mean_force_magnitude_n", mesh, piece.force[:, 1, m])
        for row, name in enumerate(SHARES):
            add(name, mesh, piece.shares[:, row, m])
    for b, body in enumerate(layout.body_names):
        for axis, letter in enumerate("xyz"):
            if piece.translation[:, 0, b, axis].max() > 0.0:
                for row, name in enumerate(TRANSLATION):
                    add(f"{letter}_{name}_um", body, UM * piece.translation[:, row, b, axis])
    for row, name in enumerate(FACTS):
        add(name, "machine", piece.facts[:, row])
    return pd.concat(frames, ignore_index=True).dropna(subset="value")


JUMP_COLUMNS = (
    "direction",
    "speed_before_rpm",
    "speed_after_rpm",
    "mesh",
    "deflection_ac_rms_before_um",
    "deflection_ac_rms_after_um",
    "class_before",
    "class_after",
    "leading_multiplier_before",
    "resonance",
    "resonance_rpm",
    "energy_share",
)
RESONANCE_COLUMNS = (
    "direction",
    "speed_rpm",
    "quantity",
    "body_or_mesh",
    "value",
    "class",
    "resonance",
    "resonance_rpm",
    "energy_share",
)


def jump_table(layout: Layout, name: str, direction: Direction, modes: Modes) -> pd.DataFrame:
    """One row for each jump: bracket, mesh that changes most, AC RMS, classes, multiplier, resonance."""
    rows = []
    for jump in direction.jumps:
        belongs = resonance(direction.piece, jump.largest, modes, layout.pinion_teeth)
        rows.append(
            (
                name,
                jump.speed_before,
                jump.speed_after,
                layout.mesh_names[jump.mesh],
                UM * jump.before[jump.mesh],
                UM * jump.after[jump.mesh],
                jump.label_before,
                jump.label_after,
                jump.multiplier,
                belongs.name,
                belongs.predicted_rpm,
                belongs.share,
            )
        )
    return pd.DataFrame(rows, columns=list(JUMP_COLUMNS))


def resonance_table(layout: Layout, direction: str, piece: Piece, modes: Modes) -> pd.DataFrame:
    """Local maxima of the AC RMS, each with the mode it belongs to."""
    rows = []
    for quantity, item, position, value in peaks(piece):
        belongs = resonance(piece, position, modes, layout.pinion_teeth)
        names = layout.mesh_names if quantity == "deflection" else layout.body_names
        rows.append(
            (
                direction,
                piece.speeds[position],
                f"{quantity}_ac_rms_um",
                names[item],
                UM * value,
                piece.labels[position],
                belongs.name,
                belongs.predicted_rpm,
                belongs.share,
            )
        )
    return pd.DataFrame(rows, columns=list(RESONANCE_COLUMNS))


def seam_table(seams: list[Seam]) -> pd.DataFrame:
    """Where chunks met: direction, speed_rpm, kind, rerun."""
    columns = ["direction", "speed_rpm", "kind", "rerun"]
    return pd.DataFrame([asdict(seam) | {"kind": seam.kind.value} for seam in seams], columns=columns)
