"""For all tests: no windows, and the same examples of every property each time.

`make random` looks at fresh ones: pytest -m hypothesis --hypothesis-profile=random.
"""

import os

import blas_threads  # noqa: F401 - before all that imports NumPy
import pytest
from hypothesis import settings
from hypothesis.internal.conjecture import providers
from lumped_machines import make_layout, make_machine

pytest_plugins = ["references"]
os.environ.setdefault("MPLBACKEND", "Agg")
settings.register_profile("fixed", derandomize=True)
settings.register_profile("random", derandomize=False, print_blob=True)
settings.load_profile("fixed")


def pytest_configure(config):
    """Keep Hypothesis from trying numbers of whatever modules of the project a worker has imported so far.

    They would make the examples depend on which tests ran before in the same process.
    """
    if config.getoption("--hypothesis-profile") != "random":
        providers._get_local_constants = providers.Constants


@pytest.hookimpl(tryfirst=True)  # before xdist looks for groups
def pytest_collection_modifyitems(items):
    """Tests that share a fixture of their module go to one process, which makes it once."""
    for item in items:
        shared = item.getparent(pytest.Module) and _has_module_fixture(item)
        if shared and item.get_closest_marker("xdist_group") is None:
            item.add_marker(pytest.mark.xdist_group(item.path.stem))


def _has_module_fixture(item):
    known = getattr(item, "_fixtureinfo", None)
    return known and any(found[-1].scope == "module" for found in known.name2fixturedefs.values())


@pytest.fixture
def layout_of():
    return make_layout


@pytest.fixture
def machine_of():
    return make_machine
