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
MEMORY = 8 << 30
"""Bytes of address space: a wrong size ends in an exception before it takes the machine's memory."""
COUNTS = ("periods",)
"""Arguments that say how much is to be done: large ones are answered late, not wrongly."""
INTEGERS = (-(2**63), -1000, -1, 0, 1, 2, 7, 2**31, 2**40)
NUMBERS = (float("nan"), float("inf"), -float("inf"), 0.0, -1.0, 1e300, 5e-324)


def kernels() -> dict[str, tuple[ModuleType | type, str]]:
    """Return what is called: functions, classes with a constructor and methods, by full name.

    The value is the module or class that holds it, and its name there: `contact.PositionSolver.solve` is
    the method `solve` of the class `PositionSolver`.
    """
    found = {name: part for name, part in vars(_kernels).items() if isinstance(part, ModuleType)}
    parts = {name: part for name, part in found.items() if not name.startswith("_")}
    called: dict[str, tuple[ModuleType | type, str]] = {}
    for part_name, part in parts.items():
        for name, value in vars(part).items():
            constructor = vars(value).get("__init__") if isinstance(value, type) else None
            if type(value).__name__ == "nb_func" or type(constructor).__name__ == "nb_method":
                called[f"{part_name}.{name}"] = part, name
            if isinstance(value, type):
                methods = [key for key, method in vars(value).items() if type(method).__name__ == "nb_method"]
                for method in methods:
                    if not method.startswith("__"):
                        called[f"{part_name}.{name}.{method}"] = value, method
    return called


def record(tests: list[str]) -> dict[str, list[Call]]:
    """Run tests and return the arguments that each kernel answered, copied before the call."""
    calls: dict[str, list[Call]] = defaultdict(list)
    found = kernels()
    originals = {full: getattr(owner, name) for full, (owner, name) in found.items()}
    for full, (owner, name) in found.items():
        setattr(owner, name, _recorder(originals[full], calls[full]))
    if pytest.main(["-q", "-n", "0", "-p", "no:cacheprovider", *tests]):
        raise SystemExit("The tests whose calls are to be changed do not pass")
    for full, (owner, name) in found.items():
        setattr(owner, name, originals[full])
    return calls


def _recorder(kernel: Callable[..., object], calls: list[Call]) -> Callable[..., object]:
    def call(*positional: object, **named: object) -> object:
        made = tuple(map(_copied, positional)), {key: _copied(one) for key, one in named.items()}
        answer = kernel(*positional, **named)
        if len(calls) < CALLS_KEPT:
            calls.append(made)
        return answer

    return call


def _copied(value: object) -> object:
    """Return a copy of arrays and plain objects; objects of the kernels are handed on, they never change."""
    if isinstance(value, np.ndarray):
        return value.copy()
    if isinstance(value, list):
        return list(value)
    return value


def changed_call(call: Call, chance: random.Random) -> tuple[Call, str]:
    """Return a call with one to three of its arguments changed, and what was changed."""
    positional, named = list(map(_copied, call[0])), {key: _copied(one) for key, one in call[1].items()}
    places: list[int | str] = [*range(len(positional)), *named]
    told = []
    for place in chance.sample(places, min(len(places), chance.choice((1, 1, 1, 2, 3)))):
        value = positional[place] if isinstance(place, int) else named[place]
        value, what = changed(value, chance)
        if place in COUNTS and isinstance(value, np.ndarray) and value.dtype.kind in "iu":
            value = np.minimum(value, 3)
        told.append(f"{place}: {what}")
        if isinstance(place, int):
            positional[place] = value
        else:
            named[place] = value
    return (tuple(positional), named), ", ".join(told)


def changed(value: object, chance: random.Random) -> tuple[object, str]:
    """Return a value in place of an argument, and what it is."""
    if chance.random() < 0.04:
        value = chance.choice((None, "text", [], object(), -1, np.zeros(0)))
        return value, f"a {type(value).__name__}"
    if isinstance(value, np.ndarray):
        return _changed_array(value, chance)
    if isinstance(value, bool):
        return not value, "the opposite"
    if isinstance(value, int):
        return (number := chance.choice(INTEGERS)), str(number)
    if isinstance(value, float):
        return (number := chance.choice(NUMBERS)), str(number)
    if isinstance(value, list | tuple):
        return value[: chance.randrange(len(value) + 1)], "shorter"
    fields = [name for name in dir(value) if not name.startswith("_") and not callable(getattr(value, name))]
    if fields and not type(value).__module__.startswith("facegear._kernels"):
        return _changed_object(value, fields, chance)
    return None, "None"


def _changed_object(value: object, fields: list[str], chance: random.Random) -> tuple[object, str]:
    """Return an object of the same attributes, of which one is changed or missing."""
    parts = {name: _copied(getattr(value, name)) for name in fields}
    name = chance.choice(fields)
    if chance.random() < 0.1:
        del parts[name]
        return SimpleNamespace(**parts), f"without {name}"
    parts[name], what = changed(parts[name], chance)
    return SimpleNamespace(**parts), f"{name}: {what}"


def _changed_array(array: np.ndarray, chance: random.Random) -> tuple[object, str]:
    """Return an array of other shape, type, strides or content."""
    kind = chance.choice(
        ("shape", "shape", "axis", "type", "strides", "empty", "content", "content", "readonly")
    )
    if kind == "shape" and array.ndim:
        axis = chance.randrange(array.ndim)
        length = array.shape[axis]
        kept = chance.choice((max(length - 1, 0), length + 1, 1, 2 * length))
        return np.take(
            array, np.arange(kept) % max(length, 1), axis=axis, mode="clip"
        ) if length else array, (f"{kept} along axis {axis}")
    if kind == "axis":
        return (array[None] if chance.random() < 0.5 else array.ravel()[: chance.randrange(3)]), "other axes"
    if kind == "type":
        kind = chance.choice(
            (np.float32, np.int32, np.int64, np.float64, np.complex128, np.uint8, object, bool)
        )
        with np.errstate(all="ignore"):
            return array.astype(kind), kind.__name__
    if kind == "strides":
        return np.repeat(array, 2, axis=-1)[..., ::2] if array.ndim else array, "every second"
    if kind == "empty":
        return np.zeros([0] * array.ndim, array.dtype), "empty"
    if kind == "content" and array.size:
        several = [chance.randrange(array.size) for _ in range(chance.choice((1, 1, 4, array.size)))]
        choices = NUMBERS if array.dtype.kind == "f" else (-1, 0, 1, 100, 127)
        if array.dtype.kind == "i" and array.dtype.itemsize == 8:
            choices = INTEGERS
        for place in several:
            array.flat[place] = chance.choice(choices)
        return array, "other numbers"
    array.flags.writeable = False
    return array, "read only"


def fuzz(calls: dict[str, list[Call]], number: int, seed: int, log: Path) -> dict[str, dict[str, int]]:
    """Make a number of changed calls of each kernel; return how many answered and how many raised."""
    counts: dict[str, dict[str, int]] = {}
    for full, (owner, name) in sorted(kernels().items()):
        counts[full] = {"recorded": len(calls.get(full, ())), "answered": 0, "raised": 0}
        chance = random.Random(f"{seed} {full}")
        for _ in range(number if calls.get(full) else 0):
            (positional, named), told = changed_call(chance.choice(calls[full]), chance)
            log.write_text(f"{full} with {told}\n")
            faulthandler.dump_traceback_later(SLOWEST, exit=True)
            try:
                getattr(owner, name)(*positional, **named)
            except Exception:
                counts[full]["raised"] += 1
            else:
                counts[full]["answered"] += 1
            faulthandler.cancel_dump_traceback_later()
    return counts


def main(arguments: list[str]) -> int:
    """Record, then fuzz; print the counts of each kernel as JSON."""
    number, seed, log, *tests = arguments
    faulthandler.enable()
    calls = record(tests)
    if "libasan" not in Path("/proc/self/maps").read_text():  # which reserves terabytes of addresses
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    print(json.dumps(fuzz(calls, int(number), int(seed), Path(log))))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
