"""What compiling a function leaves alone and what it switches off meanwhile."""

import gc
from typing import NamedTuple

import numpy as np
import pytest
from numba import njit
from numba.core.base import BaseContext
from numba.core.codegen import JITCodeLibrary
from numba.core.errors import TypingError
from numba.core.types.functions import BaseFunction
from numba.extending import overload

from facegear.machine_code.compiler import by_type, compiler, for_callers
from facegear.machine_code.kept import VARIABLE


@pytest.fixture
def made(tmp_path, monkeypatch):
    """Names of what is made machine code from here on, none of which is stored."""
    monkeypatch.setenv(VARIABLE, str(tmp_path))
    finalize, names = JITCodeLibrary._finalize_final_module, []

    def counted(library):
        names.append(library.name)
        finalize(library)

    monkeypatch.setattr(JITCodeLibrary, "_finalize_final_module", counted)
    return names


@pytest.mark.parametrize("as_written", [True, False])
@pytest.mark.parametrize("compiles", [True, False])
def test_no_garbage_is_collected_while_a_function_is_compiled_and_then_it_is_again(
    tmp_path, monkeypatch, as_written, compiles
):
    monkeypatch.setenv(VARIABLE, str(tmp_path))
    collects = []

    def probe(value):
        return value

    def looked_at(value):
        collects.append(gc.isenabled())
        return (lambda value: value) if compiles else None

    overload(probe, strict=False)(looked_at)
    function = compiler(as_written=as_written)(lambda value: probe(value))
    if compiles:
        assert function(2.0) == 2.0
    else:
        with pytest.raises(TypingError):
            function(2.0)
    assert collects and not any(collects)
    assert gc.isenabled()


def test_a_part_is_compiled_once_for_all_constants_of_a_type_that_callers_hand_over(tmp_path, monkeypatch):
    monkeypatch.setenv(VARIABLE, str(tmp_path))
    part = for_callers()(lambda value, power, negative: (-1.0 if negative else 1.0) * value**power)
    function = compiler()(lambda x: part(x, 2, True) + part(x, 3, False) + part(x, int(x), x > 0.0))
    assert function(2.0) == -4.0 + 8.0 - 4.0
    assert len(part.overloads) == 1


def test_a_function_of_numbas_own_finds_what_the_parts_that_it_calls_call_themselves(tmp_path, monkeypatch):
    monkeypatch.setenv(VARIABLE, str(tmp_path))
    inner = for_callers(forceinline=False)(lambda value: value + 1.0)
    outer = for_callers(forceinline=False)(lambda value: 2.0 * inner(value))

    def given(value):
        return value

    overload(given, strict=False)(lambda value: lambda value: outer(value))
    function = compiler()(lambda value: given(value) + inner(value))
    assert function(3.0) == 12.0


def test_a_part_is_there_though_the_first_that_might_call_it_never_does(tmp_path, monkeypatch):
    monkeypatch.setenv(VARIABLE, str(tmp_path))
    inner = for_callers(forceinline=False)(lambda value: value + 1.0)
    never = for_callers(forceinline=False, fastmath={"contract"})(
        lambda value: inner(value) if len((value,)) > 1 else value
    )
    outer = for_callers(forceinline=False)(lambda value: 2.0 * inner(value))
    function = compiler()(lambda value: never(value) + outer(value))
    assert function(3.0) == 11.0


@pytest.mark.parametrize("compiles", [True, False])
def test_numba_has_its_own_methods_back_when_a_function_is_compiled_or_cannot_be(
    tmp_path, monkeypatch, compiles
):
    monkeypatch.setenv(VARIABLE, str(tmp_path))
    own = BaseFunction.get_call_type, BaseContext.get_function, BaseContext.get_abi_sizeof
    meanwhile = []

    def probe(value):
        return value

    def looked_at(value):
        meanwhile.append((BaseFunction.get_call_type, BaseContext.get_function, BaseContext.get_abi_sizeof))
        return (lambda value: value) if compiles else None

    overload(probe, strict=False)(looked_at)
    function = compiler()(lambda value: probe(value))
    if compiles:
        assert function(2.0) == 2.0
    else:
        with pytest.raises(TypingError):
            function(2.0)
    assert all(method is not old for method, old in zip(meanwhile[0], own, strict=True))
    assert (BaseFunction.get_call_type, BaseContext.get_function, BaseContext.get_abi_sizeof) == own


def test_what_is_remembered_of_a_call_holds_for_the_options_of_its_caller_alone(tmp_path, monkeypatch):
    monkeypatch.setenv(VARIABLE, str(tmp_path))

    def inverse(value):
        return 1.0 / value

    overload(inverse, strict=False)(lambda value: lambda value: 1.0 / value)
    silent = for_callers(error_model="numpy")(lambda value: inverse(value))
    strict = for_callers(error_model="python")(lambda value: inverse(value))
    function = compiler()(lambda first, second: silent(first) + strict(second) + silent(first))
    assert function(0.0, 1.0) == np.inf
    with pytest.raises(ZeroDivisionError):
        function(1.0, 0.0)


def test_functions_within_functions_and_array_expressions_are_compiled_as_ever(tmp_path, monkeypatch):
    monkeypatch.setenv(VARIABLE, str(tmp_path))

    def squares(values):
        return sum([value * value for value in values])

    function = compiler()(squares)
    assert function(np.arange(4.0)) == 14.0
    combined = compiler()(lambda first, second: first + 2.0 * second)
    assert combined(np.arange(3.0), np.ones(3)).tolist() == [2.0, 3.0, 4.0]


class Halved(NamedTuple):
    value: float


def test_what_is_chosen_by_type_is_machine_code_in_its_callers_alone(made):
    @by_type()
    def changed(first, factor):
        """What is made of a value."""

    @changed.of(Halved)
    def halved(first, factor):
        return factor * first.value / 2.0

    function = compiler()(lambda first: changed(first, 3.0))
    assert function(Halved(4.0)) == 6.0
    assert not any("halved" in name for name in made) and made


def test_functions_of_numbas_own_are_machine_code_in_their_callers_alone(made):
    def more(value):
        return value

    overload(more, strict=False)(lambda value: lambda value: max(value, 1.0) + len(np.zeros(3)))
    function = compiler()(lambda value: more(value))
    assert function(0.5) == 4.0 and function(2.0) == 5.0
    assert made and not any("more" in name or "max" in name or "zeros" in name for name in made)
    assert njit(lambda value: more(value) * max(value, 1.0))(2.0) == 10.0
