"""A machine under other torques: the bins of a duty cycle, the loads of a map."""

from collections.abc import Mapping
from typing import Any

from facegear.config.transmission import Transmission
from facegear.errors import ConfigError


def at_mesh_torque(section: Transmission, torque: float) -> Transmission:
    """Scale all torques of a machine so that an input has a given torque in each mesh.

    Parameters
    ----------
    section : Transmission
        Section `transmission` of the config.
    torque : float
        Torque on the pinion in each mesh, N m.

    Returns
    -------
    Transmission
        The section with the scaled torques.

    Raises
    ------
    ConfigError
        If inputs carry no torque.
    """
    input_torque = section.torque.per_input_n_m
    if input_torque == 0.0:
        raise ConfigError(
            "transmission.torque.per_input_n_m", input_torque, "not 0, for the bins of a duty cycle"
        )
    factor = torque * len(section.face_gears) / abs(input_torque)
    return Transmission.of_config(with_torques(section.model_dump(mode="json"), factor))


def with_torques(transmission: Mapping[str, Any], part: float) -> dict[str, Any]:
    """Multiply all torques of section `transmission` by a factor.

    Parameters
    ----------
    transmission : Mapping[str, Any]
        Plain values of the section.
    part : float
        Factor on the torques, dimensionless.

    Returns
    -------
    dict[str, Any]
        Plain values with the new torques.
    """

    def scale_torque(section: Mapping[str, Any]) -> dict[str, Any]:
        torque = section.get("torque_n_m")
        return {**section, "torque_n_m": torque if torque is None else part * torque}

    return {
        **transmission,
        "torque": {**transmission["torque"], "per_input_n_m": part * transmission["torque"]["per_input_n_m"]},
        "pinions": [scale_torque(pinion) for pinion in transmission["pinions"]],
        "single_gears": {name: scale_torque(gear) for name, gear in transmission["single_gears"].items()},
    }
