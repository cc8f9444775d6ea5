"""Spur pinions and face gears: from tooth geometry to loaded contact, dynamics and load sharing.

>>> import facegear
>>> gearbox = facegear.example()
>>> gearbox.modes().table()["frequency_hz"].round(1).to_list()[6:9]
[596.7, 1065.7, 1066.0]
"""

from importlib import import_module
from typing import Any

__all__ = [
    "ConfigError",
    "ConfigErrors",
    "CorruptFile",
    "FacegearError",
    "Gearbox",
    "InvalidInput",
    "MissingExtra",
    "NotConverged",
    "example",
    "load",
]

DOOR = ("Gearbox", "example", "load")
"""Names of `facegear.gearbox`; all other names of the package are errors."""


def __getattr__(name: str) -> Any:
    # Everything behind the door is imported when it is first asked for. The module's name is text, as every
    # stage loads this file, while no fingerprint of a stage holds what lies behind.
    if name in __all__:
        home = "facegear.gearbox" if name in DOOR else "facegear.errors"
        return getattr(import_module(home), name)
    raise AttributeError(f"module 'facegear' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__])
