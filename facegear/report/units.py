"""Units in names of columns and keys, as they are written."""

UNITS = {
    "kn": "kN",
    "n_per_um": "N/µm",
    "n_per_mm": "N/mm",
    "n_per_m": "N/m",
    "n_m_per_rad": "N m/rad",
    "n_m": "N m",
    "rpm": "rpm",
    "deg": "deg",
    "mpa": "MPa",
    "hz": "Hz",
    "um": "µm",
    "mm": "mm",
    "kw": "kW",
    "kg_m2": "kg m2",
    "kg": "kg",
    "urad": "µrad",
    "percent": "%",
    "n": "N",
}
"""Units that end a column's name, as they are written."""
ENGINEERING = {"n_per_m": ("n_per_um", 1e-6, 0.0), "n": ("kn", 1e-3, 1e3)}
"""Unit in which a table is written instead, its factor, and the largest number from which it is."""


def unit_of(name: str) -> str:
    """The unit in a column's name or a key of the config, as it is written; nothing where it has none."""
    return UNITS.get(ending_of(name), "")


def ending_of(name: str) -> str:
    """The unit in a column's name, a key of UNITS; nothing where it has none."""
    return next((ending for ending in UNITS if f"_{ending} " in f"{name} "), "")
