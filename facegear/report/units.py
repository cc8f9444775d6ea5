"""Units in names of columns and keys, as they are written."""

UNITS = {
    "n_per_mm": "N/mm",
    "n_per_m": "N/m",
    "n_m_per_rad": "N m/rad",
    "n_m": "N m",
    "rpm": "rpm",
    "deg": "deg",
    "mpa": "MPa",
    "hz": "Hz",
    "um": "um",
    "mm": "mm",
    "kw": "kW",
    "kg_m2": "kg m2",
    "kg": "kg",
    "urad": "urad",
    "percent": "%",
    "n": "N",
}
"""Units that end a column's name, as they are written."""


def unit_of(name: str) -> str:
    """The unit in a column's name or a key of the config, as it is written; nothing where it has none."""
    return UNITS.get(ending_of(name), "")


def ending_of(name: str) -> str:
    """The unit in a column's name, a key of UNITS; nothing where it has none."""
    return next((ending for ending in UNITS if f"_{ending} " in f"{name} "), "")
