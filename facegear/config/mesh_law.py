"""The load-dependent law of each gear's flanks from the arrays that its stage stores."""

from facegear.arrays import Arrays
from facegear.geometry.flank_errors import GEARS
from facegear.mesh_law.force_table import ForceTable
from facegear.transmission.layout import Layout
from facegear.transmission.machine import FlankTables


def flank_tables(law: Arrays, layout: Layout) -> tuple[FlankTables, ...]:
    """Tables of the flanks at each gear of a machine; one gear alone has the upper one's."""
    tables = [
        ForceTable(levels, forces, slopes)
        for levels, forces, slopes in zip(law["level_m"], law["force_n"], law["slope_n_per_m"], strict=True)
    ]
    rows = [GEARS.index(gear.side.value) if len(layout.gears) > 1 else 0 for gear in layout.gears]
    numbers = law["flank_variant"][rows]
    return tuple(FlankTables(tables[drive], tables[back]) for drive, back in numbers)
