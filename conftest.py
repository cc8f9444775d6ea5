"""For all tests: no windows; random examples of properties fresh on a developer's machine, fixed in CI."""

import os

import pytest
from hypothesis import settings
from lumped_machines import make_layout, make_machine

os.environ.setdefault("MPLBACKEND", "Agg")
settings.register_profile("ci", derandomize=True)
if os.environ.get("CI"):
    settings.load_profile("ci")


@pytest.fixture
def layout_of():
    return make_layout


@pytest.fixture
def machine_of():
    return make_machine
