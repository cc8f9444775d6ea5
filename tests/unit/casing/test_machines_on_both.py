"""Random machines on rolling bearings and a casing against a second program for the energy of everything."""

import numpy as np
import pytest
from references import against, agrees
from seated_energy import WholeSeatedMachine, random_seated_machine

from facegear.machine.flanks import flank_edges
from facegear.machine.loaded_modes import loaded_modes
from facegear.machine.mean_load import at_mean_load
from facegear.machine.statics import mean_equilibrium


@against(
    "second implementation",
    "Newton's method over beam elements, bearings and casing",
    capability="casing_loads",
    module="facegear.machine.rolling_equilibria",
)
@pytest.mark.parametrize("seed", range(30))
def test_statics_and_tangents_on_both_agree_with_newtons_method(seed):
    machine = at_mean_load(random_seated_machine(seed))
    found, whole = mean_equilibrium(machine), WholeSeatedMachine(machine)
    gaps = flank_edges(machine)
    coordinates = whole.settle(gaps)
    flanks, loads = whole.forces(coordinates, gaps)
    size = flanks.max()
    agrees("mesh forces over the largest", found.flank_forces[0] / size, flanks / size, absolute=1e-8)
    for pinion, shaft in found.shafts.items():
        computed, expected = shaft.forces[0] / size, loads[pinion] / size
        agrees("loads of the bearings over the largest mesh force", computed, expected, absolute=1e-8)
    if any(np.abs(each).max() < 1e-9 * size for each in loads.values()):
        return  # A shaft without load may stand anywhere in its clearances, with the tangents of there.
    frequencies, tangent_frequencies = whole.frequencies(coordinates, gaps), loaded_modes(machine).frequencies
    is_elastic = frequencies > 1.0
    assert np.allclose(tangent_frequencies[is_elastic], frequencies[is_elastic], rtol=1e-8, atol=0)
    assert (tangent_frequencies[~is_elastic] < 1.0).all()
