"""What REXS holds of a machine."""

from facegear.config.lumped_model import ToothNumbers, layout
from facegear.config.model import Config
from facegear.errors import ConfigError
from facegear.exchange.rexs import Shaft, Spur, Unit
from facegear.transmission.layout import Body


def gear_unit(config: Config) -> Unit:
    """Pinions and face gears as shafts on their bearings. Raises ConfigError without a transmission."""
    pair, machine = config.tooth_pair, config.transmission
    if machine is None:
        raise ConfigError("transmission", None, "given, as REXS describes shafts and bearings")
    body = pair.pinion
    spur = Spur(
        teeth=pair.pinion_teeth,
        module=pair.module_mm,
        width=None if body is None else body.width_mm,
        pressure_angle=pair.pressure_angle_deg,
        bore=None if body is None else body.bore_radius_mm,
    )
    placed = layout(machine, ToothNumbers.of_config(pair.model_dump()))
    shafts = [_pinion(pinion.name, pinion.body, spur) for pinion in placed.pinions]
    shafts += [_gear(gear.name, gear.body) for gear in placed.gears]
    material = (body and body.material) or pair.material
    return Unit(tuple(shafts), 1e3 * material.young_modulus_gpa, material.poisson_ratio)


def _pinion(name: str, body: Body, spur: Spur) -> Shaft:
    """A pinion's own axis is z."""
    x, y, z = body.bearing
    return Shaft(name, body.mass, min(x, y), z, spur)


def _gear(name: str, body: Body) -> Shaft:
    x, y, z = body.bearing
    return Shaft(name, body.mass, min(x, y), z)
