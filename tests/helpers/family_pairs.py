"""Tooth pairs of the whole family, as designs that meshes and solids are made of."""

import numpy as np
from public_teeth import public_design
from random_families import SEED, random_errors, random_family, with_possible_face

from facegear.errors import GeometryError
from facegear.teeth.design import FaceGearGeometry, PairDesign, PinionGeometry, Shaper
from facegear.teeth.family_limits import check_family
from facegear.teeth.tooth_family import ToothFamily


def pair_of(family: ToothFamily, **pinion) -> PairDesign:
    """Return a family's pair with a bore 2 modules below the lowest root, and as thick a gear rim."""
    module = family.rack.normal_module
    lowest = family.pinion_pitch_radius - family.pinion_dedendum
    lowest += float(family.shift(family.middle + np.array([-0.5, 0.5]) * family.width).min())
    return PairDesign(
        module=module,
        pressure_angle=family.rack.pressure_angles[0],
        coast_pressure_angle=family.rack.pressure_angles[1],
        helix_angle=family.rack.helix_angle,
        taper_angle=family.rack.taper_angle,
        shaft_angle=family.shaft_angle,
        offset=family.offset,
        pinion=PinionGeometry(
            **{
                "teeth": family.pinion_teeth,
                "width": family.width,
                "addendum": family.pinion_addendum,
                "dedendum": family.pinion_dedendum,
                "rack_tip_radius": family.rack_tip_radius,
                "bore_radius": lowest - 2.0 * module,
                "profile_shift": family.profile_shift,
                "thinning": family.thinning,
                "middle": family.middle,
                **pinion,
            }
        ),
        face_gear=FaceGearGeometry(
            teeth=family.gear_teeth,
            inner_radius=family.inner_radius,
            outer_radius=family.outer_radius,
            addendum=family.gear_addendum,
            rim_thickness=2.0 * module,
        ),
        shaper=Shaper(family.shaper_teeth, family.shaper_addendum, family.shaper_tip_rounding),
    )


def public_pair(name: str, **pinion) -> PairDesign:
    """Return a public design as a pair."""
    return pair_of(public_design(name), **pinion)


def random_pairs(count: int) -> list[PairDesign]:
    """Return the first random designs that have teeth, always the same."""
    rng, pairs = np.random.default_rng(SEED), []
    while len(pairs) < count:
        family = random_family(rng)
        random_errors(rng, family.rack.normal_module)
        try:
            family = with_possible_face(family)
            check_family(family)
        except GeometryError:
            continue
        pairs.append(pair_of(family))
    return pairs
