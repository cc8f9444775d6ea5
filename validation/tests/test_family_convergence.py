"""Meshes of loaded contact by kind of teeth against finer ones."""

import numpy as np
import pandas as pd
import pytest

from validation.contact.family_convergence import (
    BASE,
    FINER,
    LIMITS,
    PAIRS,
    TABLE,
    MeshLevel,
    convergence_table,
    directions,
)

ABOVE = {("helical", "stiffness"): 0.36, ("offset", "pressure"): 6.0}
"""Errors of the medium mesh that are above their limits, percent, by kind and quantity; the page says so."""


@pytest.fixture(scope="module")
def stored():
    return pd.read_csv(TABLE)


def test_stored_rows_are_those_of_the_script(stored):
    wanted = [(kind, direction) for kind in PAIRS for direction in directions(BASE, FINER)]
    assert sorted(zip(stored["teeth"], stored["finer_in"], strict=True)) == sorted(wanted)


@pytest.mark.parametrize("quantity", LIMITS)
@pytest.mark.parametrize("kind", PAIRS)
def test_stored_errors_of_the_medium_mesh_are_those_the_page_states(stored, kind, quantity):
    errors = stored.loc[stored["teeth"] == kind, f"{quantity}_error_percent"].abs()
    assert errors.max() <= ABOVE.get((kind, quantity), LIMITS[quantity])


def test_finer_elements_make_a_helical_pair_softer():
    """Shorter elements and thinner ones in the flank layer: conforming elements are too stiff."""
    coarse = MeshLevel(0.4, 1.2, 1.0, positions=3)
    table = convergence_table(("helical",), coarse).set_index("finer_in")
    assert len(table) == len(directions(coarse, FINER))
    errors = table["stiffness_error_percent"]
    assert errors["base"] == 0.0
    assert errors[["face", "cells along", "depth"]].between(0.0, 0.5, inclusive="neither").all()
    assert np.abs(table["pressure_error_percent"]).max() < 10.0
