"""Scratch space of the machines that run side by side: one lane each."""

from typing import NamedTuple

import numpy as np

from facegear.arrays import Array, Integers
from facegear.dynamics.abreast.rows import Structure
from facegear.dynamics.abreast.wide import WIDTH
from facegear.dynamics.integrator.roots import MAX_DEPTH, bernstein_matrix
from facegear.machine_code.fourier import fourier_scratch
from facegear.machine_code.memory import aligned

NONE = -1


class Lanes(NamedTuple):
    """The last dimension of all but the tables is the lane, and WIDTH long.

    values (P,): the machines' rows. y, deflection, law, error, load (rows, coordinates, contacts or kinds):
    Taylor coefficients. force, side, level, active, acting, edge (contacts,): as in the single integrator's
    Work, with one piece of the law. scaled (rows,): terms of one contact's deflection over the step, terms:
    of its way from a level. first: fraction of the step up to a switch. phase in the period and length of the
    step, rad; ahead: from its start to a sample, sample (coordinates,). number of the machine in a lane or
    NONE; period: periods it has run; taken, sampled: steps and samples of this one. parts, angles: of Fourier
    series. powers, conversion: tables that are only read. polynomial, subdivision: of one lane's zeros.
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
    sample: Array
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


def make_lanes(structure: Structure, order: int) -> Lanes:
    """Allocate scratch space."""
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
