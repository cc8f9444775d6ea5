"""The assembly errors of each flank of both gears, against closed forms and the machine's own directions."""

from dataclasses import replace
from math import radians

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lumped_machines import make_layout
from references import against, agrees

from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.layout import Side
from facegear.machine.linear_model import flank_jacobian
from facegear.teeth.design import AssemblyErrors
from facegear.teeth.placement import FLANKS, GEARS, distinct_pairs, errors_at
from facegear.teeth.unloaded_contact import unloaded_contact

PATHS = [
    ((120e-6, 0.0, radians(0.03)), 264.388284, 269.136890),
    ((-170e-6, 0.0, 0.0), 272.215998, 264.630971),
    ((200e-6, 92e-6, 0.0), 260.101140, 268.191282),
    ((0.0, 0.0, radians(-0.05)), 271.306433, 271.306433),
]
"""dE, dq (m), dgamma (rad); places (mm) of the path on the pinion, drive and back flank, from the closed form
of conjugate action at any pose."""


def moved(design, errors):
    return replace(design, assembly=errors)


@against(
    "analytic",
    "place of the contact of a displaced pair in closed form",
    capability="contact",
    module="facegear.teeth.placement",
)
@pytest.mark.parametrize(("errors", "drive", "back"), PATHS)
def test_contact_of_either_flank_stands_where_the_closed_form_has_it(pair, errors, drive, back):
    offset, shift, angle = errors
    given_errors = AssemblyErrors(offset=offset, shaft_angle_error=angle, gear_axial=shift)
    for flank, radius in zip(FLANKS, (drive, back), strict=True):
        design = moved(pair(26), errors_at(given_errors, "upper", flank))
        _, along_the_pinion = unloaded_contact(design, np.array([0.01, 0.1])).path
        agrees("radius of the path, mm", 1e3 * along_the_pinion, radius, relative=1e-7, absolute=1e-5)


@against(
    "analytic",
    "normal part of a displacement",
    capability="geometry",
    module="facegear.teeth.unloaded_contact",
)
@pytest.mark.parametrize("gear", GEARS)
@pytest.mark.parametrize("flank", FLANKS)
def test_a_displaced_pinion_closes_each_flank_as_the_machine_s_directions_say(pair, gear, flank):
    """A pinion moved along x by 1 um, in the frame of the machine, on both flanks of both gears."""
    step, layout = 1e-6, make_layout(kinematics=GEOMETRIC)
    sides = [Side(gear) == layout.gears[g].side for _, g in layout.meshes]
    mesh = sides.index(True)
    pinion = 4 * layout.meshes[mesh][0]
    row = mesh + (len(layout.meshes) if flank == "back" else 0)
    lead = [
        unloaded_contact(moved(pair(26), errors_at(AssemblyErrors(offset=x), gear, flank)), [0.0])
        for x in (step, -step)
    ]
    along = (lead[0].transmission_error[0] - lead[1].transmission_error[0]) / (2 * step)
    agrees(
        "closing of a flank over the displacement",
        along,
        flank_jacobian(layout)[row, pinion],
        relative=1e-3,
    )


ERRORS = st.builds(
    AssemblyErrors,
    offset=st.sampled_from([0.0, 5e-5, -2e-5]),
    shaft_angle_error=st.sampled_from([0.0, 3e-4]),
    gear_axial=st.sampled_from([0.0, 4e-5]),
)


@settings(max_examples=12)
@given(ERRORS)
def test_only_flanks_that_errors_part_are_distinguished(pair, errors):
    """None without errors of the pinion: a shift of the gears away from it is the same for all four."""
    different, numbers = distinct_pairs(replace(pair(), assembly=errors))
    assert different[0].assembly == errors == different[numbers[0, 0]].assembly
    assert len(different) == (2 if errors.offset else 1) * (2 if errors.shaft_angle_error else 1)
    for (row, column), number in np.ndenumerate(numbers):
        assert different[number].assembly == errors_at(errors, GEARS[row], FLANKS[column])
