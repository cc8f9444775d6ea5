"""Call each kernel with arguments that do not fit: an exception is an answer, a crash is not.

`python -m validation.kernels_fuzz CALLS SEED LOG TESTS` runs tests, records the arguments with which they
call the kernels, and repeats each call with a part of them changed: other shapes, types and strides, numbers
that are none, empty arrays, integers out of range, objects without an attribute. Each call is named in the
file LOG before it is made, so that a crash says what caused it.
"""

import faulthandler
import json
import random
import resource
import signal
import sys
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path
from types import ModuleType, SimpleNamespace

import numpy as np
import pytest

from facegear import _kernels

Call = tuple[tuple[object, ...], dict[str, object]]
CALLS_KEPT = 12
"""Calls of one kernel that are kept; more of them are much alike."""
SLOWEST = 120
"""Seconds after which a call is taken as one that never ends; a kernel of these tests takes milliseconds."""
STOPPED_AFTER = 2.0
"""Processor time of a call, s, after which a signal ends it as Ctrl-C does. Motion from wild starts takes
millions of steps, a minute under the sanitizers.
The other kernels look at no signal, and take milliseconds."""
MEMORY = 8 << 30
"""Bytes of address space: a wrong size ends in an exception before it takes the machine's memory."""
COUNTS = ("periods",)
"""Arguments that say how much is to be done: large ones are answered late, not wrongly."""
WATCHED_ARGUMENTS = "libasan" in Path("/proc/self/maps").read_text() if sys.platform == "linux" else False
"""AddressSanitizer ends the process where memory cannot be had, and reserves terabytes of addresses."""
INTEGERS = (-(2**63), -1000, -1, 0, 1, 2, 7, *(() if WATCHED_ARGUMENTS else (2**31, 2**40)))
NUMBERS = (float("nan"), float("inf"), -float("inf"), 0.0, -1.0, 1e300, 5e-324)


def kernels() -> dict[str, tuple[ModuleType | type, str]]:
    """List what is called: functions, classes with a constructor, and methods.

    Returns
    -------
    dict
        By full name the module or class that holds it, and its name there:
        `_kernels.contact.PositionSolver.solve` is the method `solve` of the class `PositionSolver`.
    """
    modules = {name: part for name, part in vars(_kernels).items() if isinstance(part, ModuleType)}
    parts = {name: part for name, part in modules.items() if not name.startswith("_")}
    by_name: dict[str, tuple[ModuleType | type, str]] = {}
    for part_name, part in parts.items():
        for name, value in vars(part).items():
            constructor = vars(value).get("__init__") if isinstance(value, type) else None
            if type(value).__name__ == "nb_func" or type(constructor).__name__ == "nb_method":
                by_name[f"{part_name}.{name}"] = part, name
            if isinstance(value, type):
                methods = [key for key, method in vars(value).items() if type(method).__name__ == "nb_method"]
                for method in methods:
                    if not method.startswith("__"):
                        by_name[f"{part_name}.{name}.{method}"] = value, method
    return by_name


def record(tests: list[str]) -> dict[str, list[Call]]:
    """Run tests and keep the arguments that each kernel answered, copied before the call.

    Parameters
    ----------
    tests : list of str
        What pytest runs.

    Returns
    -------
    dict
        Calls of each kernel by its full name.
    """
    calls: dict[str, list[Call]] = defaultdict(list)
    modules = kernels()
    originals = {full: getattr(owner, name) for full, (owner, name) in modules.items()}
    for full, (owner, name) in modules.items():
        setattr(owner, name, _recorder(originals[full], calls[full]))
    if pytest.main(["-q", "-n", "0", "-p", "no:cacheprovider", *tests]):
        raise SystemExit("The tests whose calls are to be changed do not pass")
    for full, (owner, name) in modules.items():
        setattr(owner, name, originals[full])
    return calls


def _recorder(kernel: Callable[..., object], calls: list[Call]) -> Callable[..., object]:
    def call(*positional: object, **keywords: object) -> object:
        copies = (
            tuple(map(copy_argument, positional)),
            {key: copy_argument(value) for key, value in keywords.items()},
        )
        answer = kernel(*positional, **keywords)
        if len(calls) < CALLS_KEPT:
            calls.append(copies)
        return answer

    return call


def copy_argument(value: object) -> object:
    """Copy arrays and lists; objects of the kernels are handed on, as they never change.

    Parameters
    ----------
    value : object
        An argument.

    Returns
    -------
    object
        Its copy.
    """
    if isinstance(value, np.ndarray):
        return value.copy()
    if isinstance(value, list):
        return list(value)
    return value


def change_call(call: Call, chance: random.Random) -> tuple[Call, str]:
    """Change one to three arguments of a call.

    Parameters
    ----------
    call : tuple
        Positional arguments and keywords.
    chance : random.Random
        Source of the changes.

    Returns
    -------
    tuple
        The changed call, and a text that names the changes.
    """
    positional, keywords = (
        list(map(copy_argument, call[0])),
        {key: copy_argument(value) for key, value in call[1].items()},
    )
    names: list[int | str] = [*range(len(positional)), *keywords]
    descriptions = []
    for argument in chance.sample(names, min(len(names), chance.choice((1, 1, 1, 2, 3)))):
        value = positional[argument] if isinstance(argument, int) else keywords[argument]
        value, description = change_argument(value, chance)
        if argument in COUNTS and isinstance(value, np.ndarray) and value.dtype.kind in "iu":
            value = np.minimum(value, 3)
        descriptions.append(f"{argument}: {description}")
        if isinstance(argument, int):
            positional[argument] = value
        else:
            keywords[argument] = value
    return (tuple(positional), keywords), ", ".join(descriptions)


def change_argument(value: object, chance: random.Random) -> tuple[object, str]:
    """Choose a value in place of an argument.

    Parameters
    ----------
    value : object
        The argument.
    chance : random.Random
        Source of the change.

    Returns
    -------
    tuple
        The new value, and a text that says what it is.
    """
    if chance.random() < 0.04:
        value = chance.choice((None, "text", [], object(), -1, np.zeros(0)))
        return value, f"a {type(value).__name__}"
    if isinstance(value, np.ndarray):
        return _changed_array(value, chance)
    if isinstance(value, bool):
        return not value, "the opposite"
    if isinstance(value, int):
        integer = chance.choice(INTEGERS)
        return integer, str(integer)
    if isinstance(value, float):
        number = chance.choice(NUMBERS)
        return number, str(number)
    if isinstance(value, list | tuple):
        return value[: chance.randrange(len(value) + 1)], "shorter"
    fields = [name for name in dir(value) if not name.startswith("_") and not callable(getattr(value, name))]
    if fields and not type(value).__module__.startswith("facegear._kernels"):
        return _changed_object(value, fields, chance)
    return None, "None"


def _changed_object(value: object, fields: list[str], chance: random.Random) -> tuple[object, str]:
    """Return an object of the same attributes, of which one is changed or missing."""
    parts = {name: copy_argument(getattr(value, name)) for name in fields}
    name = chance.choice(fields)
    if chance.random() < 0.1:
        del parts[name]
        return SimpleNamespace(**parts), f"without {name}"
    parts[name], description = change_argument(parts[name], chance)
    return SimpleNamespace(**parts), f"{name}: {description}"


def _changed_array(array: np.ndarray, chance: random.Random) -> tuple[object, str]:
    """Return an array of other shape, type, strides or content."""
    kind = chance.choice(
        ("shape", "shape", "axis", "type", "strides", "empty", "content", "content", "readonly")
    )
    if kind == "shape" and array.ndim:
        axis = chance.randrange(array.ndim)
        length = array.shape[axis]
        length_wanted = chance.choice((max(length - 1, 0), length + 1, 1, 2 * length))
        return np.take(
            array, np.arange(length_wanted) % max(length, 1), axis=axis, mode="clip"
        ) if length else array, (f"{length_wanted} along axis {axis}")
    if kind == "axis":
        return (array[None] if chance.random() < 0.5 else array.ravel()[: chance.randrange(3)]), "other axes"
    if kind == "type":
        dtype = np.dtype(chance.choice(["f4", "i4", "i8", "f8", "c16", "u1", "O", "?"]))
        with np.errstate(all="ignore"):
            return array.astype(dtype), dtype.name
    if kind == "strides":
        return np.repeat(array, 2, axis=-1)[..., ::2] if array.ndim else array, "every second"
    if kind == "empty":
        return np.zeros([0] * array.ndim, array.dtype), "empty"
    if kind == "content" and array.size:
        positions = [chance.randrange(array.size) for _ in range(chance.choice((1, 1, 4, array.size)))]
        choices: tuple[float, ...] = NUMBERS if array.dtype.kind == "f" else (-1, 0, 1, 100, 127)
        if array.dtype.kind == "i" and array.dtype.itemsize == 8:
            choices = INTEGERS
        for position in positions:
            array.flat[position] = chance.choice(choices)
        return array, "other numbers"
    array.flags.writeable = False
    return array, "read only"


def fuzz(calls: dict[str, list[Call]], number: int, seed: int, log: Path) -> dict[str, dict[str, int]]:
    """Make changed calls of each kernel.

    Parameters
    ----------
    calls : dict
        Recorded calls by the full name of the kernel.
    number : int
        Changed calls of each kernel.
    seed : int
        Seed of the changes.
    log : Path
        File that names each call before it is made.

    Returns
    -------
    dict
        By full name how many calls were recorded, answered, raised and stopped.
    """
    signal.signal(signal.SIGPROF, _stop)
    counts: dict[str, dict[str, int]] = {}
    for full, (owner, name) in sorted(kernels().items()):
        counts[full] = {"recorded": len(calls.get(full, ())), "answered": 0, "raised": 0, "stopped": 0}
        chance = random.Random(f"{seed} {full}")
        for _ in range(number if calls.get(full) else 0):
            (positional, keywords), descriptions = change_call(chance.choice(calls[full]), chance)
            log.write_text(f"{full} with {descriptions}\n")
            faulthandler.dump_traceback_later(SLOWEST, exit=True)
            try:
                signal.setitimer(signal.ITIMER_PROF, STOPPED_AFTER)
                getattr(owner, name)(*positional, **keywords)
                signal.setitimer(signal.ITIMER_PROF, 0.0)
            except TimeoutError:
                counts[full]["stopped"] += 1
            except Exception:
                counts[full]["raised"] += 1
            else:
                counts[full]["answered"] += 1
            signal.setitimer(signal.ITIMER_PROF, 0.0)
            faulthandler.cancel_dump_traceback_later()
    return counts


def _stop(number: int, frame: object) -> None:
    raise TimeoutError


def main(arguments: list[str]) -> int:
    """Record calls, then change them; print the counts of each kernel as JSON.

    Parameters
    ----------
    arguments : list of str
        Number of changed calls, seed, log file and tests.

    Returns
    -------
    int
        Exit code.
    """
    number, seed, log, *tests = arguments
    faulthandler.enable()
    calls = record(tests)
    if not WATCHED_ARGUMENTS:
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    print(json.dumps(fuzz(calls, int(number), int(seed), Path(log))))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
