"""RMS over speed."""

from collections.abc import Iterator, Mapping, Sequence

import pandas as pd

from facegear.dynamics.sweeps.jump_kinds import JumpKind
from facegear.plots.colours import BLUE, GREEN, RED
from facegear.plots.description import Axis, Curve, Figure, Line, LineStyle, Panel

DIRECTION_STYLES: Mapping[str, tuple[str, LineStyle]] = {"up": (RED, "solid"), "down": (BLUE, "dash")}
AXIS_STYLES: Mapping[str, tuple[str, LineStyle]] = {
    "x": (RED, "solid"),
    "y": (BLUE, "dash"),
    "z": (GREEN, "dot"),
}
RMS_HEIGHT = 1.3
"""Inches of a panel of RMS over speed."""


def select(sweep: pd.DataFrame, direction: str, quantity: str, item: str) -> pd.DataFrame:
    """Rows of one curve, ordered by speed."""
    rows = sweep[
        (sweep["direction"] == direction) & (sweep["quantity"] == quantity) & (sweep["body_or_mesh"] == item)
    ]
    return rows.sort_values("speed_rpm")


def speed_axis(sweep: pd.DataFrame) -> Axis:
    """Return the axis of the swept speeds.

    Parameters
    ----------
    sweep : DataFrame
        Tidy table of a sweep.

    Returns
    -------
    Axis
        The axis, rpm.
    """
    return Axis("Input speed", "rpm", low=0.0, high=float(sweep["speed_rpm"].max()))


def rms_axis() -> Axis:
    """Return the axis of the RMS without mean of a mesh deflection.

    Returns
    -------
    Axis
        The axis, µm.
    """
    return Axis("RMS of d", "µm", low=0.0)


def translations(sweep: pd.DataFrame, bodies: Sequence[str], letters: str) -> Figure:
    """RMS (without mean) of translations, one panel for each body, first direction
    only.
    """
    direction = sweep["direction"].iloc[0]
    panels = []
    for body in bodies:
        curves = []
        for letter in letters:
            curve = select(sweep, direction, f"{letter}_ac_rms_um", body)
            colour, line = AXIS_STYLES[letter]
            curves.append(
                Curve(curve["speed_rpm"], curve["value"], f"{letter} direction", colour, line, width=1.0)
            )
        panels.append(
            Panel(speed_axis(sweep), Axis("RMS", "µm", low=0.0), curves, title=body, height=RMS_HEIGHT)
        )
    return Figure(panels, title=f"RMS of translations without their mean, sweep {direction}")


def mesh_sweeps(
    sweep: pd.DataFrame, jumps: pd.DataFrame, pinions: Sequence[str], sides: Sequence[str]
) -> Figure:
    """RMS (without mean) of mesh deflections up and down, a panel for each mesh; jumps are marked, and where
    irregular motion begins or ends.
    """
    panels = []
    for pinion, side in [(pinion, side) for side in sides for pinion in pinions]:
        marks: list[Curve | Line] = []
        for direction, (colour, line) in DIRECTION_STYLES.items():
            curve = select(sweep, direction, "deflection_ac_rms_um", f"{pinion}/{side}")
            marks.append(Curve(curve["speed_rpm"], curve["value"], direction, colour, line, width=1.0))
        marks += jump_ticks(jumps)
        title = f"{pinion} and {side} face gear"
        panels.append(Panel(speed_axis(sweep), rms_axis(), marks, title=title, height=RMS_HEIGHT))
    return Figure(
        panels,
        title="RMS of the deflection d along the line of action without its mean\n"
        "ticks: jumps; dotted: irregular motion begins or ends"
        if len(jumps)
        else "RMS of the deflection d along the line of action without its mean",
        legend_title="sweep",
    )


def jump_ticks(jumps: pd.DataFrame) -> Iterator[Line]:
    """Mark on the speed axis where the response jumps, in the colour of the direction.

    Parameters
    ----------
    jumps : DataFrame
        Table of the jumps of a sweep.

    Yields
    ------
    Line
        A short tick; a dotted one where irregular motion begins or ends.
    """
    for jump in jumps.itertuples():
        colour, _ = DIRECTION_STYLES[jump.direction]
        irregular = jump.kind == JumpKind.IRREGULAR
        line: LineStyle = "dot" if irregular else "solid"
        yield Line(
            jump.speed_after_rpm, colour=colour, line=line, width=1.2, part=0.12 if irregular else 0.04
        )
