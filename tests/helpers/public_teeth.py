"""Public designs of the family of teeth and their numbers, computed outside the package.

`P1.json` to `P4.json` beside the tests hold the numbers with all digits; the parameters stand here.
"""

import json
from math import radians, sin
from pathlib import Path

from facegear.arrays import Array
from facegear.teeth.bounded_contact import Removal
from facegear.teeth.design import AssemblyErrors
from facegear.teeth.tooth_family import Rack, ToothFamily

FOLDER = Path(__file__).parents[1] / "unit" / "teeth" / "public"
NAMES = ("P1", "P2", "P3", "P4")
MM = 1e-3

PARAMETERS = {
    # module, teeth, pressure angles, helix, taper, shaft angle, offset, middle, width, radii, then the gear's
    # addendum and the shaper's tip rounding; mm and degrees
    "P1": (3.5, (25, 125, 27), (25, 25), 15, 0, 90, 0, 228, 28, (217, 240), 3.5, 0.175),
    "P2": (3.75, (23, 143, 26), (25, 25), 0, 4, 90, 0, 264, 30, (253, 276), 3.375, 0.375),
    "P3": (3, (29, 110, 31), (25, 20), 0, 0, 100, 0, 162, 24, (159, 176), 2.85, 0.3),
    "P4": (4, (27, 120, 29), (22.5, 22.5), -10, 0, 90, 25, 239, 32, (231, 252), 4, 0),
}
CROWNING_UM = {"P1": (4, 8), "P2": (4, 8), "P3": (3, 6), "P4": (4, 8)}
"""Profile and lead crowning of the crowned pinions, um."""
ERRORS = AssemblyErrors(60e-6, radians(0.02), -40e-6, 150e-6)
"""Errors of assembly of the public numbers: offset, shaft angle, axial shifts of gear and pinion."""


def public_design(name: str) -> ToothFamily:
    """Return a public design, in SI units."""
    module, teeth, angles, helix, taper, shaft, offset, middle, width, radii, addendum, rounding = PARAMETERS[
        name
    ]
    return ToothFamily(
        rack=Rack(module * MM, (radians(angles[0]), radians(angles[1])), radians(helix), radians(taper)),
        pinion_teeth=teeth[0],
        gear_teeth=teeth[1],
        shaper_teeth=teeth[2],
        middle=middle * MM,
        width=width * MM,
        inner_radius=radii[0] * MM,
        outer_radius=radii[1] * MM,
        pinion_addendum=module * MM,
        pinion_dedendum=1.25 * module * MM,
        gear_addendum=addendum * MM,
        shaper_addendum=1.25 * module * MM,
        shaft_angle=radians(shaft),
        offset=offset * MM,
        thinning=0.1 * MM,
        rack_tip_radius=0.1 * module * MM,
        shaper_tip_rounding=rounding * MM,
    )


def public_numbers(name: str) -> dict:
    """Return the numbers of a public design."""
    return json.loads((FOLDER / f"{name}.json").read_text("utf-8"))


def crowning(family: ToothFamily, amounts_um: tuple[float, float]) -> Removal:
    """Return the depth (m) that profile and lead crowning take off the drive flank of the pinion."""
    across, along = (1e-6 * amount for amount in amounts_um)
    helicoid = family.pinion_flanks[0]
    middle = helicoid.pitch_radius * sin(helicoid.pressure_angle)

    def depth(roll: Array, y: Array) -> Array:
        from_pitch = (roll - middle) / family.rack.normal_module
        return across * from_pitch**2 + along * ((y - family.middle) / (family.width / 2)) ** 2

    return depth
