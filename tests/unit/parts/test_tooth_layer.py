"""The layer that stands for the teeth of a body, against the teeth of the contact analysis."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from skfem import Basis, ElementHex2

from facegear.build.elastic_bodies import body_shape, fitted_shape
from facegear.build.load import load_config
from facegear.build.tooth_pair import pair_design
from facegear.parts import tooth_layer
from facegear.parts.section import rectangle
from facegear.parts.tooth_layer import rim_below
from facegear.teeth.mesh_quality import hex_mesh
from facegear.teeth.mesh_sizes import MeshSizes
from facegear.teeth.tooth_mesh import gear_tooth

CONFIG = load_config(Path(__file__).parents[3] / "config" / "flexible.yaml")
BODY = CONFIG.transmission.face_gear.body
FITTED = BODY.model_copy(update={"teeth": "fitted"})
SIZES = (0.5, 1.6, 0.9)
"""Sizes of the elements, in modules: the volume is that of four times as many to 1e-4."""


def test_layer_weighs_what_the_papers_teeth_weigh():
    design = pair_design(CONFIG.tooth_pair)
    gear = design.face_gear
    tooth = gear_tooth(design, MeshSizes(*(size * design.module for size in SIZES)))
    mesh, _ = hex_mesh(tooth.nodes, tooth.hexes)
    volume = gear.teeth * float(Basis(mesh, ElementHex2(), intorder=5).dx.sum())
    ring = np.pi * (gear.outer_radius**2 - gear.inner_radius**2)
    layer = body_shape(BODY, CONFIG.tooth_pair).layer
    assert np.ptp(tooth.nodes[:, 2]) == pytest.approx(layer.front, abs=1e-9)
    filled = (volume - ring * gear.rim_thickness) / (ring * (layer.front - layer.back))
    assert filled == pytest.approx(layer.density, rel=1e-3)
    assert filled == pytest.approx(body_shape(FITTED, CONFIG.tooth_pair).layer.density, rel=2e-4)


def test_layer_fitted_to_the_papers_teeth_is_nearly_that_of_common_ones():
    """A script of another session, with bricks and waves of its own, gave 0.055 and 0.125."""
    layer = fitted_shape(FITTED, CONFIG.tooth_pair).layer
    assert (layer.hoop, layer.shear) == pytest.approx((0.055, 0.126), abs=1e-3)
    assert fitted_shape(BODY, CONFIG.tooth_pair).layer == body_shape(BODY, CONFIG.tooth_pair).layer


@pytest.mark.parametrize(("hoop", "shear"), [(0.02, 0.3), (0.2, 0.05)])
def test_fit_gives_the_numbers_of_the_layer_whose_energies_it_sees(monkeypatch, hoop, shear):
    shape = body_shape(FITTED, CONFIG.tooth_pair)
    monkeypatch.setattr(tooth_layer, "ELEMENTS", (3, 1, 2))
    layer = replace(shape.layer, hoop=hoop, shear=shear)
    energies = tooth_layer.layer_energies(layer, shape, rim_below(shape))
    monkeypatch.setattr(tooth_layer, "tooth_energies", lambda *given: energies)
    found = tooth_layer.fitted_teeth(shape, pair_design(CONFIG.tooth_pair)).layer
    assert (found.hoop, found.shear) == pytest.approx((hoop, shear), rel=1e-6)


def test_rim_is_as_thick_as_the_section_is_below_the_teeth_on_the_mean():
    shape = body_shape(FITTED, CONFIG.tooth_pair)
    assert rim_below(shape) == pytest.approx(0.024, rel=1e-12)
    slanted = np.array([(0.2, -0.01), (0.25, -0.01), (0.275, 0.002), (0.275, 0.012), (0.2, 0.012)])
    assert rim_below(replace(shape, corners=slanted)) == pytest.approx(0.016, rel=1e-12)
    thick = rectangle(0.2, 0.3, -0.1, 0.012)
    assert rim_below(replace(shape, corners=thick)) == pytest.approx(0.025, rel=1e-12)
