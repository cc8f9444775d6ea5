"""Colours of figures, which people tell apart who see no red or no green."""

from collections.abc import Iterable
from functools import cache
from math import ceil, floor, log10
from types import MappingProxyType
from typing import Any

# Colours after Okabe and Ito, as web browsers write them.
BLACK, BLUE, RED, GREEN = "#000000", "#0072B2", "#D55E00", "#009E73"
PURPLE, ORANGE, SKY, WHITE = "#CC79A7", "#E69F00", "#56B4E9", "#ffffff"
"""Further colours after Okabe and Ito, and white."""
COLOURS = (BLACK, BLUE, RED, GREEN, PURPLE, ORANGE, SKY)
"""Colours after Okabe and Ito, in the order in which curves take them."""
GEAR_LINES = MappingProxyType({"lower": "solid", "upper": "dash"})
"""Lines of the meshes with each gear; the colour is the pinion's."""


def grey(level: float) -> str:
    """Return a grey.

    Parameters
    ----------
    level : float
        From 0 (black) to 1 (white), dimensionless.

    Returns
    -------
    str
        The colour, as `#rrggbb`.
    """
    return "#" + 3 * f"{round(255 * level):02x}"


def channels(colour: str) -> tuple[float, float, float]:
    """Return red, green and blue of a colour.

    Parameters
    ----------
    colour : str
        The colour, as `#rrggbb`.

    Returns
    -------
    tuple of float
        From 0 to 1, dimensionless.
    """
    red, green, blue = (int(colour[position : position + 2], 16) / 255 for position in (1, 3, 5))
    return red, green, blue


def colour_of(number: int) -> str:
    """Return the colour of a curve by its number; after the last of COLOURS the first follows again.

    Parameters
    ----------
    number : int
        From 0, dimensionless.

    Returns
    -------
    str
        One of COLOURS.
    """
    return COLOURS[number % len(COLOURS)]


def scale_colours(name: str, positions: Iterable[float]) -> list[str]:
    """Return colours of a scale.

    Parameters
    ----------
    name : str
        Name of the scale as matplotlib has it (`viridis`).
    positions : iterable of float
        Positions on the scale from 0 to 1, dimensionless.

    Returns
    -------
    list of str
        Colours as `#rrggbb`.
    """
    return [_scale_colour(name, float(position)) for position in positions]


@cache
def _scale_colour(name: str, position: float) -> str:
    """Return the colour `#rrggbb` of the matplotlib scale `name` at a position from 0 to 1."""
    from matplotlib import colormaps, colors  # a figure is data: only its drawing and scales need the library

    return str(colors.to_hex(colormaps[name](position)))


def shades(count: int, last: float = 0.85) -> list[str]:
    """Return colours from dark to bright for curves in an order, such as torques.

    Parameters
    ----------
    count : int
        Number of curves, dimensionless.
    last : float
        Place of the last one on the scale, dimensionless: the brightest cannot be seen on white.

    Returns
    -------
    list of str
        Colours as `#rrggbb`.
    """
    return scale_colours("viridis", (last * number / max(count - 1, 1) for number in range(count)))


def mesh_looks(meshes: Iterable[str]) -> dict[str, dict[str, Any]]:
    """Return colour and line of each mesh: a colour for each pinion, a line for each gear.

    Parameters
    ----------
    meshes : iterable of str
        Names of meshes, as `pinion/upper` or `pinion/lower`.

    Returns
    -------
    dict
        Keywords `colour` and `line` of a curve by mesh.
    """
    parts = {mesh: mesh.rpartition("/")[::2] for mesh in meshes}
    pinions = list(dict.fromkeys(pinion for pinion, _ in parts.values()))
    return {
        mesh: {"colour": COLOURS[pinions.index(pinion) % len(COLOURS)], "line": GEAR_LINES[gear]}
        for mesh, (pinion, gear) in parts.items()
    }


def round_levels(low: float, high: float, count: int = 10) -> tuple[float, ...]:
    """Return round levels around values.

    Parameters
    ----------
    low, high : float
        Smallest and largest value, any unit.
    count : int
        About how many steps between the levels, dimensionless.

    Returns
    -------
    tuple of float
        Levels at multiples of 1, 2 or 5 of a power of ten, the first not above, the last above the values.
    """
    rough = max(high - low, 1e-9 * abs(high), 1e-12) / count
    power = 10.0 ** floor(log10(rough))
    step = next(factor * power for factor in (1.0, 2.0, 5.0, 10.0) if factor * power >= 0.999 * rough)
    return tuple(step * number for number in range(floor(low / step), ceil(high / step + 1e-9) + 1))
