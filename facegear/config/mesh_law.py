"""The load-dependent law of each gear's flanks from the arrays that its stage stores."""

from collections.abc import Callable
from functools import cache

from facegear.arrays import Array, Arrays
from facegear.geometry.flank_errors import GEARS
from facegear.mesh_law.force_table import ForceTable
from facegear.transmission.layout import Layout, Side
from facegear.transmission.machine import FlankTables

TablesOf = Callable[[Layout], tuple[FlankTables, ...]]
"""Tables of the flanks at each gear of a machine."""


def flank_tables(law: Arrays, layout: Layout) -> tuple[FlankTables, ...]:
    """Return the tables of the flanks at each gear of a machine.

    Parameters
    ----------
    law : mapping of arrays
        Arrays `law` of stage mesh_law: `level_m`, `force_n` and `slope_n_per_m`, with the tables of
        `ForceTable` along the first axis, and the numbers `flank_variant` (gears, 2) of the tables for
        the drive and back flank of each gear.
    layout : Layout
        Layout of the machine.

    Returns
    -------
    tuple[FlankTables, ...]
        One entry for each gear; a gear alone has the tables of the upper one.
    """
    return tables_of(law)(layout)


def tables_of(law: Arrays) -> TablesOf:
    """Return a function that gives the tables of the flanks of many machines.

    Machines with the same gears share their tables.

    Parameters
    ----------
    law : mapping of arrays
        Arrays `law` of stage mesh_law, as in `flank_tables`.

    Returns
    -------
    TablesOf
        Function from a layout to the tables of its gears.
    """
    tables = [
        ForceTable(_read_only(levels), _read_only(forces), _read_only(slopes))
        for levels, forces, slopes in zip(law["level_m"], law["force_n"], law["slope_n_per_m"], strict=True)
    ]

    @cache
    def of_sides(sides: tuple[Side, ...]) -> tuple[FlankTables, ...]:
        rows = [GEARS.index(side.value) if len(sides) > 1 else 0 for side in sides]
        numbers = law["flank_variant"][rows]
        return tuple(FlankTables(tables[drive], tables[back]) for drive, back in numbers)

    return lambda layout: of_sides(tuple(gear.side for gear in layout.gears))


def _read_only(values: Array) -> Array:
    """Return a copy that refuses to be written into."""
    copy = values.copy()
    copy.flags.writeable = False
    return copy
