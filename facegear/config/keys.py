"""The keys of the config behind the quantities that computations refuse by words of their own."""

import re
from collections.abc import Iterator
from contextlib import contextmanager

from facegear.errors import ConfigError, InvalidInput

KEYS = {
    "element size": "mesh.resolution",
    "element depth below the fillets": "fillet_depth_mm",
    "profile refinement": "contact.refinement.profile",
    "torques of the contact analysis": "contact.torques_n_m",
    "modelled teeth of the pinion": "contact.sector.pinion_teeth",
    "modelled teeth of the face gear": "contact.sector.face_gear_teeth",
    "rounding of the rack's tip": "tooth_pair.pinion.rack_tip_radius_modules",
    "rounding of the shaper's tip": "tooth_pair.shaper.tip_rounding_modules",
    "gauges on the fillets": "contact.root_stress",
    "torque of the mesh stiffness": "mesh_stiffness.torque_n_m",
    "variation of the mesh stiffness": "mesh_stiffness.variation",
    "mesh stiffness": "mesh_stiffness",
    "pinions": "transmission.pinions",
    "face gears": "transmission.face_gears",
    "torques": "transmission.torque",
    "lags of the transmission error": "transmission.transmission_error.phasing",
    "order of an excitation": "transmission.excitations",
    "half backlashes": "transmission.single_meshes",
}
"""Dotted keys by the words of the computations; a quantity without a key keeps its words."""


def config_error(error: InvalidInput) -> ConfigError:
    """Name the config key in the refusal of a quantity.

    Parameters
    ----------
    error : InvalidInput
        Refusal of a computation, in its own words.

    Returns
    -------
    ConfigError
        The same refusal with keys of the config.
    """
    requirement = re.sub("`(.*?)`", lambda match: KEYS.get(match[1], match[1]), error.allowed)
    return ConfigError(KEYS.get(error.quantity, error.quantity), error.value, requirement)


@contextmanager
def keys_named() -> Iterator[None]:
    """Raise ConfigError with the key where a computation refuses a quantity.

    Yields
    ------
    None
        Once, for the statements of the `with` block.
    """
    try:
        yield
    except InvalidInput as error:
        raise config_error(error) from error
