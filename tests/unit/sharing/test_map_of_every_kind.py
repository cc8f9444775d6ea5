"""Closed forms of the load-sharing map for teeth of every kind, against statics of whole wrenches."""

from math import radians

import numpy as np
import pytest
from references import against, agrees
from test_closed_form import config_of
from wrench_machines import MESH, Teeth, make_layout

import facegear
from facegear.harmonics import Harmonics
from facegear.machine.imperfections import perfect
from facegear.machine.layout import Body, FaceGear, Pinion, Role, Side
from facegear.machine.machine import Damping, Machine
from facegear.machine.torques import balanced_torques
from facegear.sharing.closed_form import path_forces
from facegear.sharing.groups import GroupKind
from facegear.sharing.mapped_machine import MappedMachine, groups_of_kind

KINDS = {
    "spur": Teeth(25, 125, 3.5e-3, (radians(25),) * 2),
    "helical": Teeth(25, 125, 3.5e-3, (radians(25),) * 2, radians(15)),
    "tapered": Teeth(25, 125, 3.5e-3, (radians(25),) * 2, 0.0, radians(4)),
    "asymmetric": Teeth(25, 125, 3.5e-3, (radians(25), radians(20))),
    "leaning": Teeth(25, 125, 3.5e-3, (radians(25),) * 2, shaft=radians(100)),
    "offset": Teeth(25, 120, 4e-3, (radians(22.5),) * 2, radians(-10), offset=0.025),
    "all": Teeth(25, 120, 4e-3, (radians(25), radians(21)), radians(-10), radians(2), radians(97), 0.02),
}
PATHS, FREE, HELD = 5, 0.1, 1e14


def idlers_of(teeth: Teeth, upper: float, sense=1.0, position=0.0) -> Machine:
    """Five idlers between two gears, the lower one driven; `upper`: bearing of the upper gear."""
    body = Body(1.2, 0.002, (6.5e8, 3e8, 4e8))
    pinions = [Pinion(f"idler {i}", Role.IDLER, teeth.gear * i / PATHS, body) for i in range(PATHS)]
    gears = [
        FaceGear(side, Body(8.0, 0.5, (stiff, stiff, HELD)))
        for side, stiff in ((Side.LOWER, HELD), (Side.UPPER, upper))
    ]
    layout = make_layout(teeth, pinions, gears)
    flaws = perfect(layout)
    flaws.position[0, 0] = position
    return Machine(
        layout=layout,
        torques=balanced_torques(layout, np.zeros(PATHS), sense * 6000.0),
        stiffness=Harmonics(np.zeros(1), np.array([MESH])),
        error=Harmonics(np.zeros(1), np.zeros(1)),
        half_backlash=np.full(2 * PATHS, 1e-3),
        damping=Damping(1000.0, 500.0, 1e-6),
        imperfections=flaws,
    )


@against(
    "analytic",
    "Singh 2010 with the wrenches of both flanks of every idler",
    capability="sharing_map",
    module="facegear.sharing.mapped_machine",
)
@pytest.mark.parametrize("upper", [HELD, 3e8, FREE])
@pytest.mark.parametrize("sense", [1.0, -1.0])
@pytest.mark.parametrize("name", KINDS)
def test_idlers_of_every_kind_share_as_the_closed_form_says(name, sense, upper):
    mapped = MappedMachine(idlers_of(KINDS[name], upper, sense))
    (group,) = groups_of_kind(mapped.machine, GroupKind.IDLERS)
    load, stiffness = mapped.load(group), mapped.path_stiffness(group)
    late = 0.02 * load / stiffness * np.random.default_rng(2).standard_normal((3, PATHS))
    expected = path_forces(load, stiffness, late, mapped.freedom(group))
    found = mapped.idler_forces(group, late)
    assert np.ptp(expected) > 0.01 * load
    agrees("force of a path over all", found / load, expected / load, absolute=1e-7)


@against(
    "analytic",
    "Singh 2010 with the wrenches of both flanks of an idler out of place",
    capability="sharing_map",
    module="facegear.sharing.mapped_machine",
)
@pytest.mark.parametrize("name", KINDS)
def test_idler_out_of_place_is_late_by_the_tangential_force_of_both_meshes(name):
    way = 5e-6
    mapped, moved = (MappedMachine(idlers_of(KINDS[name], HELD, 1.0, place)) for place in (0.0, way))
    (group,) = groups_of_kind(mapped.machine, GroupKind.IDLERS)
    late = np.zeros(PATHS)
    late[0] = -way * mapped.path_wrenches(group).on_pinion[0]
    expected = path_forces(mapped.load(group), mapped.path_stiffness(group), late, mapped.freedom(group))
    found = moved.forces[list(group.meshes)]
    agrees("force of a path over all", found / expected.sum(), expected / expected.sum(), absolute=1e-7)


@against(
    "analytic",
    "loop formula of docs/explanation/theory.md with the wrenches of helical and tapered teeth",
    capability="sharing_map",
    module="facegear.sharing.ideal_machine",
)
@pytest.mark.parametrize("change", [{"helix_angle_deg": 15.0}, {"taper_angle_deg": 4.0}])
def test_map_of_split_machines_with_other_teeth_is_the_loop_formula(change):
    values = config_of(3, 1e8, 1e9, 30.0)
    pair = values["tooth_pair"] | change
    tables = facegear.load(
        {**values, "tooth_pair": pair, "sharing_map": {"samples": 100, "points": 3}}, None
    ).sharing_map()
    inputs = tables.inputs()
    agrees("K_gamma of inputs", inputs["k_gamma"], inputs["closed"], relative=1e-4)
