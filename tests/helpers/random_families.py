"""Random designs of the whole family of teeth, with faces where the limits leave room."""

from dataclasses import replace
from math import cos, hypot, radians, sin, sqrt

import numpy as np

from facegear.teeth.design import AssemblyErrors
from facegear.teeth.family_limits import family_limits
from facegear.teeth.tooth_family import Rack, ToothFamily

SEED = 54


def random_family(rng: np.random.Generator) -> ToothFamily:
    """Return a random design whose face lies about its pitch point; it need not be possible."""
    module = rng.uniform(1e-3, 8e-3)
    rack = Rack(
        module,
        (radians(rng.uniform(17, 28)), radians(rng.uniform(17, 28))),
        radians(rng.uniform(-20, 20)),
        radians(rng.uniform(-5, 5)),
    )
    pinion_teeth = int(rng.integers(15, 45))
    gear_teeth = int(pinion_teeth * rng.uniform(3, 8))
    shaft_angle = radians(rng.uniform(75, 110))
    pitch_radius = pinion_teeth * rack.transverse_module / 2
    gear_radius = gear_teeth * rack.transverse_module / 2
    middle = (gear_radius + pitch_radius * cos(shaft_angle)) / sin(shaft_angle)
    offset = rng.uniform(-0.12, 0.12) * gear_radius
    radius = hypot(offset, middle * sin(shaft_angle) - pitch_radius * cos(shaft_angle))
    return ToothFamily(
        rack=rack,
        pinion_teeth=pinion_teeth,
        gear_teeth=gear_teeth,
        shaper_teeth=pinion_teeth + int(rng.integers(1, 5)),
        middle=middle,
        width=6 * module,
        inner_radius=radius - 3 * module,
        outer_radius=radius + 3 * module,
        pinion_addendum=module,
        pinion_dedendum=1.25 * module,
        gear_addendum=rng.uniform(0.8, 1.0) * module,
        shaper_addendum=1.25 * module,
        shaft_angle=shaft_angle,
        offset=offset,
        profile_shift=rng.uniform(-0.1, 0.3) * module,
        thinning=0.02 * module,
        rack_tip_radius=0.1 * module,
        shaper_tip_rounding=rng.choice([0.0, 0.1]) * module,
    )


def with_possible_face(family: ToothFamily) -> ToothFamily:
    """Return the design with the part of its face that the limits leave, where the path lies."""
    for _ in range(2):
        limits = family_limits(family)
        inner = max(1.002 * limits.inner[0], family.inner_radius)
        outer = min(0.99 * limits.pointing, inner + 5 * family.rack.normal_module)
        level = sqrt(((inner + outer) / 2) ** 2 - family.offset**2)
        level += family.pinion_pitch_radius * cos(family.shaft_angle)
        middle = level / sin(family.shaft_angle)
        face = {"inner_radius": inner, "outer_radius": outer, "width": outer - inner}
        family = replace(family, middle=middle, **face)
    return family


def random_errors(rng: np.random.Generator, module: float) -> AssemblyErrors:
    """Return small random errors of assembly."""
    offset, shift, outwards = rng.uniform(-0.02, 0.02, 3) * module
    return AssemblyErrors(offset, rng.uniform(-3e-4, 3e-4), shift, outwards)
