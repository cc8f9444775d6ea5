"""For all tests: no windows, and the same examples of every property each time.

`make random` looks at fresh ones: pytest -m hypothesis --hypothesis-profile=random.
"""

import os

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


@pytest.fixture
def layout_of():
    return make_layout


@pytest.fixture
def machine_of():
    return make_machine
