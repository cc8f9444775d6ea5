"""Damped modes of a machine whose face gears bend, over speed."""

from collections.abc import Iterator, Sequence

import numpy as np
import pandas as pd

from facegear.plots.colours import BLUE, RED, grey
from facegear.plots.description import Axis, Curve, Figure, Key, Look, Mark, Panel, Scatter, Text

OTHER_MODES = "other"
WORDS = {
    "standing": "standing waves",
    "forward": "forward waves",
    "backward": "backward waves",
    OTHER_MODES: "other modes",
}
IN_WAVES = 0.25
"""Part of the kinetic energy in the waves of one gear above which a mode is coloured and marked as theirs;
two equal gears may share a mode in halves."""
COLOURS = {"standing": grey(0.3), "forward": RED, "backward": BLUE, OTHER_MODES: grey(0.75)}
MARKERS = {"standing": "circle", "forward": "triangle-up", "backward": "triangle-down"}
"""Of crossings: their area grows with the square of how far the phases of the meshes add up."""
MARK_SIZE = 6.0


def machine_campbell(campbell: pd.DataFrame, crossings: pd.DataFrame, last_rpm: float, teeth: int) -> Figure:
    """Frequencies of the machine's modes over pinion speed with mesh harmonics.

    Marks: crossings with a mode whose energy is in the waves of a gear, larger where the phases of the meshes
    add up; those that no phase drives have no mark.
    """
    waves = crossings[crossings["energy_fraction"] >= IN_WAVES]
    bending = campbell[campbell["energy_fraction"] >= IN_WAVES]
    top = 1.02 * float((bending if len(bending) else campbell)["frequency_hz"].max())
    marks: list[Mark] = []
    kinds: dict[str, str] = {}
    for _, line in campbell.groupby("line"):
        kind = _wave(line) if line["energy_fraction"].mean() >= IN_WAVES else OTHER_MODES
        kinds[kind] = COLOURS[kind]
        look: Look = {"colour": COLOURS[kind], "width": 0.6, "opacity": 0.7}
        marks.append(Curve(line["speed_rpm"], 1e-3 * line["frequency_hz"], **look))
    marks += mesh_harmonics(crossings["harmonic"], last_rpm, top, teeth)
    marks += crossing_marks(waves)
    keys = [wave_key(kind) for kind in COLOURS if kind in kinds]
    return Figure([frame(marks, last_rpm, top)], title="Modes of the whole machine", keys=keys)


def mesh_harmonics(
    harmonics: pd.Series, last_rpm: float, top_hz: float, teeth: int
) -> Iterator[Curve | Text]:
    """Draw harmonics of the mesh frequency over speed, each with its name.

    Parameters
    ----------
    harmonics : Series
        Orders of the mesh frequency, dimensionless; the first is always drawn.
    last_rpm, top_hz : float
        Ends of the axes, rpm and Hz.
    teeth : int
        Teeth of the pinions, dimensionless.

    Yields
    ------
    Curve or Text
        The marks.
    """
    for number, harmonic in enumerate(sorted(set(harmonics) | {1})):
        mesh = harmonic * teeth / 60.0
        speeds = np.array([0.0, last_rpm])
        yield Curve(speeds, 1e-3 * mesh * speeds, colour=grey(0.5), line="dash", width=0.8)
        end = min(0.82 * last_rpm, (0.6 + 0.12 * number) * top_hz / mesh)
        yield Text(end, 1e-3 * mesh * end, f"{harmonic} x mesh", shift=(4.0, -7.0), paper=True)


def crossing_marks(crossings: pd.DataFrame) -> Iterator[Scatter]:
    """Mark every crossing in its wave's colour, larger where the phases of the meshes add up.

    Parameters
    ----------
    crossings : DataFrame
        Table of crossings with mesh harmonics.

    Yields
    ------
    Scatter
        The marks of one kind of wave.
    """
    for wave in MARKERS:
        rows = crossings[crossings["wave"] == wave]
        if len(rows):
            sizes = np.sqrt(MARK_SIZE) * rows["phase_factor"].abs().to_numpy()
            at = rows["speed_rpm"], 1e-3 * rows["frequency_hz"]
            yield Scatter(*at, sizes, colour=COLOURS[wave], marker=MARKERS[wave])


def wave_key(kind: str) -> Key:
    """Return the entry of the legend of a kind of mode.

    Parameters
    ----------
    kind : str
        One of COLOURS.

    Returns
    -------
    Key
        The entry.
    """
    return Key(WORDS[kind], COLOURS[kind], marker=MARKERS.get(kind, ""))


def frame(marks: Sequence[Mark], last_rpm: float, top: float) -> Panel:
    """Return the panel of frequencies up to `top` (Hz) over speed.

    Returns
    -------
    Panel
        The panel.
    """
    speed = Axis("Speed of the inputs", "rpm", low=0.0, high=last_rpm)
    return Panel(speed, Axis("Frequency", "kHz", low=0.0, high=1e-3 * top), marks, height=3.7)


def _wave(line: pd.DataFrame) -> str:
    if not line["nodal_diameters"].mode().iloc[0]:
        return "standing"
    return "forward" if np.median(line["forward_fraction"]) >= 0.5 else "backward"


def figures(
    campbell: pd.DataFrame, campbell_crossings: pd.DataFrame, last_rpm: float, teeth: int
) -> tuple[Figure, ...]:
    """Modes of the whole machine over speed."""
    return (machine_campbell(campbell, campbell_crossings, last_rpm, teeth),)
