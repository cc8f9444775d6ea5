"""Tests that run the same kind of compiled motion go to one process: a second would only await its code."""

import pytest

KINDS = {
    "load_dependent": ("test_load_dependent_motion", "test_two_pairs_on_tables", "test_motion_past_a_table"),
    "power_laws": ("test_power_laws", "test_manufactured_motions"),
    "clearance": ("test_bearing_forces", "test_dynamics_rings"),
    "turning_bodies": ("test_turning_bodies",),
    "rubbing_flanks": ("test_rubbing_flanks",),
}
GROUPS = {module: kind for kind, modules in KINDS.items() for module in modules}


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items):
    for item in items:
        if (kind := GROUPS.get(item.path.stem)) is not None:
            item.add_marker(pytest.mark.xdist_group(kind))
