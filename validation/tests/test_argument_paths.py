"""A machine and its backlash pass few functions from the config to the compiled loop."""

import pytest

from validation.argument_paths import MOST_FOR_BACKLASH, MOST_FUNCTIONS, follow, homes


@pytest.fixture(scope="module")
def paths():
    """Functions that the example passes."""
    return follow()


def names(functions):
    """Names of functions without their modules."""
    return {function.name for function in functions}


def test_the_machine_passes_few_functions_from_the_stage_to_the_kernel(paths):
    visits = paths.visits("stage")
    assert {"dynamics_response", "build_model", "machine_system", "start_run", "settle"} <= names(visits)
    assert len(visits) <= MOST_FUNCTIONS


def test_the_section_passes_few_functions_until_the_machine_is_built(paths):
    assert {"MachineInputs.build", "machine", "half_backlash"} <= names(paths.visits("build"))
    assert len(paths.visits("build")) <= MOST_FUNCTIONS


def test_no_call_with_the_machine_goes_up_to_a_package_above_its_caller(paths):
    callers = {caller for visit in paths.machine.values() for caller in visit.callers}
    assert len(callers) > MOST_FUNCTIONS
    assert paths.upward == []


def test_half_the_backlash_has_one_home():
    assert homes() == ["facegear.machine.machine.Machine"]


def test_half_the_backlash_passes_few_functions_from_the_file_to_the_kernel(paths):
    assert {"half_backlash", "machine", "machine_system", "packed_system"} <= names(paths.on_the_way)
    assert len(paths.on_the_way) <= MOST_FOR_BACKLASH
    assert {"assembly", "settle", "length_scale"} <= names(paths.beside_the_way)
