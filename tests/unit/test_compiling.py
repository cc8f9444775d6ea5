"""What compiling a function leaves alone and what it switches off meanwhile."""

import gc

import pytest
from numba.core.errors import TypingError
from numba.extending import overload

from facegear.machine_code.compiler import compiler, for_callers
from facegear.machine_code.kept import VARIABLE


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
