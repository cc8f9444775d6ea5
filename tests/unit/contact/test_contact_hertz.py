"""Simple bodies with closed solutions, through the code the gears go through."""

import numpy as np
import pytest
from contact_bodies import STEEL, half_disc, pressed, quarter_space
from references import against, agrees

from facegear.contact.options import Refinement

PLANE = STEEL.young_modulus / (1 - STEEL.poisson_ratio**2)


def line_contact(elements, refinement, radius=0.01, half_width=2e-4):
    """Errors of approach and peak pressure of a disc between rigid plates, per plate, in plane strain.

    Approach P/(pi E*) (2 ln(4 R / a) - 1) (Johnson, Contact Mechanics, 5.6), exact up to (a / R)^2.
    """
    force = np.pi * half_width**2 * PLANE / (4 * radius)
    ends = np.linspace(0, 1, elements + 1)
    body = half_disc(radius, ends, ends)
    reach = (4 * half_width) ** 2 / (2 * radius)
    contact, pressure, _ = pressed(body, refinement, lambda p: radius - p[:, 1], force, reach)
    approach = force / (np.pi * PLANE) * (2 * np.log(4 * radius / half_width) - 1)
    return contact.rotation / approach - 1, pressure.max() / (2 * force / (np.pi * half_width)) - 1, contact


def point_contact(refinement, radius=0.01, half_width=2e-4):
    """Errors of approach and peak pressure of a rigid sphere on a quarter of a half space."""
    force = 4 * PLANE * half_width**3 / (3 * radius)
    body = quarter_space(half_width, 300 * half_width, 3)
    contact, pressure, _ = pressed(
        body, refinement, lambda p: (p[:, 0] ** 2 + p[:, 2] ** 2) / (2 * radius), force / 4
    )
    return (
        contact.rotation * radius / half_width**2 - 1,
        pressure.max() / (1.5 * force / (np.pi * half_width**2)) - 1,
        contact,
    )


@against(
    "analytic",
    "Johnson, Contact Mechanics, 5.6: disc between rigid plates",
    capability="contact",
    module="facegear.contact.position_solver",
)
def test_line_contact_meets_hertz_within_a_percent_with_five_nodes_in_the_half_width():
    approach, peak, contact = line_contact(12, Refinement(8, 1, 4, 2.0))
    agrees("approach over Hertz's", 1 + approach, 1, absolute=0.01)
    agrees("peak pressure over Hertz's", 1 + peak, 1, absolute=0.01)
    assert contact.residual < 1e-13


@against(
    "analytic",
    "Johnson, Contact Mechanics, 5.6: disc between rigid plates",
    capability="contact",
    module="facegear.contact.position_solver",
)
def test_line_contact_converges_to_hertz():
    errors = [abs(line_contact(n, r)[0]) for n, r in ((6, Refinement()), (24, Refinement(8, 1, 4, 2.0)))]
    assert errors[0] > 0.01
    agrees("error of the approach on the finer mesh, relative", errors[1], 0.0, absolute=1e-3)


@against(
    "analytic",
    "Hertz: rigid sphere on a half space",
    capability="contact",
    module="facegear.contact.position_solver",
)
def test_point_contact_meets_hertz_within_a_percent():
    approach, peak, contact = point_contact(Refinement(4, 4, 4, 1.0))
    agrees("approach over Hertz's", 1 + approach, 1, absolute=0.01)
    agrees("peak pressure over Hertz's", 1 + peak, 1, absolute=0.01)
    assert contact.residual < 1e-13


@against(
    "analytic",
    "Johnson, Contact Mechanics, 5.6: disc between rigid plates",
    capability="contact",
    module="facegear.contact.position_solver",
)
@pytest.mark.parametrize("width", [1e-4, 4e-4])
def test_approach_of_a_line_contact_follows_the_logarithm_of_the_strip(width):
    approach, _, _ = line_contact(12, Refinement(8, 1, 4, 2.0), half_width=width)
    agrees("approach over Hertz's", 1 + approach, 1, absolute=0.01)
