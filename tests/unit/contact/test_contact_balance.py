"""Response of the finite elements of both bodies to the contact's forces."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from contact_bodies import STEEL, pair_design, stiffness
from references import against, agrees

from facegear.contact.bodies.compliance import flank_compliance
from facegear.contact.bodies.layer import tied_system
from facegear.contact.candidates import influence_matrix
from facegear.contact.flanks import flank_pair
from facegear.contact.gear_flank import BUILDERS
from facegear.contact.options import ContactOptions, Refinement
from facegear.contact.position_solver import solve_contact
from facegear.contact.search import find_candidates
from facegear.contact.teeth import elastic_tooth
from facegear.sparse.matrices import solve_sparse
from facegear.teeth.mesh_sizes import MeshSizes
from facegear.teeth.unloaded_contact import unloaded_contact

CUTS = Refinement(2, 1, 2, 2.0)
TORQUE = 400.0


@pytest.fixture(scope="module")
def pressed_teeth():
    """One tooth of each gear, cut faces free: teeth, elements, the pair's contact and what made it."""
    design, none = pair_design(), np.zeros(0, dtype=np.int64)
    teeth, sides = zip(
        *(elastic_tooth(design, B(design, MeshSizes(1.5e-3, 6e-3, 3e-3)), STEEL) for B in BUILDERS.values()),
        strict=True,
    )
    teeth = [replace(tooth, left=none, right=none) for tooth in teeth]
    bodies = [flank_compliance(tooth, CUTS) for tooth in teeth]
    systems = [tied_system(tooth, CUTS) for tooth in teeth]
    phi1 = -0.1 * 2 * pi / design.pinion.teeth
    phi2 = float(unloaded_contact(design, [phi1]).phi2[0])
    flanks = flank_pair(design, sides, (CUTS, CUTS))
    pairs = find_candidates(flanks, (phi1, phi2), np.array([0]), 4e-3, ContactOptions())
    contact = solve_contact(influence_matrix(pairs, *bodies), pairs[0].gap, pairs[0].lever_arm, TORQUE)
    return systems, bodies, pairs[0], contact


def answer(system, nodal):
    """Forces (n, 3) on the masters, their displacements (n, 3), and the reactions (n, 3) where held."""
    force = np.zeros((len(system.points), 3))
    force[system.loaded_nodes] = (system.spread.T @ nodal)[:, None] * system.loaded_normals
    free = ~system.is_held.ravel()
    moved = np.zeros(free.size)
    matrix = stiffness(system.parts)
    moved[free] = solve_sparse(matrix[free][:, free], -force.ravel()[free][:, None]).ravel()
    reaction = (matrix @ moved).reshape(force.shape) + force
    return -force, moved.reshape(force.shape), np.where(system.is_held, reaction, 0.0)


@against(
    "analytic",
    "balance of forces and moments of a body",
    capability="contact compliance",
    module="facegear.contact.ltca",
)
@pytest.mark.parametrize("body", [0, 1], ids=["pinion", "face gear"])
def test_contact_forces_and_reactions_of_a_body_balance_in_all_six_components(pressed_teeth, body):
    systems, _, pair, contact = pressed_teeth
    loads = pair.loads(body, True)
    force, _, reaction = answer(systems[body], loads.T @ contact.force)
    points = systems[body].points
    scale = np.linalg.norm(force.sum(axis=0))
    assert scale > 5e3
    agrees("force on a body, N", (force + reaction).sum(axis=0), 0.0, relative=1e-7, absolute=1e-10 * scale)
    moment = np.cross(points, force + reaction).sum(axis=0)
    agrees("moment on a body, N m", moment, 0.0, relative=1e-7, absolute=1e-10 * scale * np.abs(points).max())


@against(
    "analytic",
    "balance of torque",
    capability="contact",
    module="facegear.contact.ltca",
)
def test_bore_feels_the_torque_that_the_contact_was_solved_for(pressed_teeth):
    systems, _, pair, contact = pressed_teeth
    _, _, reaction = answer(systems[0], pair.loads(0, True).T @ contact.force)
    moment = np.cross(systems[0].points, reaction)[:, 1].sum()
    agrees("torque at the bore, N m", abs(moment), TORQUE, relative=1e-3)


def test_flanks_displaced_by_the_finite_elements_just_touch_where_pressed(pressed_teeth):
    systems, bodies, pair, contact = pressed_teeth
    approach = np.zeros(len(contact.force))
    for system, body, loads in zip(systems, bodies, (pair.loads(0, True), pair.loads(1, True)), strict=True):
        nodal = loads.T @ contact.force
        _, moved, _ = answer(system, nodal)
        normal = system.spread @ np.sum(moved[system.loaded_nodes] * system.loaded_normals, axis=1)
        np.testing.assert_allclose(-normal, body.loaded_tooth @ nodal, atol=1e-9 * np.abs(normal).max())
        approach -= loads @ normal
    clearance = pair.gap + approach - contact.rotation * pair.lever_arm
    largest = contact.rotation * pair.lever_arm.max()
    np.testing.assert_allclose(clearance[contact.active], 0.0, atol=1e-9 * largest)
    assert clearance.min() > -1e-9 * largest


def test_both_gears_are_pressed_alike(pressed_teeth):
    systems, _, pair, contact = pressed_teeth
    forces = [
        np.linalg.norm(answer(system, loads.T @ contact.force)[0].sum(axis=0))
        for system, loads in zip(systems, (pair.loads(0, True), pair.loads(1, True)), strict=True)
    ]
    assert forces[0] == pytest.approx(forces[1], rel=1e-3)
