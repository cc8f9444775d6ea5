"""Scratch space of the machines that run side by side: one lane each."""

from typing import NamedTuple

import numpy as np

from facegear.arrays import Array, Integers
from facegear.dynamics.abreast.rows import Structure
from facegear.dynamics.abreast.wide import WIDTH
from facegear.dynamics.integrator.roots import MAX_DEPTH, bernstein_matrix
from facegear.machine_code.fourier import fourier_scratch
from facegear.machine_code.memory import aligned
from facegear.machine_code.records import Record

NONE = -1


@Record.register
class Tally(NamedTuple):
    """What lanes add up over a batch of periods, or over all periods of a machine; the last dimension is the
    lane.

    off, heavy (nodes, n): coordinates at the nodes of a step, from their origin, and times their weights.
    products: of pairs of coordinates. The others are as in the single integrator's Sums; fractions (3, m) are
    the phase spent open, on the drive and on the back flank, rad; stiffness (kinds,) is the law's now.
    """

    origin: Array
    level: Array
    coordinates: Array
    products: Array
    off: Array
    heavy: Array
    deflections: Array
    squared: Array
    forces: Array
    minimum: Array
    maximum: Array
    pull: Array
    fractions: Array
    stiffness: Array


@Record.register
class Lanes(NamedTuple):
    """The last dimension of all but the tables is the lane, and WIDTH long.

    values (P,): the machines' rows. y, deflection, law, error, load (rows, coordinates, contacts or kinds):
    Taylor coefficients. force, side, level, active, acting, edge (contacts,): as in the single integrator's
    Work, with one piece of the law. scaled (rows,): terms of one contact's deflection over the step, terms:
    of its way from a level. first: fraction of the step up to a switch. way_terms (2 contacts, rows): ways
    from a level that change their sign within the step, way_changes how often, way_standing whether (1)
    the zero at the start is divided out, ways (): how many a lane has, wanted: which lanes have one more.
    phase in the period and length of the step, rad, and longest that it may be; ahead: from its start to a
    sample, sample (coordinates,). turn, turned (rows, coordinates or contacts): of a disturbance and its
    deflections, was_acting (contacts,): damping in the step before; fresh: 1 in the first step of a machine.
    number of the machine in a lane or NONE; period: periods it has run; taken, sampled: steps and samples of
    this one. parts, angles: of Fourier series. powers, conversion, nodes: tables that are only read, the last
    of the rule that integrates. polynomial, subdivision: of one lane's zeros.
    """

    order: int
    values: Array
    y: Array
    deflection: Array
    law: Array
    error: Array
    load: Array
    force: Array
    side: Array
    level: Array
    active: Array
    acting: Array
    edge: Array
    scaled: Array
    terms: Array
    phase: Array
    length: Array
    ahead: Array
    first: Array
    way_terms: Array
    way_changes: Array
    way_standing: Array
    ways: Integers
    wanted: Array
    longest: Array
    sample: Array
    turn: Array
    turned: Array
    was_acting: Array
    fresh: Array
    tally: Tally
    number: Integers
    period: Integers
    taken: Integers
    sampled: Integers
    powers: Array
    parts: Array
    angles: Array
    polynomial: Array
    conversion: Array
    subdivision: Array
    nodes: Array


def make_lanes(structure: Structure, order: int, nodes: Array) -> Lanes:
    """Allocate scratch space. nodes (2, count): of the rule that integrates over a step, and weights."""
    n, m, rows = structure.n, structure.m, order + 1
    terms = max(structure.law_terms, structure.error_terms, structure.load_terms)
    return Lanes(
        order=order,
        values=aligned(int(structure.offsets[-1]), WIDTH),
        y=aligned(rows, n, WIDTH),
        deflection=aligned(rows, m, WIDTH),
        law=aligned(rows, structure.law_kinds, WIDTH),
        error=aligned(rows, structure.error_kinds, WIDTH),
        load=aligned(rows, n, WIDTH),
        scaled=aligned(rows, WIDTH),
        phase=aligned(WIDTH),
        length=aligned(WIDTH),
        ahead=aligned(WIDTH),
        first=aligned(WIDTH),
        way_terms=aligned(2 * m, rows, WIDTH),
        way_changes=aligned(2 * m, WIDTH),
        way_standing=aligned(2 * m, WIDTH),
        ways=np.zeros(WIDTH, dtype=np.int64),
        wanted=aligned(WIDTH),
        longest=aligned(WIDTH),
        turn=aligned(rows, n, WIDTH),
        turned=aligned(rows, m, WIDTH),
        was_acting=aligned(m, WIDTH),
        fresh=aligned(WIDTH),
        tally=_tally(structure, nodes.shape[1]),
        nodes=nodes,
        sample=aligned(n, WIDTH),
        terms=aligned(rows, WIDTH),
        powers=fourier_scratch(terms, rows).powers,
        parts=aligned(2, terms, WIDTH),
        angles=aligned(2, terms, WIDTH),
        polynomial=aligned(rows),
        conversion=bernstein_matrix(order),
        subdivision=aligned(MAX_DEPTH + 2, rows),
        force=aligned(m, WIDTH),
        side=aligned(m, WIDTH),
        level=aligned(m, WIDTH),
        active=aligned(m, WIDTH),
        acting=aligned(m, WIDTH),
        edge=aligned(m, WIDTH),
        number=np.zeros(WIDTH, dtype=np.int64),
        period=np.zeros(WIDTH, dtype=np.int64),
        taken=np.zeros(WIDTH, dtype=np.int64),
        sampled=np.zeros(WIDTH, dtype=np.int64),
    )


def _tally(structure: Structure, nodes: int) -> Tally:
    n, m = structure.n, structure.m
    return Tally(
        origin=aligned(n, WIDTH),
        level=aligned(m, WIDTH),
        coordinates=aligned(n, WIDTH),
        products=aligned(n * (n + 1) // 2, WIDTH),
        off=aligned(nodes, n, WIDTH),
        heavy=aligned(nodes, n, WIDTH),
        deflections=aligned(m, WIDTH),
        squared=aligned(m, WIDTH),
        forces=aligned(2, m, WIDTH),
        minimum=aligned(m, WIDTH),
        maximum=aligned(m, WIDTH),
        pull=aligned(m, WIDTH),
        fractions=aligned(3, m, WIDTH),
        stiffness=aligned(structure.law_kinds, WIDTH),
    )
