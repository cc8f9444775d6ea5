"""Stored machine code: used again while all kernels are the same, never after one of them changed."""

import os
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numba
import numpy as np
import pytest
from force_tables import power_table
from forked_python import run_together
from lumped_machines import PLACES
from oscillators import backlash_oscillator
from references import against, agrees

from facegear.dynamics.integrator.compiled import pack
from facegear.dynamics.integrator.integrator import Integrator
from facegear.dynamics.steady_state.prepare import _smallest
from facegear.dynamics.steady_state.simulate import build_model
from facegear.machine_code import kept, shipped
from facegear.machine_code.compiler import compiler, for_callers
from facegear.machine_code.versions import KNOWN, is_known
from facegear.mesh_law.terms import held_force
from facegear.transmission.layout import Side
from facegear.transmission.machine import FlankTables
from facegear.transmission.mesh_friction import PARTS, MeshFriction
from facegear.transmission.static_springs import static_springs
from facegear.transmission.teeth import GEOMETRIC

CALLED = (
    "from own import inlined, kernel\n\n"
    "@inlined\ndef within(x):\n    return x + {added}\n\n"
    "@kernel\ndef called(x):\n    return within(x)\n"
)
FILES = {
    "own.py": (
        "from pathlib import Path\nfrom facegear.machine_code.compiler import compiler, for_callers\n"
        "kernel = compiler(Path(__file__).parent)\ninlined = for_callers()\n"
    ),
    "called.py": CALLED.format(added=1.0),
    "caller.py": (
        "from own import kernel\nfrom called import called\n\n"
        "@kernel\ndef caller(x):\n    return 2.0 * called(x)\n"
    ),
}
PRINT = "from caller import caller; print(caller({of}), sum(caller.stats.cache_hits.values()))"


def environment(tmp_path, sources):
    """Of a process that finds the kernels' sources in a folder, with a cache of the test's own."""
    path = os.pathsep.join([str(sources), *sys.path])
    return {"PYTHONPATH": path, kept.VARIABLE: str(tmp_path / "cache")}


def printed(tmp_path, sources, of="1.0"):
    """The kernel's value, and how many kernels were not compiled."""
    (words,) = printed_together(tmp_path, sources, of)
    return words


def printed_anew(tmp_path, sources, before=""):
    """The same of a process that imports numba itself, for the processor that it names; `before` first."""
    done = subprocess.run(
        [sys.executable, "-c", before + PRINT.format(of="1.0")],
        env={**os.environ, **environment(tmp_path, sources)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.split()


@pytest.fixture
def clone(tmp_path):
    """Makes a folder with the kernels' sources."""

    def make(name):
        folder = tmp_path / name
        folder.mkdir()
        for file, text in FILES.items():
            (folder / file).write_text(text)
        return folder

    return make


def test_a_second_clone_compiles_nothing_until_a_kernel_that_is_called_in_another_file_changes(
    tmp_path, clone
):
    first, second = clone("first"), clone("second")
    assert printed(tmp_path, first) == ["4.0", "0"]
    assert printed(tmp_path, second) == ["4.0", "1"]
    (second / "called.py").write_text(CALLED.format(added=2.0))
    assert printed(tmp_path, second) == ["6.0", "0"]
    assert printed(tmp_path, first) == ["4.0", "1"]


def test_damaged_machine_code_is_compiled_again(tmp_path, clone):
    folder = clone("one")
    printed(tmp_path, folder)
    for path in (tmp_path / "cache" / "machine_code").iterdir():
        path.write_bytes(path.read_bytes()[:-1] + b"?")
    assert printed(tmp_path, folder) == ["4.0", "0"]
    assert printed(tmp_path, folder) == ["4.0", "1"]


def test_kernels_run_where_no_cache_can_be_written(tmp_path, clone):
    folder = clone("one")
    (tmp_path / "cache").write_text("a file where the folder should be")
    assert printed(tmp_path, folder) == printed(tmp_path, folder) == ["4.0", "0"]


def test_where_nothing_is_to_be_compiled_what_is_stored_is_loaded_and_what_is_not_is_refused(tmp_path, clone):
    """Else the process that jobs are copies of would compile for a minute while they wait for it."""
    code = (
        "from caller import caller\nfrom facegear.machine_code.compiler import nothing_compiled\n"
        "try:\n    with nothing_compiled():\n        print(caller(1.0))\n"
        "except LookupError as error:\n    print(type(error).__name__)\n    print(caller(1.0))"
    )
    known = environment(tmp_path, clone("one"))
    first, second = (run_together([code], known)[0].stdout.split() for _ in range(2))
    assert first == ["NotStored", "4.0"] and second == ["4.0"]


def test_code_of_a_release_is_run_from_an_empty_cache_and_compiled_where_it_is_damaged(
    tmp_path, clone, monkeypatch
):
    if not shipped.can_run(shipped.INSTRUCTIONS):
        pytest.skip("this processor cannot run what a release holds")
    folder, archive, cache = clone("release"), tmp_path / shipped.ARCHIVE, tmp_path / "cache"
    with monkeypatch.context() as other_computer:
        for name, value in shipped.COMPILING.items():
            other_computer.setenv(name, value)
        assert printed_anew(tmp_path, folder) == ["4.0", "0"]
    shipped.write(archive, cache / "machine_code")
    shutil.rmtree(cache)
    lies_there = (
        "from pathlib import Path; from facegear.machine_code import shipped; "
        f"shipped.archive = lambda: Path({str(archive)!r}); "
    )
    assert printed_anew(tmp_path, folder, lies_there) == ["4.0", "1"]
    assert not cache.exists()
    whole = archive.read_bytes()
    archive.write_bytes(whole[:100] + bytes(len(whole) // 2) + whole[100 + len(whole) // 2 :])
    assert printed_anew(tmp_path, folder, lies_there) == ["4.0", "0"]


def test_code_of_a_release_is_left_alone_where_the_processor_lacks_an_instruction_or_numba_is_to_use_others(
    monkeypatch,
):
    assert not shipped.can_run(("an instruction of tomorrow",))
    monkeypatch.setattr(numba.config, "CPU_NAME", "generic")
    assert not shipped.can_run(())


def test_machine_code_used_least_lately_is_removed_first(tmp_path, monkeypatch):
    monkeypatch.setenv(kept.VARIABLE, str(tmp_path))
    for age, name in enumerate("abc"):
        kept.write(name, b"x" * 1000)
        os.utime(tmp_path / "machine_code" / name, (1000.0 + age, 1000.0 + age))
    assert kept.read("a") == b"x" * 1000
    kept.trim(2500)
    assert [kept.read(name) is None for name in "abc"] == [False, True, False]


def test_a_function_for_compiled_callers_says_so_when_python_calls_it():
    def twice(x):
        return 2.0 * x

    with pytest.raises(TypeError, match=r"twice is only for compiled callers"):
        for_callers()(twice)(1.0)


def test_what_compiled_callers_call_is_compiled_to_machine_code_only_where_python_calls_it_too(
    tmp_path, monkeypatch
):
    monkeypatch.setenv(kept.VARIABLE, str(tmp_path))
    kernel = compiler()
    called = kernel(lambda x: x + 1.0)
    caller = kernel(lambda x: 2.0 * called(x))
    assert caller(1.0) == 4.0
    assert not called.signatures
    assert called(1.0) == 2.0
    assert called.signatures == caller.signatures


def test_a_law_without_an_implementation_is_named_in_one_line_with_the_function_that_misses_it():
    class Rubber(NamedTuple):
        size: float

    with pytest.raises(TypeError, match=r"^held_force has no implementation for \S*Rubber$"):
        held_force(Rubber(1.0), 0, 0, 1e-6)


def printed_together(tmp_path, sources, *arguments):
    """What processes print that start together, each with an argument of its own."""
    programs = [PRINT.format(of=argument) for argument in arguments]
    ended = run_together(programs, environment(tmp_path, sources))
    assert not any(one.returncode for one in ended), [one.stderr for one in ended]
    return [one.stdout.split() for one in ended]


def test_of_two_processes_that_start_together_one_compiles(tmp_path, clone):
    assert sorted(printed_together(tmp_path, clone("one"), "1.0", "1.0")) == [["4.0", "0"], ["4.0", "1"]]


def test_what_processes_compile_at_once_for_different_types_is_kept_of_each(tmp_path, clone):
    folder, arguments = clone("one"), ("1.0", "1", "1j")
    assert printed_together(tmp_path, folder, *arguments) == [["4.0", "0"], ["4.0", "0"], ["(2+2j)", "0"]]
    assert printed_together(tmp_path, folder, *arguments) == [["4.0", "1"], ["4.0", "1"], ["(2+2j)", "1"]]


def test_machines_of_any_size_run_the_machine_code_that_was_prepared_for_the_smallest(machine_of, layout_of):
    """Friction on several flanks, and gears in bearings, had their kernels compiled a second time; before a
    machine with the load-dependent law ran, the kernels of the other law were compiled.
    """
    machine = machine_of(layout_of(kinematics=GEOMETRIC))
    small = machine_of(layout_of(PLACES[2:3], (Side.UPPER,), gear_bearing=0.0), tail_share=0.0)
    assert numba.typeof(static_springs(machine)) == numba.typeof(static_springs(small))
    rubs = replace(
        machine, friction=MeshFriction(np.tile([[0.0, 0.02], [0.02, 0.02]], (10, len(PARTS), 1, 1)))
    )
    tabled = replace(machine, tables=2 * (FlankTables(power_table(7, 0.2), power_table(7)),))
    for one, kind in ((machine, (False,)), (rubs, (True,)), (tabled, (False, True))):
        packed = (pack(system, 1.0) for system in (build_model(one).system, _smallest(False, *kind)))
        assert len({numba.typeof(arrays) for arrays in packed}) == 1


def test_importing_the_kernels_leaves_numba_as_it_was():
    code = (
        "import numba; before = numba.config.CACHE_DIR; import facegear.dynamics.integrator.advance; "
        "assert numba.config.CACHE_DIR == before"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_numba_is_one_of_the_versions_whose_private_parts_are_known():
    """Another version runs as well, but slowly: try it with this suite before it is added."""
    assert is_known(numba.__version__), KNOWN
    assert KNOWN == ("0.68",)
    assert [is_known(version) for version in ("0.68.0", "0.68.12", "0.69.0", "0.6", "1.68.1")] == [
        *(True, True),
        *(False, False, False),
    ]


MOTION = """
import sys
import numpy as np
from oscillators import backlash_oscillator
from facegear.dynamics.integrator.compiled import pack
from facegear.dynamics.integrator.integrator import Integrator
from facegear.dynamics.steady_state.prepare import _smallest
from facegear.dynamics.steady_state.simulate import build_model
from facegear.machine_code import versions
assert not versions.NUMBA_IS_KNOWN
run = Integrator(backlash_oscillator(0.75), 0.75, 1e-4).run(np.array([[0.9], [0.2]]), 1, np.ones((1, 2, 1)))
print(*run.state.ravel().tolist(), *run.tangents.ravel().tolist(), run.steps)
"""


@against(
    "second implementation",
    "the same functions run by Python itself",
    capability="machine_code dynamics_response",
    module="facegear.dynamics.integrator.integrator",
)
def test_without_numbas_private_parts_the_motion_is_the_same():
    """The plain functions are run by Python itself here: compiling them takes minutes."""
    folder = Path(__file__).parents[2] / "helpers"
    path = os.pathsep.join([str(folder), *sys.path])
    environment = {**os.environ, "PYTHONPATH": path, "NUMBA_DISABLE_JIT": "1"}
    done = subprocess.run(
        [sys.executable, "-c", MOTION], env=environment, capture_output=True, text=True, check=False
    )
    agrees("motion, tangents and steps", done.returncode, 0)
    integrator = Integrator(backlash_oscillator(0.75), 0.75, 1e-4)
    run = integrator.run(np.array([[0.9], [0.2]]), 1, np.ones((1, 2, 1)))
    expected = [*run.state.ravel(), *run.tangents.ravel(), run.steps]
    assert 0.0 < run.fractions[0, 0] < 1.0
    np.testing.assert_allclose(np.array(done.stdout.split(), float), expected, rtol=1e-11)
