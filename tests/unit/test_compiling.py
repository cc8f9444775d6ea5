"""What compiling a function leaves alone and what it switches off meanwhile."""

import gc

import pytest
from numba.core.errors import TypingError
from numba.extending import overload

from facegear.machine_code.compiler import compiler
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
