"""A face wider than a sharp shaper tip can cut goes from its teeth to its life, without a transmission."""

from pathlib import Path

import numpy as np
import pytest

import facegear
from facegear.build.load import load_config
from facegear.build.tooth_pair import pair_design
from facegear.errors import ConfigErrors
from facegear.teeth.limits import sharpest_fillet_radius
from facegear.teeth.mesh_quality import scaled_jacobians
from facegear.teeth.mesh_sizes import named_sizes, thin_fillet
from facegear.teeth.tooth_mesh import gear_tooth

CONFIG = Path(__file__).parents[3] / "config" / "strength_only.yaml"
SIZES = {"profile_mm": 2.6, "width_mm": 44, "thickness_mm": 10, "fillet_depth_mm": 0.8}


def test_the_face_lies_on_both_sides_of_the_radius_where_the_shapers_tip_rolls():
    design = pair_design(load_config(CONFIG).tooth_pair)
    assert design.face_gear.inner_radius < sharpest_fillet_radius(design) < design.face_gear.outer_radius


def test_a_sharp_shaper_is_refused_with_the_one_range_its_fillet_allows():
    with pytest.raises(ConfigErrors) as refused:
        load_config(CONFIG, {"tooth_pair": {"shaper": {"tip_rounding_modules": 0.0}}})
    (line,) = refused.value.lines
    assert "face_gear.outer_radius_mm = 559.0: must be between 465.173 (undercut) and 552.153 (" in line
    assert "tip_rounding_modules" in line


def test_a_rounding_that_leaves_no_tip_land_is_refused():
    with pytest.raises(ConfigErrors, match=r"shaper.tip_rounding_modules = 0.3: must be at most 0.1573"):
        load_config(CONFIG, {"tooth_pair": {"shaper": {"tip_rounding_modules": 0.3}}})


@pytest.mark.parametrize("level", ["coarse", "medium"])
def test_no_element_below_the_small_outer_fillet_is_turned_inside_out(level):
    design = pair_design(load_config(CONFIG).tooth_pair)
    mesh = gear_tooth(design, thin_fillet(named_sizes(level, design.module), level))
    assert scaled_jacobians(mesh.nodes, mesh.hexes).min() > 0.05


def test_one_pair_runs_from_teeth_to_life():
    changes = {
        "mesh.resolution": SIZES,
        "contact.positions_per_pitch": 4,
        "contact.torques_n_m": [3000],
        "contact.refinement": {"depth": 1},
    }
    gearbox = facegear.load(CONFIG, results=None).with_values(changes)
    table = gearbox.rating().table()
    assert set(table["body"]) == {"pinion", "face_gear"}
    assert np.isfinite(table["safety"]).all() and (table["safety"] > 1.0).all()
    assert (table["life_hours"] > 5000).all()
