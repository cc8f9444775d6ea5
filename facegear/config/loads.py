"""A machine under other torques: the bins of a duty cycle, the loads of a map."""

from collections.abc import Mapping
from typing import Any

from facegear.config.transmission import Transmission
from facegear.errors import ConfigError


def at_mesh_torque(section: Transmission, torque: float) -> Transmission:
    """Section `transmission` with all torques in proportion, so that an input has `torque` in each mesh.

    torque in N m on the pinion. Raises ConfigError where inputs carry none.
    """
    given = section.torque.per_input_n_m
    if given == 0.0:
        raise ConfigError("transmission.torque.per_input_n_m", given, "not 0, for the bins of a duty cycle")
    factor = torque * len(section.face_gears) / abs(given)
    return Transmission.of_config(with_torques(section.model_dump(mode="json"), factor))


def with_torques(transmission: Mapping[str, Any], part: float) -> dict[str, Any]:
    """Plain values of section `transmission` with all torques times `part`."""

    def scaled(section: Mapping[str, Any]) -> dict[str, Any]:
        own = section.get("torque_n_m")
        return {**section, "torque_n_m": own if own is None else part * own}

    return {
        **transmission,
        "torque": {**transmission["torque"], "per_input_n_m": part * transmission["torque"]["per_input_n_m"]},
        "pinions": [scaled(pinion) for pinion in transmission["pinions"]],
        "single_gears": {name: scaled(gear) for name, gear in transmission["single_gears"].items()},
    }
