"""Machines put together and judged again and again: what samples and designs have in common."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import pandas as pd

from facegear.config.base import parse
from facegear.config.buildable import require_buildable
from facegear.config.dynamics import Accuracy, settings
from facegear.config.load_sharing import LoadSharing, sharing_options
from facegear.config.lumped_model import TEETH, machine, tooth_numbers
from facegear.config.transmission import Transmission
from facegear.load_sharing.quantities import dynamic_quantities, quasi_static_quantities
from facegear.stiffness.tables import series_of, unloaded_error

Build = Callable[[Mapping[str, Any]], Any]
"""Puts a machine together from its section, or raises the error that a config gets."""
Judge = Callable[[Any, float], dict[str, float]]
"""What a machine is judged by at a speed (rpm), by column name."""


def builder(harmonics: pd.DataFrame, teeth: Mapping[str, Any], told: str) -> Build:
    """`told` names the machine in errors."""
    numbers = tooth_numbers(**{key: teeth[key] for key in TEETH})
    stiffness, unloaded = series_of(harmonics), unloaded_error(harmonics)

    def build(transmission: Mapping[str, Any]) -> Any:
        section = parse(Transmission, transmission, told)
        require_buildable(section, numbers)
        return machine(section, numbers, stiffness, unloaded)

    return build


def judge(model: str, cycles: int, accuracy: Mapping[str, Any], options: Mapping[str, Any]) -> Judge:
    """By loads over `cycles` mesh cycles of the hunting cycle, or where `model` is dynamic of the motion."""
    if model == "quasi_static":
        return lambda built, speed: quasi_static_quantities(built, cycles)
    precise = settings(parse(Accuracy, accuracy))
    one_start = replace(sharing_options(parse(LoadSharing, options)), starts=1)
    return lambda built, speed: dynamic_quantities(built, speed, precise, one_start)
