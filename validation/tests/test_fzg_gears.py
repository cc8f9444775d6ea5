"""FZG type C gears through our bodies and contact, beside the figures published for them."""

from math import pi, tan

import numpy as np
import pytest
from contact_bodies import STEEL
from references import against, agrees
from spur_gears import fzg_c, slab_design

from facegear.contact.hertz import contact_modulus, strip_pressure
from facegear.contact.options import Refinement
from facegear.teeth.design import involute
from facegear.teeth.mesh_sizes import MeshSizes
from validation.contact.twin import analyse_twin, twin_model

FORCE = 5912.1 / 14e-3
"""Published normal force over the width, N/m."""


@against(
    "external source",
    "published stresses of FZG type C gears",
    capability="contact",
    module="facegear.contact.ltca",
)
def test_pressure_at_the_pitch_point_is_the_published_one():
    """Half-width and pressure from the spread of the loads on the flank, no formula of contact in between."""
    mesh = fzg_c()
    pinion, wheel = slab_design(mesh.pinion), slab_design(mesh.wheel)
    size = MeshSizes(0.3 * pinion.module, 0.25 * pinion.module, 0.3 * pinion.module)
    cuts = Refinement(16, 1, 5, 2.0)
    model = twin_model(
        pinion, wheel, (size, size), cuts, (STEEL, STEEL), 7, "free", centre=mesh.centre_distance
    )
    half_tooth = pinion.pinion_half_base_angle - involute(mesh.working_angle)
    position = 1.0 - half_tooth * pinion.pinion.teeth / (2 * pi)
    (found,) = analyse_twin(model, np.array([position]), [FORCE])
    (spot,) = found.spots
    assert found.load_share[2] == pytest.approx(1.0)
    points = model.surface.nodes[spot.hats]
    base = pinion.pinion_base_radius
    roll = np.sqrt(np.hypot(points[:, 0], points[:, 2]) ** 2 / base**2 - 1)
    assert np.average(roll, weights=spot.force) == pytest.approx(tan(mesh.working_angle), rel=1e-3)
    arc = 0.5 * base * roll**2
    spread = np.sqrt(np.average((arc - np.average(arc, weights=spot.force)) ** 2, weights=spot.force))
    half_width = 2 * spread  # a semi-ellipse's variance is a quarter of its half-width squared
    agrees("half-width of the contact, m", half_width, 199.6e-6, relative=0.01)
    agrees("pressure at the pitch point, Pa", 2 * FORCE / (pi * half_width), 1347.3e6, relative=0.01)


@against(
    "external source",
    "published stresses of FZG type C gears",
    capability="contact",
    module="facegear.contact.hertz",
)
def test_pressure_of_a_line_load_at_the_pitch_point_is_the_published_one():
    mesh = fzg_c()
    pressure, width = strip_pressure(
        FORCE, 1 / mesh.pitch_curvature_radius(), contact_modulus((STEEL, STEEL))
    )
    agrees("pressure at the pitch point, Pa", float(pressure), 1347.3e6, relative=1e-3)
    agrees("half-width of the contact, m", float(width), 199.6e-6, relative=1e-3)
