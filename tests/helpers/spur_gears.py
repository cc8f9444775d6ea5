"""Published spur gears, and the root stress of a spur tooth in plane strain by finite elements."""

from dataclasses import dataclass, replace
from math import acos, hypot, pi, radians, sin, sqrt, tan

import numpy as np
from contact_bodies import STEEL

from facegear.contact.bodies.compliance import flank_compliance
from facegear.contact.bodies.surface import interpolation
from facegear.contact.options import Refinement
from facegear.contact.root_gauges import root_gauges
from facegear.contact.teeth import elastic_tooth
from facegear.strength.root_form import SpurGear
from facegear.strength.root_stress import down_the_fillet
from facegear.teeth.design import FaceGearGeometry, PairDesign, PinionGeometry, Shaper
from facegear.teeth.mesh_sizes import named_sizes
from validation.contact.twin import slab_tooth


@dataclass(frozen=True)
class SpurMesh:
    """A pinion and a wheel at a centre distance (m)."""

    pinion: SpurGear
    wheel: SpurGear
    centre_distance: float

    @property
    def working_angle(self):
        """Working pressure angle, rad."""
        return acos((self.pinion.base_radius + self.wheel.base_radius) / self.centre_distance)

    @property
    def ratio(self):
        return self.wheel.teeth / self.pinion.teeth

    @property
    def base_pitch(self):
        """Distance of neighbouring flanks along the line of action, m."""
        return 2 * pi * self.pinion.base_radius / self.pinion.teeth

    @property
    def contact_ratio(self):
        path = tip_roll(self.pinion) + tip_roll(self.wheel) - self.centre_distance * sin(self.working_angle)
        return path / self.base_pitch

    def single_contact_radius(self, gear):
        """Radius (m) of the outer point of single pair tooth contact on one of the gears."""
        return hypot(gear.base_radius, tip_roll(gear) - (self.contact_ratio - 1.0) * self.base_pitch)

    def pitch_curvature_radius(self):
        """Relative radius of curvature at the pitch point, m."""
        radii = [gear.base_radius * tan(self.working_angle) for gear in (self.pinion, self.wheel)]
        return 1.0 / sum(1.0 / radius for radius in radii)


def tip_roll(gear):
    """Length of the involute's tangent at the tip, m."""
    return sqrt(gear.tip_radius**2 - gear.base_radius**2)


def published(module, width, rack_tip_radius, centre_distance, *sizes):
    """Gears of 20 degrees; sizes: teeth, profile shift in modules and tip radius of pinion and wheel."""
    pinion, wheel = (
        SpurGear(teeth, module, radians(20.0), shift, tip, width, 1.25, rack_tip_radius)
        for teeth, shift, tip in sizes
    )
    return SpurMesh(pinion, wheel, centre_distance)


def fzg_c():
    """FZG type C test gears: published with their form factors and stresses by a public tribology code."""
    return published(4.5e-3, 14e-3, 0.38, 91.5e-3, (16, 0.1817, 41.318e-3), (24, 0.1715, 59.272e-3))


def din_3990_11():
    """Spur gears rated after DIN 3990-11 by a public code that prints every factor (hanslhansl/din3990)."""
    sizes = (19, 0.5, 44e-3), (104, 0.15, 212.6e-3)
    return published(4e-3, 48.64e-3, 0.25, 248.506843355171e-3, *sizes)


def slab_design(gear: SpurGear, rim: float = 3.0) -> PairDesign:
    """The gear as the pinion of a pair whose face gear is never made; `rim` below the root in modules."""
    m = gear.module
    pitch, shift = 0.5 * m * gear.teeth, m * gear.profile_shift
    root = pitch - m * gear.rack_addendum + shift
    part = PinionGeometry(
        teeth=gear.teeth,
        width=0.5 * m,
        addendum=gear.tip_radius - pitch - shift,
        dedendum=m * gear.rack_addendum,
        rack_tip_radius=m * gear.rack_tip_radius,
        bore_radius=root - rim * m,
        profile_shift=shift,
    )
    blank = FaceGearGeometry(
        teeth=3 * gear.teeth, inner_radius=pitch, outer_radius=2 * pitch, addendum=m, rim_thickness=m
    )
    return PairDesign(m, gear.pressure_angle, part, blank, Shaper(gear.teeth, 1.25 * m))


def root_tension(design: PairDesign, roll: float) -> float:
    """Largest tension (Pa) for 1 N/m along a line of the flank at a roll angle (rad), whole ring."""
    m = design.module
    tooth = slab_tooth(design, replace(named_sizes("medium", m), width=0.64 * m))
    elastic, side = elastic_tooth(design, tooth, STEEL, "right")
    held = elastic.is_held.copy()
    held[:, 1] = True
    gauges, rows = root_gauges(tooth, STEEL)
    plain = replace(elastic, is_held=held)
    found = flank_compliance(plain, Refinement(), design.pinion.teeth, 2, "ring", gauges=rows)
    at = np.interp(-roll, -side.u[: side.flank_rows, 1], np.arange(side.flank_rows))
    line = interpolation(np.array([[at, 0.0], [at, 1.0], [at, 2.0]]), side.shape).toarray()
    unit = np.array([1.0, 4.0, 1.0]) / 6.0 @ line * float(np.ptp(elastic.points[:, 1]))
    stress = -(found.readings[2] @ unit).reshape(gauges.position.shape[:3])
    return float(down_the_fillet(stress[0]).max())
