"""Units in names of columns and keys, as they are written."""

from facegear.number_format import format_number

UNITS = {
    "kn": "kN",
    "n_per_um": "N/µm",
    "n_per_mm": "N/mm",
    "n_per_m": "N/m",
    "n_s_per_m": "N s/m",
    "n_m_per_rad": "N m/rad",
    "n_m": "N m",
    "rpm": "rpm",
    "deg": "deg",
    "mpa": "MPa",
    "hz": "Hz",
    "um": "µm",
    "mm": "mm",
    "kw": "kW",
    "kwh": "kWh",
    "kg_m2": "kg m2",
    "kg": "kg",
    "urad": "µrad",
    "percent": "%",
    "m_per_s": "m/s",
    "rad_per_s": "rad/s",
    "per_s": "1/s",
    "w_per_m": "W/m",
    "w_per_k": "W/K",
    "hours": "h",
    "w": "W",
    "k": "K",
    "c": "°C",
    "s": "s",
    "n": "N",
}
"""Units that end a column's name, as they are written; those that end another one stand after it."""
ENGINEERING = {"n_per_m": ("n_per_um", 1e-6, 0.0), "n": ("kn", 1e-3, 1e3), "w": ("kw", 1e-3, 1e3)}
"""Unit in which a table is written instead, its factor, and the largest number from which it is."""

UNNAMED = ("transmission", "tooth_pair", "dynamics", "contact", "load_sharing")
"""Sections whose keys say what they are without the section's name."""


def unit_of(name: str) -> str:
    """Return the unit in a column's name or a key of the config, as it is written.

    Parameters
    ----------
    name : str
        Name of the column, or the key.

    Returns
    -------
    str
        The unit; empty where the name has none.
    """
    return UNITS.get(ending_of(name), "")


def ending_of(name: str) -> str:
    """Return the unit in a column's name.

    Parameters
    ----------
    name : str
        Name of the column.

    Returns
    -------
    str
        A key of UNITS; empty where the name has no unit.
    """
    return next((ending for ending in UNITS if f"_{ending} " in f"{name} "), "")


def value_in_words(key: str, value: object) -> str:
    """Write a changed key of the config with its value as a legend reads it.

    Parameters
    ----------
    key : str
        Dotted key of the config; its unit ends its name.
    value : object
        The value, in the unit of the key.

    Returns
    -------
    str
        Words, number and unit.

    Examples
    --------
    >>> value_in_words("transmission.backlash_um", 80)
    'backlash 80 µm'
    >>> value_in_words("mesh_stiffness.mean_n_per_m", 4.1e8)
    'mesh stiffness mean 410 N/µm'
    """
    parts = [part for part in key.split(".") if not part.isdigit()]
    key_parts = parts[1:] if parts[0] in UNNAMED and len(parts) > 1 else parts
    ending = next(filter(None, map(ending_of, reversed(key_parts))), "")
    words = " ".join(f"{part} ".replace(f"_{ending} ", " ").strip() for part in key_parts).replace("_", " ")
    if isinstance(value, bool) or not isinstance(value, int | float):
        return f"{words} {value}"
    unit, factor, least = ENGINEERING.get(ending, (ending, 1.0, 0.0))
    if least > 0.0:  # which depends on all numbers of a table
        unit, factor = ending, 1.0
    number = format_number(factor * value, 4)
    return f"{words} {number} {UNITS[unit]}" if unit else f"{words} {number}"
