"""Load-dependent laws of pairs that are hard for them: the table is contact, to the error that it states."""

import numpy as np
import pytest

from facegear.contact.ltca import loaded_contact
from facegear.errors import FacegearError
from facegear.meshing.fitted_law import fitted_tables
from facegear.meshing.load_dependent import load_dependent_law
from facegear.pipeline.stages.contact import flank_contacts
from facegear.teeth.design import AssemblyErrors

LARGEST, POSITIONS, ORDERS = 600.0, 8, 3


@pytest.mark.parametrize(
    ("coarse", "errors"),
    [
        (False, {}),
        (True, {"offset": -300e-6}),  # the path of contact leaves the face: contact at its end
    ],
)
def test_forces_of_a_law_are_those_of_contact_within_the_error_that_it_states(model_of, coarse, errors):
    model = model_of(coarse=coarse).with_assembly(AssemblyErrors(**errors))
    (table,), (error,) = fitted_tables([flank_contacts(model, POSITIONS, LARGEST)], ORDERS)
    torques = [0.11 * LARGEST, 0.47 * LARGEST, 0.93 * LARGEST]
    law = load_dependent_law([table])
    for position in (0.125, 0.5):
        for torque, found in zip(torques, loaded_contact(model, [position], torques), strict=True):
            amount = np.array([[found.ste - found.unloaded_error]])
            assert amount[0, 0] < table.levels[-1]
            force = law.force(np.array([position]), amount)[0, 0]
            missed = abs(force - torque / model.design.pinion_base_radius)
            assert missed < 1.05 * error.largest * error.force
    assert error.largest < 0.01


@pytest.mark.parametrize(
    "changes",
    [
        {"rack_tip_radius": 0.25},
        {"shaper_teeth": 23},  # as many as the pinion has: its tips reach the fillets as well
    ],
)
def test_a_pair_whose_teeth_interfere_has_no_law_and_says_so(model_of, changes):
    model = model_of(coarse=True, **changes)
    with pytest.raises(FacegearError, match="the teeth interfere"):
        flank_contacts(model, 4, LARGEST)


def test_a_mesh_too_coarse_for_the_lightest_contact_is_named(model_of):
    with pytest.raises(FacegearError, match="too coarse for the lightest contact"):
        fitted_tables([flank_contacts(model_of(coarse=True), POSITIONS, LARGEST)], ORDERS)
