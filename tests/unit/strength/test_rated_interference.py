"""A rating of teeth whose tips press into fillets, from the config to the report."""

import pytest

import facegear
from facegear.report.verdicts import verdicts

pytestmark = pytest.mark.xdist_group("notebooks")  # the example's contact is computed once a process

NARROW = {
    "tooth_pair.face_gear.outer_radius_mm": 262.5,
    "tooth_pair.pinion.width_mm": 15,
    "mesh.resolution.width_mm": 12.5,
    "mesh.resolution.thickness_mm": 12,
    "contact.torques_n_m": [500],
    "contact.positions_per_pitch": 4,
    "mesh_stiffness.torque_n_m": 500,
    "strength.duty": [{"torque_n_m": 500, "speed_rpm": 1000, "hours": 1}],
}
"""Half the example's face, loaded so lightly that its teeth are as safe as required."""


def test_teeth_that_interfere_bear_a_caveat_and_the_report_says_it():
    """Their bending was green: what presses into a fillet is kept out of root stress."""
    gearbox = facegear.example().with_values({**NARROW, "tooth_pair.shaper.teeth": 23})
    share, found = gearbox.contact().table()["fillet_share"].max(), gearbox.rating().content
    bending = found["rating"][found["rating"]["failure"] == "bending"]
    assert (bending["safety"] >= bending["required"]).all() and set(bending["verdict"]) == {"green"}
    message = f"fillets carry up to {100 * share:.2g} % of the torque, kept out of pressure and root stress"
    assert share > 0.1
    assert found["safety"]["caveat"].str.contains(message).all()
    shown = {one.subject: one for one in verdicts(gearbox.values, {"rating": found["rating"]}, None)}
    assert shown["Bending"].colour == "green" and "fillet contact" in shown["Bending"].caveats
