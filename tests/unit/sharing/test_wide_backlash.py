"""Statics of paths that part in backlash of some millimetres, where rounding is above the tolerance."""

from dataclasses import replace

import numpy as np
import pytest
from idler_machines import make_idlers

from facegear.door.outputs import machine_of
from facegear.harmonics import Harmonics
from facegear.machine.layout import Role
from facegear.sharing.groups import GroupKind
from facegear.sharing.mapped_machine import MappedMachine, groups_of_kind
from facegear.sharing.path_changes import with_half_backlash, with_scaled_bearings

MESHES, TORQUE, BEARINGS = 7.9, 0.42, 0.7
"""Factors on stiffness of the meshes, torque and stiffness of the bearings, of a machine drawn at random."""


def make_stiff():
    """Build five idlers with stiff meshes under a small torque."""
    base = machine_of(make_idlers(5))
    stiff = Harmonics(np.zeros(1), MESHES * base.stiffness.cosine)
    loaded = replace(base, stiffness=stiff, torques=TORQUE * base.torques)
    return with_scaled_bearings(loaded, (Role.IDLER,), BEARINGS)


@pytest.mark.parametrize("half", [5e-3, 1e-2, 5e-2])
@pytest.mark.parametrize("number", [0.2, 2.0])
def test_paths_part_in_wide_backlash_as_in_backlash_of_two_millimetres(half, number):
    machine = make_stiff()
    mapped = MappedMachine(machine)
    group = groups_of_kind(machine, GroupKind.IDLERS)[0]
    load, path = mapped.load(group), mapped.path_stiffness(group)
    late = number * load / path * np.random.default_rng(3).standard_normal((100, 5))
    narrow, wide = (MappedMachine(with_half_backlash(machine, each)) for each in (1e-3, half))
    expected = narrow.idler_forces(group, late)
    assert (expected == 0.0).any(axis=1).sum() > 30, "paths part"
    np.testing.assert_allclose(wide.idler_forces(group, late), expected, atol=1e-8 * load)
