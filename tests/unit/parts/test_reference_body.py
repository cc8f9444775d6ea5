"""A steel gear body against what other programs gave for it.

Source of all numbers: Fourier finite elements of their own, Richardson's extrapolation over three meshes, to
0.01 %; the whole gear in hexahedra of 27 nodes agrees to 0.2 %. The first nodal diameters with 143 teeth are
those of a cyclic sector in hexahedra. They cannot see an error that both share: linear elasticity.
"""

from dataclasses import replace

import gear_bodies
import numpy as np
import pytest
from references import against, agrees

from facegear.parts.body_mesh import body_mesh
from facegear.parts.gear_body import SMOOTH, influence, mean_compliance, sampled_orders
from facegear.parts.matrices import body_matrices
from facegear.parts.modes import held_solver, order_modes, resonant_speeds, wave_frequencies
from facegear.parts.section import Layer, section_properties

pytestmark = pytest.mark.xdist_group("reference_body")  # solved once a process

FREQUENCIES = [
    (897.21, 3037.02, 3374.22),
    (749.79, 3455.77, 4299.08),
    (693.38, 3695.27, 6353.67),
    (882.18, 4082.34, 7724.36),
    (1319.93, 4616.52, 8792.13),
    (1947.06, 5301.07, 9889.13),
    (2724.77, 6134.73),
]
GYROSCOPIC = [
    (0, 0, 0),
    (-0.0506, -0.0120, -0.3815),
    (-0.0470, -0.0186, -0.8798),
    (-0.0430, -0.0267, -0.7624),
    (-0.0414, -0.0326, -0.4743),
    (-0.0409, -0.0361, -0.2749),
    (-0.0409, -0.0382),
]
STIFFENING = [
    (0.826, 0.449, 5.722),
    (1.401, 6.337, 0.653),
    (3.322, 8.215, 1.026),
    (6.587, 11.279, 4.346),
    (11.180, 15.514, 10.791),
    (17.104, 20.934, 20.250),
    (24.361, 27.568),
]
FORWARD = [769.26, 733.61, 943.14, 1401.23, 2048.54, 2846.38]
BACKWARD = [731.08, 655.08, 824.24, 1242.05, 1849.14, 2606.77]
MET_FORWARD = [376.46, 316.71, 294.98, 378.02, 569.75, 846.68, 1193.75]
MET_BACKWARD = [376.46, 312.53, 287.03, 362.70, 539.04, 789.88, 1098.13]
AXIAL = [2.7498, 7.6953, 8.9988, 5.5662, 2.4811, 1.1357, 0.5772]
ROUND = [0.2060, 0.4324, 0.5289, 0.4516, 0.2866, 0.1816, 0.1234]
MIXED = [0, 1.3208, 1.9997, 1.5047, 0.8004, 0.4286, 0.2504]
RPM = np.pi / 30


def each(table):
    return [(order, value) for order, row in enumerate(table) for value in row]


@against(
    "second implementation",
    "Fourier elements extrapolated, hexahedra of a whole gear",
    capability="gear_bodies",
    module="facegear.parts.gear_body",
)
def test_mass_and_inertia_of_the_section_are_those_of_its_polygon():
    *found, _ = section_properties(gear_bodies.section())
    agrees("mass kg, inertia kg m2", found, [29.7516, 1.262375, 0.643123], relative=2e-6)


@against(
    "second implementation",
    "Fourier elements extrapolated, hexahedra of a whole gear",
    capability="gear_bodies",
    module="facegear.parts.gear_body",
)
def test_modes_turn_the_speed_into_waves_as_another_program_has_it():
    orders = gear_bodies.reference_body().orders[:7]
    for modes, w, c, b in zip(orders, FREQUENCIES, GYROSCOPIC, STIFFENING, strict=True):
        count = len(w)
        agrees("frequency with the bore held, Hz", modes.frequencies[:count], w, relative=5e-4)
        agrees("gyroscopic factor", modes.gyroscopic_factors[:count], c, absolute=5e-4)
        agrees("stiffening factor", modes.stiffening_factors[:count], b, absolute=2e-3, relative=1e-3)
        assert modes.frequencies.size < count + 3


@against(
    "second implementation",
    "Fourier elements extrapolated, hexahedra of a whole gear",
    capability="gear_bodies",
    module="facegear.parts.gear_body",
)
def test_forward_and_backward_waves_meet_the_mesh_frequency_where_another_program_has_them():
    orders = gear_bodies.reference_body().orders[:7]
    speed = 1206.29 * RPM
    waves = np.array([[wave[0] for wave in wave_frequencies(modes, speed)] for modes in orders])
    agrees("forward wave, Hz", waves[1:, 0], FORWARD, relative=5e-4)
    agrees("backward wave, Hz", waves[1:, 1], BACKWARD, relative=5e-4)
    met = [[found[0] / RPM for found in resonant_speeds(modes, gear_bodies.TEETH, 1)] for modes in orders]
    agrees(
        "speed at which the mesh frequency meets a forward wave, rpm",
        np.array(met)[:, 0],
        MET_FORWARD,
        relative=5e-4,
    )
    agrees("and a backward wave, rpm", np.array(met)[:, 1], MET_BACKWARD, relative=5e-4)


@against(
    "second implementation",
    "Fourier elements extrapolated, hexahedra of a whole gear",
    capability="gear_bodies",
    module="facegear.parts.gear_body",
)
def test_compliance_below_a_mesh_and_between_meshes_is_that_of_another_program():
    static = gear_bodies.reference_body().static(gear_bodies.PATCH)
    for quantity, place, expected in (
        ("axial", (0, 0), AXIAL),
        ("round", (1, 1), ROUND),
        ("mixed", (0, 1), MIXED),
    ):
        agrees(
            f"{quantity} compliance of orders 0 to 6, nm/N",
            1e9 * static[:7, *place],
            expected,
            relative=5e-4,
            absolute=1e-4,
        )
    agrees("axial compliance of all orders, m/N", static[:, 0, 0].sum(), 3.0204e-8, relative=5e-4)
    agrees("round compliance of all orders, m/N", static[:, 1, 1].sum(), 2.824e-9, relative=5e-4)
    angle = np.radians(25)
    drive, back = (gear_bodies.flank_direction(angle, back) for back in (False, True))
    agrees("own compliance, m/N", influence(static, 0.0, drive, drive), 7.714e-9, relative=3e-3)
    agrees("drive by back flank, m/N", influence(static, 0.0, drive, back), 3.075e-9, relative=3e-3)
    pitches = np.array([22.5, 45.5, 23, 52, 75])
    found = [influence(static, 2 * np.pi * p / gear_bodies.TEETH, drive, drive) for p in pitches]
    agrees(
        "between meshes, m/N", found, np.array([-7.055, -3.329, -7.645, -1.039, 0.578]) * 1e-10, relative=3e-3
    )


@against(
    "second implementation",
    "masses of the modes, Fourier elements extrapolated",
    capability="gear_bodies",
    module="facegear.parts.gear_body",
)
def test_hub_that_moves_drags_the_modes_of_none_and_one_nodal_diameter():
    zero, one = gear_bodies.reference_body().orders[:2]
    agrees("mass coupling of axial motion", np.abs(zero.hub[0, 0]), 3.99319, relative=5e-4)
    agrees(
        "mass coupling of sideways motion and tilt", np.abs(one.hub[:, 0]), [0.94095, 0.67771], relative=5e-4
    )
    assert np.sign(one.hub[0, 0]) == -np.sign(one.hub[1, 0])


@against(
    "second implementation",
    "cyclic sector of a gear with its 143 teeth",
    capability="gear_bodies",
    module="facegear.parts.gear_body",
)
def test_layer_of_teeth_lowers_the_frequencies_as_real_teeth_do():
    layer = Layer(0.250, 0.275, 0.012, 0.012 + 2.25 * 3.75e-3)
    section = replace(gear_bodies.section(), layer=layer)
    body = body_matrices(section, body_mesh(section))
    found = [order_modes(body, order, np.inf, expected_count=1).frequencies[0] for order in (0, 2, 6)]
    agrees("first frequency with teeth, Hz", found, [852.4, 651.1, 2632.6], relative=5e-3)


def test_compliance_between_the_orders_computed_is_smooth_enough_to_be_read_off():
    body = gear_bodies.reference_matrices()
    for order in (11, 26, 47):
        assert order > SMOOTH and order not in sampled_orders(60)
        computed = mean_compliance(body, held_solver(body, order))
        read = gear_bodies.reference_body().compliances[order]
        assert read == pytest.approx(computed, rel=2e-4)
