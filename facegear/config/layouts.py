"""The layout of a machine from plain config values: the one place where section and tooth numbers meet."""

from collections.abc import Mapping
from typing import Any

from facegear.config.base import parse
from facegear.config.transmission import TEETH, ToothNumbers, Transmission, layout, tooth_numbers
from facegear.transmission.layout import Layout


def lumped_sections(
    transmission: Mapping[str, Any], teeth: Mapping[str, Any]
) -> tuple[Transmission, ToothNumbers]:
    """Section `transmission`, and what the lumped model takes from the keys TEETH of section `tooth_pair`."""
    return parse(Transmission, transmission), tooth_numbers(**{key: teeth[key] for key in TEETH})


def wired_layout(transmission: Mapping[str, Any], teeth: Mapping[str, Any]) -> Layout:
    """Bodies, angles and meshes of the machine of section `transmission`, with its tooth numbers."""
    return layout(*lumped_sections(transmission, teeth))
