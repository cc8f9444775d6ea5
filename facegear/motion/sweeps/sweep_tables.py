"""The csv tables of a sweep, the modes of its resonances, and one line about what was found."""

from collections import Counter
from collections.abc import Mapping
from dataclasses import asdict, dataclass

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.machine.layout import Layout
from facegear.machine.modes import Modes
from facegear.motion.between_samples import local_maxima
from facegear.motion.plan import JumpKind
from facegear.motion.steady_state.response import SteadyState
from facegear.motion.sweeps.sweep import DEFLECTION, TRANSLATION, Piece
from facegear.motion.sweeps.whole_sweep import Direction, Seam
from facegear.number_format import count_noun

PROMINENT = 1.15
"""Ratio of a maximum to the higher of the valleys beside it from which it counts."""
SMALL = 0.1
"""Maxima below this fraction of the largest do not count."""


@dataclass(frozen=True)
class Resonance:
    """The natural mode that holds most of a response's energy.

    Attributes
    ----------
    mode : int
        Number in the frequency table, from 1.
    frequency_hz : float
        Natural frequency.
    order : float
        Multiple of the mesh frequency at which it moves most.
    fraction : float
        Fraction of the energy of all modes.
    predicted_rpm : float
        Speed at which that multiple meets the mode's linear frequency.
    """

    mode: int
    frequency_hz: float
    order: float
    fraction: float
    predicted_rpm: float

    @property
    def name(self) -> str:
        """Name such as `mode 17 at 1x`."""
        return f"mode {self.mode} at {self.order:g}x"


def resonance(piece: Piece, position: int, modes: Modes, teeth: int) -> Resonance:
    """Find the natural mode that holds most of a response's energy, of all modes or groups of equal
    frequency.

    Parameters
    ----------
    piece : Piece
        Results of a sweep.
    position : int
        Index of the speed in the piece.
    modes : Modes
        Natural modes of the machine.
    teeth : int
        Number of teeth of the pinion.

    Returns
    -------
    Resonance
        Strongest mode.
    """
    energy = piece.modal[position] ** 2
    groups = [energy[start:stop].sum() for start, stop in modes.groups]
    start, _ = modes.groups[int(np.argmax(groups))]
    frequency = float(modes.frequencies[start])
    order = float(piece.modal_order[position])
    fraction = float(max(groups) / max(energy.sum(), 1e-300))
    return Resonance(start + 1, frequency, order, fraction, 60.0 * frequency / (order * teeth))


def peaks(piece: Piece) -> list[tuple[str, int, int, float]]:
    """Find the local maxima of the AC RMS over speed.

    A maximum counts if it stands 15 % over the minimum on either side before a larger value comes.

    Parameters
    ----------
    piece : Piece
        Results of a sweep.

    Returns
    -------
    list of tuple
        Quantity (deflection, x, y or z), index of the mesh or body, index of the speed, AC RMS in m.
    """
    rows = []
    for mesh, curve in enumerate(piece.deflection_ac_rms.T):
        rows += [("deflection", mesh, i, float(curve[i])) for i in maxima(curve)]
    translations = piece.translation_ac_rms
    for body in range(translations.shape[1]):
        for axis, letter in enumerate("xyz"):
            curve = translations[:, body, axis]
            if curve.max() > 1e-12:
                rows += [(letter, body, i, float(curve[i])) for i in maxima(curve)]
    return rows


def maxima(curve: Array) -> list[int]:
    """Find the maxima above PROMINENT times the higher valley beside them, and at least SMALL times the
    largest value.

    Parameters
    ----------
    curve : (P,) array
        AC RMS over speed, any unit.

    Returns
    -------
    list of int
        Positions.
    """
    positions, prominences = local_maxima(curve)
    heights = curve[positions]
    stands_out = heights > PROMINENT * (heights - prominences)
    return [int(i) for i in positions[(heights >= SMALL * curve.max()) & stands_out]]


UM = 1e6
"""Micrometres in a metre."""
STILL = 1e-12
"""Fraction of the largest RMS translation up to which a body moves in a direction by rounding alone."""
PER_MESH = {
    **{f"deflection_{name}_um": (UM, f"deflection_{name}") for name in DEFLECTION},
    "mean_elastic_force_n": (1.0, "mean_force"),
    "mean_elastic_force_magnitude_n": (1.0, "mean_force_magnitude"),
    "largest_elastic_force_n": (1.0, "largest_force"),
    "largest_pull_n": (1.0, "largest_pull"),
    **{name: (1.0, name) for name in ("open_fraction", "drive_fraction", "back_fraction")},
}
"""Quantity of the table: factor to its unit, and field of a Piece."""
PER_SPEED = (
    "residual",
    "leading_multiplier",
    "exponent_per_period",
    "exponent_interval",
    "periods_run",
    "first_look_period",
    "second_look_period",
)
"""Quantities of the table with one value for each speed."""


def sweep_table(layout: Layout, direction: str, piece: Piece) -> pd.DataFrame:
    """Tabulate the numbers of a sweep over speed.

    Directions in which a body moves by rounding alone are left out. `past_law_fraction` is present where a
    mesh is past its law at some speed.

    Parameters
    ----------
    layout : Layout
        Names of meshes and bodies.
    direction : str
        Entry of the column direction.
    piece : Piece
        Results in the order of running.

    Returns
    -------
    DataFrame
        One row for each quantity, body or mesh (`machine` for quantities of the whole), and speed,
        ascending. Columns direction, speed_rpm, quantity, body_or_mesh, value, class, periodic,
        after_irregular, symmetry_broken. The unit is part of the quantity.
    """
    order, labels = np.argsort(piece.speeds), np.array(piece.labels)
    curves: list[tuple[str, str, np.ndarray]] = []

    def add(quantity: str, item: str, values: np.ndarray) -> None:
        curves.append((quantity, item, values[order]))

    for m, mesh in enumerate(layout.mesh_names):
        for quantity, (factor, field) in PER_MESH.items():
            add(quantity, mesh, factor * getattr(piece, field)[:, m])
        if piece.past_law_fraction.any():
            add("past_law_fraction", mesh, piece.past_law_fraction[:, m])
    rounding = STILL * piece.translation_rms.max(initial=0.0)
    for b, body in enumerate(layout.body_names):
        for axis, letter in enumerate("xyz"):
            if piece.translation_rms[:, b, axis].max() > rounding:
                for name in TRANSLATION:
                    add(f"{letter}_{name}_um", body, UM * getattr(piece, f"translation_{name}")[:, b, axis])
    for name in PER_SPEED:
        add(name, "machine", getattr(piece, name))
    quantities, items, values = zip(*curves, strict=True)
    table = {
        "direction": direction,
        "speed_rpm": np.tile(piece.speeds[order], len(curves)),
        "quantity": np.repeat(quantities, order.size),
        "body_or_mesh": np.repeat(items, order.size),
        "value": np.concatenate(values),
        "class": np.tile(labels[order], len(curves)),
        "periodic": np.tile(piece.periodic[order], len(curves)),
        "after_irregular": np.tile(piece.after_irregular[order], len(curves)),
        "symmetry_broken": np.tile(piece.symmetry_broken[order], len(curves)),
    }
    return pd.DataFrame(table).dropna(subset="value")


JUMP_COLUMNS = (
    "direction",
    "kind",
    "speed_before_rpm",
    "speed_after_rpm",
    "error_rpm",
    "mesh",
    "deflection_ac_rms_before_um",
    "deflection_ac_rms_after_um",
    "class_before",
    "class_after",
    "leading_multiplier_before",
    "resonance",
    "resonance_rpm",
    "energy_fraction",
    "mode",
    "order",
    "periodic_before",
    "periodic_after",
    "after_irregular",
    "symmetry_broken",
)
"""Columns of the table of jumps; units stand in the names."""
RESONANCE_COLUMNS = (
    "direction",
    "speed_rpm",
    "quantity",
    "body_or_mesh",
    "value",
    "class",
    "resonance",
    "resonance_rpm",
    "energy_fraction",
    "mode",
    "order",
    "periodic",
    "after_irregular",
    "symmetry_broken",
)
"""Columns of the table of peaks and the modes nearest to them; units stand in the names."""


def jump_table(layout: Layout, name: str, direction: Direction, modes: Modes) -> pd.DataFrame:
    """Tabulate the jumps: bracket, mesh that changes most, AC RMS, classes, multiplier, resonance.

    Parameters
    ----------
    layout : Layout
        Names of the meshes.
    name : str
        Entry of the column direction.
    direction : Direction
        Results of the direction.
    modes : Modes
        Natural modes of the machine.

    Returns
    -------
    DataFrame
        JUMP_COLUMNS. `order`: multiple of the mesh frequency at which the mode moves most. `after_irregular`:
        that of the speed after the one with the larger response. `symmetry_broken`: whether the motion on one
        side has mirror images.
    """
    rows = []
    for jump in direction.jumps:
        before, after = jump.before, jump.after
        rows.append(
            {
                "direction": name,
                "kind": jump.kind.value,
                "speed_before_rpm": before.speed,
                "speed_after_rpm": after.speed,
                "error_rpm": jump.error,
                "mesh": layout.mesh_names[jump.mesh],
                "deflection_ac_rms_before_um": UM * before.ac_rms[jump.mesh],
                "deflection_ac_rms_after_um": UM * after.ac_rms[jump.mesh],
                "class_before": before.label,
                "class_after": after.label,
                "leading_multiplier_before": before.multiplier,
                **_belongs(resonance(direction.piece, jump.largest, modes, layout.pinion_teeth)),
                "periodic_before": before.period > 0,
                "periodic_after": after.period > 0,
                "after_irregular": _after_irregular(direction.piece, jump.largest),
                "symmetry_broken": before.symmetry_broken or after.symmetry_broken,
            }
        )
    return pd.DataFrame(rows, columns=list(JUMP_COLUMNS))


def resonance_table(layout: Layout, direction: str, piece: Piece, modes: Modes) -> pd.DataFrame:
    """Tabulate the local maxima of the AC RMS, each with the mode to which it belongs.

    Parameters
    ----------
    layout : Layout
        Names of meshes and bodies.
    direction : str
        Entry of the column direction.
    piece : Piece
        Results in the order of running.
    modes : Modes
        Natural modes of the machine.

    Returns
    -------
    DataFrame
        RESONANCE_COLUMNS. `value`: AC RMS in um. `after_irregular`: that of the next speed, since a
        maximum needs both its neighbours.
    """
    rows, labels = [], piece.labels
    for quantity, item, position, value in peaks(piece):
        names = layout.mesh_names if quantity == "deflection" else layout.body_names
        rows.append(
            {
                "direction": direction,
                "speed_rpm": piece.speeds[position],
                "quantity": f"{quantity}_ac_rms_um",
                "body_or_mesh": names[item],
                "value": UM * value,
                "class": labels[position],
                **_belongs(resonance(piece, position, modes, layout.pinion_teeth)),
                "periodic": piece.periodic[position],
                "after_irregular": _after_irregular(piece, position),
                "symmetry_broken": piece.symmetry_broken[position],
            }
        )
    return pd.DataFrame(rows, columns=list(RESONANCE_COLUMNS))


def _after_irregular(piece: Piece, position: int) -> bool:
    """Whether a motion of the run up to the speed after this position, in the order of running, is not
    periodic.
    """
    return bool(piece.after_irregular[: position + 2].any())


def _belongs(resonance: Resonance) -> dict[str, str | int | float]:
    """Return a resonance as the columns resonance (name), resonance_rpm, energy_fraction, mode and order
    of a row.
    """
    return {
        "resonance": resonance.name,
        "resonance_rpm": resonance.predicted_rpm,
        "energy_fraction": resonance.fraction,
        "mode": resonance.mode,
        "order": resonance.order,
    }


def seam_table(seams: list[Seam]) -> pd.DataFrame:
    """Tabulate where chunks met.

    Parameters
    ----------
    seams : list of Seam
        Seams.

    Returns
    -------
    DataFrame
        Columns direction, speed_rpm, kind, rerun (number of speeds run again), see Seam.
    """
    columns = ["direction", "speed_rpm", "kind", "rerun"]
    return pd.DataFrame([asdict(seam) | {"kind": seam.kind.value} for seam in seams], columns=columns)


PULLS = 1e-3
"""Pull of a damper, over the largest elastic mesh force, from which it is reported."""


def response_summary(response: SteadyState) -> str:
    """Summarise the largest mesh force, class of motion, largest open fraction, and pull of the dampers.

    Parameters
    ----------
    response : SteadyState
        Response.

    Returns
    -------
    str
        One line.
    """
    parts = [f"largest mesh force {np.abs(response.forces).max():.4g} N", response.label]
    if response.looks is not None:
        parts.append(" from one start and ".join(map(str, response.looks)) + " from another")
    parts.append(f"open for up to {100.0 * response.fractions[0].max():.0f} % of the time")
    past = float(response.past_law.max())
    if past > 0.0:
        parts.append(f"past the mesh law's last level for up to {100.0 * past:.2g} % of the time")
    pull = float(response.averages.pull.max())
    if pull > PULLS * np.abs(response.forces).max():
        parts.append(f"mesh dampers pull by up to {pull:.0f} N before flanks part")
    return ", ".join(parts)


def sweep_summary(directions: Mapping[str, Direction]) -> str:
    """Summarise jumps and periodic speeds in each direction, and seams that have not forgotten, if there are
    any.

    Parameters
    ----------
    directions : mapping
        Results of a sweep, by direction.

    Returns
    -------
    str
        One line.
    """
    parts = []
    for name, direction in directions.items():
        periods = direction.piece.period
        counts = f"{int((periods > 0).sum())} of {count_noun(len(periods), 'speed')} periodic"
        irregular = sum(seam.kind.value == "irregular" for seam in direction.seams)
        rerun = sum(seam.rerun for seam in direction.seams)
        changes = Counter(jump.kind is JumpKind.IRREGULAR for jump in direction.jumps)
        jumps = count_noun(changes[False], "jump")
        seams = f", seams: {count_noun(rerun, 'speed')} run again, {irregular} irregular" * bool(
            rerun or irregular
        )
        parts.append(f"{name}: {jumps}, {counts}{seams}")
    return "; ".join(parts)
