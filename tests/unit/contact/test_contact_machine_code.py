"""Machine code of a contact, compiled before there is one."""

import os
import subprocess
import sys

import numpy as np
from forked_python import run_together

from facegear.contact.bodies.surface import face_functions

PROGRAM = """
from contact_bodies import COARSE, STEEL, pair_design

from facegear.contact.ltca import loaded_contact
from facegear.contact.options import ContactOptions, ContactPlan, Sector
from facegear.contact.pair import contact_model, gear_flank
from facegear.contact.prepare import prepare
from facegear.contact.pressure import flank_pressure
from facegear.machine_code.stored import SourcesCache

asked, load = [], SourcesCache.load_overload


def noted(cache, *types):
    asked.append(cache._function.__name__)
    return load(cache, *types)


SourcesCache.load_overload = noted
design, (sizes, cuts) = pair_design(), COARSE
plan = ContactPlan((600.0,), 4, cuts, Sector(), ContactOptions())
flanks = [gear_flank(design, body, sizes, STEEL, plan) for body in ("pinion", "face_gear")]
model = contact_model(design, *flanks)
of_bodies = len(asked)
prepare()
print(*asked[of_bodies:])
prepared = len(asked)
flank_pressure(loaded_contact(model, [0.1, 0.4], [100.0, 600.0]), model.flanks, (STEEL, STEEL))
print(*asked[prepared:])
"""


def test_a_contact_of_bodies_that_are_known_compiles_nothing_once_its_machine_code_is_prepared():
    (done,) = run_together([PROGRAM], {"PYTHONPATH": os.pathsep.join(sys.path)})
    assert done.returncode == 0, done.stderr
    prepared, compiled = done.stdout.splitlines()
    assert {"touching", "cut_rays"} <= set(prepared.split())
    assert compiled.split() == []


PLAIN = """
import numpy as np
from facegear.contact.bodies.surface import face_functions
from facegear.contact.both_sides import add_averages
from facegear.contact.prepare import prepare
from facegear.machine_code import versions
prepare()
rows = np.array([0, 2, 3]), np.array([0, 2, 1]), np.array([0.5, 0.25, 2.0])
matrix, compliance = np.zeros((2, 2)), np.arange(9.0).reshape(3, 3)
add_averages(matrix, (0, 0), 2.0, rows, compliance, rows, False)
found = *face_functions(np.array([[0.25, 1.75], [3.0, 2.5]]), (5, 5)), matrix
print(versions.NUMBA_IS_KNOWN, *np.concatenate([part.ravel() for part in found]).tolist())
"""


def test_without_numbas_private_parts_the_same_functions_run_with_the_same_answers():
    """By Python itself here: compiling them takes minutes."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path), "NUMBA_DISABLE_JIT": "1"}
    done = subprocess.run(
        [sys.executable, "-c", PLAIN], env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    known, *numbers = done.stdout.split()
    averages = np.array([[0.5, 0.0, 0.25], [0.0, 2.0, 0.0]])
    matrix = 2.0 * averages @ np.arange(9.0).reshape(3, 3) @ averages.T
    expected = *face_functions(np.array([[0.25, 1.75], [3.0, 2.5]]), (5, 5)), matrix.T
    assert known == "False"
    flat = np.concatenate([part.ravel() for part in expected])
    np.testing.assert_allclose(np.array(numbers, float), flat, rtol=1e-14, atol=1e-15)
