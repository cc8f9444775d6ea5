"""Scratch space of the machines that run side by side: one lane each."""

from typing import NamedTuple

import numpy as np

from facegear.arrays import Array, Integers
from facegear.dynamics.abreast.rows import Structure
from facegear.dynamics.abreast.wide import WIDTH
from facegear.dynamics.integrator.roots import MAX_DEPTH, bernstein_matrix
from facegear.machine_code.fourier import fourier_scratch
from facegear.machine_code.memory import aligned


class Lanes(NamedTuple):
    """The last dimension is the lane.

    values (P, WIDTH): rows of the machines. y, deflection, load: Taylor coefficients as in the single
    integrator's Work; law, error (rows, kinds, WIDTH) of the kinds. side, level, active, acting, edge: state
    of each contact, as there. phase, length, reach (WIDTH,). number: machine in each lane, -1 for none;
    period: those it has completed. powers, parts, angles: of Fourier series.
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
    bernstein: Array
    low: Array
    high: Array
    phase: Array
    length: Array
    first: Array
    number: Integers
    period: Integers
    taken: Integers
    powers: Array
    parts: Array
    angles: Array
    polynomial: Array
    conversion: Array
    conversion_less: Array
    subdivision: Array


def make_lanes(structure: Structure, order: int) -> Lanes:
    """Allocate scratch space."""
    n, m, rows = structure.n, structure.m, order + 1
    terms = max(structure.law_terms, structure.error_terms, structure.load_terms)
    of_contacts = {name: aligned(m, WIDTH) for name in ("force", "side", "level", "active", "acting", "edge")}
    whole = {name: np.zeros(WIDTH, dtype=np.int64) for name in ("number", "period", "taken")}
    return Lanes(
        order=order,
        values=aligned(int(structure.offsets[-1]), WIDTH),
        y=aligned(rows, n, WIDTH),
        deflection=aligned(rows, m, WIDTH),
        law=aligned(rows, structure.law_kinds, WIDTH),
        error=aligned(rows, structure.error_kinds, WIDTH),
        load=aligned(rows, n, WIDTH),
        scaled=aligned(rows, WIDTH),
        low=aligned(WIDTH),
        high=aligned(WIDTH),
        phase=aligned(WIDTH),
        length=aligned(WIDTH),
        first=aligned(WIDTH),
        bernstein=aligned(rows, WIDTH),
        powers=fourier_scratch(terms, rows).powers,
        parts=aligned(2, terms, WIDTH),
        angles=aligned(2, terms, WIDTH),
        polynomial=aligned(rows),
        conversion=bernstein_matrix(order),
        conversion_less=bernstein_matrix(order - 1),
        subdivision=aligned(MAX_DEPTH + 2, rows),
        **of_contacts,
        **whole,
    )
