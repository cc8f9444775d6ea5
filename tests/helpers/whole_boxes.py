"""The small machine on every node of the public box: modes and vibration without any reduction.

`python -m tests.helpers.whole_boxes` (half a minute of processor time) writes
`tests/unit/casing/whole_box.csv`. The bodies, their bearings and flanks are those of `linear`, the casing's
elements those of `box_casings`; seats and base are tied to their patches by elimination.
"""

from pathlib import Path

import numpy as np
import pandas as pd
from scipy import sparse
from scipy.sparse import linalg

from facegear.casing.reduction import interface_rows
from facegear.machine.statics import mean_equilibrium
from tests.helpers.box_casings import box_casing, wall_seats
from tests.helpers.public_casing import mount_public
from tests.helpers.seated_machines import STIFFNESS, make_small_machine, place_on

FILE = Path(__file__).parents[1] / "unit" / "casing" / "whole_box.csv"
CUBES = (15, 13, 9)
MODES = 13
CORNER = (150.0, 130.0, 90.0)
LOSS = 0.02
"""Loss factor of all stiffness."""


def whole_matrices():
    """Sparse K and M over bodies, seats and inner rows, rows (6, n) of the flanks that carry, the row of
    the lower mesh of the input, and rows (3, n) of the corner, m.
    """
    casing, places = box_casing(CUBES)
    seats, base = wall_seats(CUBES, places)
    tie, inner = interface_rows(casing, [*seats, base])
    moved = tie[:, :30]  # the base is held
    columns = sparse.hstack(
        [sparse.csc_array(moved), sparse.eye_array(casing.size, format="csc")[:, inner]], format="csc"
    )
    machine = make_small_machine(casing=place_on(mount_public(0)))
    linear, bodies, guyan = machine.linear, machine.lumped_model.size, machine.casing.mounted
    size = bodies + columns.shape[1]
    seated = np.arange(bodies + 30)
    whole = []
    for own, of_guyan, of_elements in (
        (linear.stiffness, guyan.stiffness, casing.stiffness),
        (linear.mass, guyan.mass, casing.mass),
    ):
        small = own.copy()
        small[bodies:, bodies:] -= of_guyan
        elements = columns.T @ of_elements @ columns
        corner = sparse.csc_array(
            (small.ravel(), (np.repeat(seated, seated.size), np.tile(seated, seated.size))),
            shape=(size, size),
        )
        whole.append(
            (corner + sparse.block_diag([sparse.csc_array((bodies, bodies)), elements], format="csc")).tocsc()
        )
    is_carrying = mean_equilibrium(machine).flank_forces[0] > 0.0
    rows = np.zeros((len(linear.rows), size))
    rows[:, : seated.size] = linear.rows
    node = int(np.flatnonzero(np.abs(places - CORNER).max(axis=1) < 1e-6)[0]) + 1
    at = [casing.rows_of_node[node][direction] for direction in (1, 2, 3)]
    corner_rows = np.zeros((3, size))
    corner_rows[:, bodies:] = columns[at].toarray()
    return *whole, rows[is_carrying], rows[0], corner_rows


def factors(matrix):
    """Factors of a symmetric matrix in an order that keeps it sparse."""
    return linalg.splu(matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})


def compute():
    """Table of frequencies, Hz, and amplitudes of acceleration, m/s2, with the columns of the stored file."""
    stiffness, mass, carrying, first, corner = whole_matrices()
    flanks = sparse.csc_array(carrying)
    whole = (stiffness + STIFFNESS * flanks.T @ flanks).tocsc()
    # Below zero, so that the rigid rotation of all bodies leaves nothing singular.
    shift = -((2.0 * np.pi * 300.0) ** 2)
    inverse = linalg.LinearOperator(whole.shape, factors(whole - shift * mass).solve, dtype=float)
    values = linalg.eigsh(whole, MODES, mass, sigma=shift, OPinv=inverse, return_eigenvectors=False)
    frequencies = np.sqrt(np.maximum(np.sort(values), 0.0)) / (2.0 * np.pi)
    table = [("frequency_hz", number, value) for number, value in enumerate(frequencies.tolist(), start=1)]
    for frequency in (1000.0, 1600.0):
        omega = 2.0 * np.pi * frequency
        dynamic = ((1.0 + 1j * LOSS) * whole - omega**2 * mass).tocsc()
        motion = factors(dynamic).solve(-STIFFNESS * 1e-6 * first.astype(complex))
        table += [
            (f"acceleration_{frequency:.0f}_hz_m_per_s2", number, value)
            for number, value in enumerate(np.abs(omega**2 * corner @ motion).tolist(), start=1)
        ]
    return pd.DataFrame(table, columns=["quantity", "number", "value"])


if __name__ == "__main__":
    compute().to_csv(FILE, index=False)
