"""The layer that stands for the teeth of a body, against the teeth of the contact analysis."""

from pathlib import Path

import numpy as np
import pytest
from skfem import Basis, ElementHex2

from facegear.config.elastic_bodies import body_shape
from facegear.config.load import load_config
from facegear.config.tooth_pair import pair_design
from facegear.mesh.hexahedra import hex_mesh
from facegear.mesh.sizes import MeshSizes
from facegear.mesh.tooth import gear_tooth

CONFIG = load_config(Path(__file__).parents[3] / "config" / "flexible.yaml")
SIZES = (0.5, 1.6, 0.9)
"""Of the elements, in modules: the volume is that of four times as many to 1e-4."""


def test_layer_weighs_what_the_papers_teeth_weigh():
    design = pair_design(CONFIG.tooth_pair)
    gear = design.face_gear
    tooth = gear_tooth(design, MeshSizes(*(size * design.module for size in SIZES)))
    mesh, _ = hex_mesh(tooth.nodes, tooth.hexes)
    volume = gear.teeth * float(Basis(mesh, ElementHex2(), intorder=5).dx.sum())
    ring = np.pi * (gear.outer_radius**2 - gear.inner_radius**2)
    layer = body_shape(CONFIG.transmission.face_gear.body, CONFIG.tooth_pair).layer
    assert np.ptp(tooth.nodes[:, 2]) == pytest.approx(layer.front, abs=1e-9)
    filled = (volume - ring * gear.rim_thickness) / (ring * (layer.front - layer.back))
    assert filled == pytest.approx(layer.density, rel=1e-3)
