"""Published spur gears, and the root stress of a spur tooth in plane strain by finite elements."""

from dataclasses import replace
from math import radians

import numpy as np
from contact_bodies import STEEL

from facegear.contact.bodies.compliance import flank_compliance
from facegear.contact.bodies.surface import interpolation
from facegear.contact.options import Refinement
from facegear.contact.root_gauges import root_gauges
from facegear.contact.teeth import elastic_tooth
from facegear.geometry.design import FaceGearGeometry, PairDesign, PinionGeometry, Shaper
from facegear.mesh.sizes import named_sizes
from facegear.strength.root_stress import down_the_fillet
from facegear.strength.spur import SpurGear, SpurMesh
from validation.contact.twin import slab_tooth


def fzg_c() -> SpurMesh:
    """FZG type C test gears: published with their form factors and stresses by a public tribology code."""
    pinion, wheel = (
        SpurGear(
            teeth=teeth,
            module=4.5e-3,
            pressure_angle=radians(20.0),
            profile_shift=shift,
            tip_radius=tip,
            width=14e-3,
            rack_addendum=1.25,
            rack_tip_radius=0.38,
        )
        for teeth, shift, tip in ((16, 0.1817, 41.318e-3), (24, 0.1715, 59.272e-3))
    )
    return SpurMesh(pinion, wheel, 91.5e-3)


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
    held = elastic.held.copy()
    held[:, 1] = True
    gauges, rows = root_gauges(tooth, STEEL)
    plain = replace(elastic, held=held)
    found = flank_compliance(plain, Refinement(), design.pinion.teeth, 2, "ring", gauges=rows)
    at = np.interp(-roll, -side.u[: side.flank_rows, 1], np.arange(side.flank_rows))
    line = interpolation(np.array([[at, 0.0], [at, 1.0], [at, 2.0]]), side.shape).toarray()
    unit = np.array([1.0, 4.0, 1.0]) / 6.0 @ line * float(np.ptp(elastic.points[:, 1]))
    stress = -(found.readings[2] @ unit).reshape(gauges.position.shape[:3])
    return float(down_the_fillet(stress[0]).max())
