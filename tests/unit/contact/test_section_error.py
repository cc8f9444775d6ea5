"""Error of root stress on a mesh: small at the default, and measured as solid elements have it."""

from dataclasses import replace

import numpy as np
import pytest
from contact_bodies import STEEL, pair_design
from references import against, agrees

from facegear.contact import root_gauges as root_gauges_module
from facegear.contact.bodies.compliance import flank_compliance
from facegear.contact.bodies.surface import interpolation
from facegear.contact.gear_flank import BUILDERS
from facegear.contact.options import Refinement
from facegear.contact.root_gauges import HEIGHTS, root_gauges, section_errors
from facegear.contact.teeth import elastic_tooth
from facegear.sparse.matrices import solve_sparse
from facegear.strength.root_stress import down_the_fillet
from facegear.teeth.mesh_sizes import MeshSizes, named_sizes, thin_fillet
from validation.contact.twin import slab_tooth

DESIGN = pair_design()
M = DESIGN.module


def errors(body, sizes):
    return section_errors(DESIGN, body, BUILDERS[body], sizes, STEEL)


@against(
    "own convergence",
    "finer section",
    capability="root_stress",
    module="facegear.contact.root_gauges",
)
def test_named_meshes_read_root_stress_within_one_percent_wherever_the_load_stands_on_the_flank():
    for level in ("coarse", "medium"):
        sizes = thin_fillet(named_sizes(level, M), level)
        for body in ("pinion", "face_gear"):
            error = errors(body, sizes).error.max()
            agrees(f"error of root stress, {body}, {level} mesh, relative", error, 0.0, absolute=0.01)


def slab_tensions(sizes):
    """Largest tension under 1 N at HEIGHTS of the paper's pinion in plane strain, by 27-node hexahedra."""
    tooth = slab_tooth(DESIGN, replace(sizes, width=0.64 * M))
    elastic, side = elastic_tooth(DESIGN, tooth, STEEL, "right")
    held = elastic.is_held.copy()
    held[:, 1] = True
    gauges, rows = root_gauges(tooth, STEEL)
    found = flank_compliance(replace(elastic, is_held=held), Refinement(), 9, 0, "free", gauges=rows)
    tensions = []
    for height in HEIGHTS:
        at = np.stack([np.full(3, height * (side.flank_rows - 1)), np.arange(3.0)], axis=1)
        load = np.array([1.0, 4.0, 1.0]) / 6.0 @ interpolation(at, side.shape).toarray()
        stress = -(found.readings[0] @ load).reshape(gauges.position.shape[:3])
        tensions.append(down_the_fillet(stress[0]).max())
    return np.array(tensions)


@against(
    "own convergence",
    "finer solid elements",
    capability="root_stress",
    module="facegear.contact.root_gauges",
)
def test_error_of_a_coarse_fillet_is_what_solid_elements_miss_there():
    plain = named_sizes("coarse", M)
    missed = np.abs(slab_tensions(plain) / slab_tensions(MeshSizes(0.05 * M, M, 0.2 * M)) - 1.0).max()
    assert missed > 0.05
    agrees("error of the root stress, relative", errors("pinion", plain).error[0], missed, absolute=0.005)


def test_an_error_is_reported_at_every_place_along_the_face():
    sizes = MeshSizes(1.5e-3, 6e-3, 4e-3)
    gear = errors("face_gear", sizes)
    gauges, _ = root_gauges(BUILDERS["face_gear"](DESIGN, sizes), STEEL, gear)
    assert gauges.error.shape == gauges.along("face_gear").shape
    assert np.diff(gauges.error[-4:]).min() > 0.0  # the fillet sharpens outwards
    assert gear.at(gear.along) == pytest.approx(gear.error)


@pytest.mark.parametrize(("body", "into_tooth"), [("pinion", -1.0), ("face_gear", 1.0)])
def test_an_error_is_that_of_the_flanks_that_mesh_when_the_pinion_drives(body, into_tooth, monkeypatch):
    """The gear's right flanks were loaded, which is the same for symmetric teeth alone."""
    seen = []

    def solve(matrix, loads):
        seen.append(loads)
        return solve_sparse(matrix, loads)

    monkeypatch.setattr(root_gauges_module, "solve_sparse", solve)
    errors(body, MeshSizes(3e-3, 6e-3, 6e-3))
    assert seen
    for loads in seen:
        assert (into_tooth * loads[::2].sum(axis=0) > 0.5).all()
