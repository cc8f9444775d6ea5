"""The modal stage's csv tables."""

import pandas as pd

from facegear.transmission.layout import Layout
from facegear.transmission.mode_classes import ModeName
from facegear.transmission.modes import Modes


def frequency_table(modes: Modes, names: tuple[ModeName, ...]) -> pd.DataFrame:
    """Columns order, frequency_hz, multiplicity, symbols, class, pinion_energy_share."""
    multiplicity = [stop - start for start, stop in modes.groups for _ in range(stop - start)]
    return pd.DataFrame(
        {
            "order": range(1, len(names) + 1),
            "frequency_hz": modes.frequencies,
            "multiplicity": multiplicity,
            "symbols": [name.symbols for name in names],
            "class": [name.mode_class.value for name in names],
            "pinion_energy_share": [name.pinion_share for name in names],
        }
    )


def shape_table(layout: Layout, modes: Modes) -> pd.DataFrame:
    """Columns order, body, dof, amplitude_m_or_rad (unit modal mass), relative (to the mode's largest)."""
    rows = []
    names = [name.rsplit(":", 1) for name in layout.dof_names]
    for order, shape in enumerate(modes.shapes.T, start=1):
        largest = shape[abs(shape).argmax()]
        for (body, letter), amplitude in zip(names, shape, strict=True):
            rows.append((order, body, letter, amplitude, amplitude / largest))
    return pd.DataFrame(rows, columns=["order", "body", "dof", "amplitude_m_or_rad", "relative"])
