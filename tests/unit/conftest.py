import pytest
from lumped_machines import make_layout, make_machine


@pytest.fixture
def layout_of():
    return make_layout


@pytest.fixture
def machine_of():
    return make_machine
