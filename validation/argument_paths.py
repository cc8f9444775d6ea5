"""Functions that a machine and its backlash pass on the way to the compiled loop of the motion.

`python -m validation.argument_paths` loads the example machine, calls the stage `dynamics_response` as the
pipeline does, and watches every call with `sys.setprofile` until `run_machines`, the function that makes the
compiled call of the integration. Functions are those of facegear; a lambda, comprehension or inner function
counts as the function around it.

Transmission. A function is passed if one of its arguments is the section `transmission`, the machine that is
built of it, or an object that holds one of them (a dataclass such as `Model`, a tuple, a list or a mapping).
Attributes that the machine or the section computes from itself (`machine.phases`) are listed, but not
counted: nothing is passed to them. The bound holds from the stage, which takes the machine, to the compiled
call. What happens before is counted by itself: functions that check the section when the config is loaded,
and functions that build the machine of it when the pipeline calls the stage.

Calls that go up. The packages stand in the order of `tests/unit/test_import_directions.py`. The caller is the
nearest function of facegear on the stack; `by_content`, whose functions wrap others, is no caller.

Half backlash. The config gets a backlash that occurs nowhere else, and the number is looked for. A function
handles it if the number itself (as a number, in an array, or in a tuple or mapping of such) is an argument, a
local variable or the result, or is given to an object that the function makes; and if the function names
`half_backlash` or `backlash_um` and is given an object that holds it. On the way to the kernel is a function
that hands the number on in its result, and the function that gives it to the compiled code; one that uses it
up is listed beside the way. Functions that hand on a whole config, or an object in which others have stored
the number, know nothing of it and are not counted. A home is a field `half_backlash` of a class in facegear.
"""

import ast
import importlib.util
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, fields, is_dataclass
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from types import CodeType, FrameType
from typing import Any

import numpy as np

import facegear
from facegear.machine.machine import Machine
from facegear.pipeline.run import call
from facegear.pipeline.table import STAGES
from facegear.schema.transmission import Transmission

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "facegear"
STAGE = "dynamics_response"
LAST = ("facegear.motion.integrator.integrator", "run_machines")
"""Module and name of the function that makes the compiled call of the integration."""
TO_KERNEL = ("facegear.motion.integrator.kernel_system", "packed_system")
"""Module and name of the function that gives the numbers of the motion to the compiled code."""
MOST_FUNCTIONS, MOST_FOR_BACKLASH = 25, 8
"""Bounds of issue 52."""
PHASE_WORDS = {
    "stage": f"from the stage to the compiled call (at most {MOST_FUNCTIONS})",
    "build": "from the section to the machine, as the pipeline calls the stage",
    "check": "checks of the config as it is loaded",
}
BACKLASH_UM = 123.456
"""Backlash of the example, in um: a number that nothing else has."""
NUMBERS = (BACKLASH_UM, 0.5e-6 * BACKLASH_UM)
"""The backlash as the config gives it, in um, and its half, in m."""
NAMES = {"half_backlash", "backlash_um"}
DEPTH = 5
"""Objects inside each other that are searched."""
WRAPPERS = ("facegear.by_content",)


@dataclass
class Visit:
    """A function that was passed.

    - module, name: of the function
    - arguments: names of the arguments in which the object was found
    - callers: module and name of each function that called it
    - is_attribute: whether the object computes an attribute of itself
    - phases: `check`, `build` and `stage`, as far as it was passed in them
    """

    module: str
    name: str
    is_attribute: bool
    phases: set[str] = field(default_factory=set)
    arguments: set[str] = field(default_factory=set)
    callers: set[tuple[str, str]] = field(default_factory=set)


@dataclass
class Handling:
    """A function that handled the number.

    - module, name: of the function
    - hands_on: whether the number was in what it returned or gave to the compiled call
    """

    module: str
    name: str
    hands_on: bool = False


@dataclass
class Paths:
    """Functions that were passed, in the order of their first calls, by module and name."""

    machine: dict[tuple[str, str], Visit] = field(default_factory=dict)
    backlash: dict[tuple[str, str], Handling] = field(default_factory=dict)

    def visits(self, phase: str) -> list[Visit]:
        """Return the functions that section and machine pass in a phase.

        Parameters
        ----------
        phase : str
            `check`, `build` or `stage`.

        Returns
        -------
        list of Visit
            In the order of their first calls, without attributes.
        """
        return [visit for visit in self.machine.values() if phase in visit.phases and not visit.is_attribute]

    @property
    def attributes(self) -> list[Visit]:
        """Functions by which the machine or its section computes an attribute of itself."""
        return [visit for visit in self.machine.values() if visit.is_attribute]

    @property
    def upward(self) -> list[tuple[str, str]]:
        """Caller and function of every call into a package above that of its caller, with their modules."""
        return [
            (".".join(caller), f"{visit.module}.{visit.name}")
            for visit in self.machine.values()
            for caller in sorted(visit.callers)
            if rank(visit.module) > rank(caller[0])
        ]

    @property
    def on_the_way(self) -> list[Handling]:
        """Functions that hand half the backlash on towards the kernel."""
        return [visit for visit in self.backlash.values() if visit.hands_on]

    @property
    def beside_the_way(self) -> list[Handling]:
        """Functions that use half the backlash and do not hand it on."""
        return [visit for visit in self.backlash.values() if not visit.hands_on]


@cache
def package_order() -> tuple[str, ...]:
    """Return the packages from the foundation up.

    Returns
    -------
    tuple of str
        Names below `facegear`, as the test of the import directions lists them.
    """
    path = ROOT / "tests" / "unit" / "test_import_directions.py"
    spec = importlib.util.spec_from_file_location("import_directions", path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return tuple(module.MAY_IMPORT)


def rank(module: str) -> int:
    """Return the place of a module's package in the order of packages.

    Parameters
    ----------
    module : str
        Dotted name.

    Returns
    -------
    int
        From 0 at the foundation; modules above all packages come last.
    """
    order, package = package_order(), module.split(".")[1]
    return order.index(package) if package in order else len(order)


@cache
def locate(code: CodeType) -> tuple[str, str] | None:
    """Return where a function stands.

    Parameters
    ----------
    code : CodeType
        Its code.

    Returns
    -------
    tuple of str, or None
        Module and name of the function, or of the one around it; None outside facegear.
    """
    path = Path(code.co_filename)
    if not path.is_relative_to(PACKAGE):
        return None
    module = ".".join(path.relative_to(ROOT).with_suffix("").parts)
    return module, code.co_qualname.partition(".<locals>")[0]


def caller_of(frame: FrameType) -> tuple[str, str] | None:
    """Return the nearest function of facegear that called a function.

    Parameters
    ----------
    frame : FrameType
        Call of the function.

    Returns
    -------
    tuple of str, or None
        Module and name; None where only other programs stand on the stack.
    """
    function, outer = locate(frame.f_code), frame.f_back
    while outer is not None:
        outer_function = locate(outer.f_code)
        if outer_function is not None and outer_function != function and outer_function[0] not in WRAPPERS:
            return outer_function
        outer = outer.f_back
    return None


def arguments_of(frame: FrameType) -> dict[str, Any]:
    """Return the arguments of a call that has just begun.

    Parameters
    ----------
    frame : FrameType
        The call.

    Returns
    -------
    dict
        Values by name.
    """
    code = frame.f_code
    count = code.co_argcount + code.co_kwonlyargcount + bool(code.co_flags & 4) + bool(code.co_flags & 8)
    values = frame.f_locals
    return {name: values[name] for name in code.co_varnames[:count] if name in values}


def parts_of(value: Any) -> Iterator[Any]:
    """Yield the objects that an object holds.

    Parameters
    ----------
    value : Any
        A dataclass, a tuple, a list, a mapping, or anything else, which holds nothing.

    Yields
    ------
    Any
        Fields, entries and values.
    """
    if isinstance(value, Mapping):
        yield from value.values()
    elif isinstance(value, tuple | list):
        yield from value
    elif is_dataclass(value) and not isinstance(value, type):
        yield from (getattr(value, part.name, None) for part in fields(value))


def holds_machine(value: Any, depth: int = DEPTH) -> bool:
    """Tell whether an object is the machine or its section, or holds it.

    Parameters
    ----------
    value : Any
        The object.
    depth : int
        Objects inside each other that are searched.

    Returns
    -------
    bool
        True if it does.
    """
    if isinstance(value, Transmission | Machine):
        return True
    return depth > 0 and any(holds_machine(part, depth - 1) for part in parts_of(value))


def is_number(value: Any, depth: int = 2, inside: bool = False) -> bool:
    """Tell whether a value is the backlash or half of it.

    Parameters
    ----------
    value : Any
        A number, an array, or a tuple, list or mapping of these.
    depth : int
        Containers inside each other that are searched.
    inside : bool
        Whether objects that hold the number count, too.

    Returns
    -------
    bool
        True if the number is found.
    """
    if isinstance(value, float):
        return any(abs(value - number) <= 1e-12 * number for number in NUMBERS)
    if isinstance(value, np.ndarray):
        return value.dtype == float and any(
            (np.abs(value - number) <= 1e-12 * number).any() for number in NUMBERS
        )
    if depth == 0 or not (inside or isinstance(value, tuple | list | Mapping)):
        return False
    return any(is_number(part, depth - 1, inside) for part in parts_of(value))


@cache
def names_backlash(code: CodeType) -> bool:
    """Tell whether the code of a function, with those inside it, names the backlash.

    Parameters
    ----------
    code : CodeType
        The code.

    Returns
    -------
    bool
        True if `half_backlash` or `backlash_um` is a name, an argument, a keyword or a text in it.
    """
    texts = {*code.co_names, *code.co_varnames}
    for constant in code.co_consts:
        if isinstance(constant, CodeType) and names_backlash(constant):
            return True
        texts |= {constant} if isinstance(constant, str) else set()
        texts |= set(constant) if isinstance(constant, tuple) else set()  # names of keywords
    return bool(texts & NAMES)


class Watch:
    """Profile function that records the calls which the machine and the backlash pass."""

    def __init__(self) -> None:
        self.paths, self.phase, self.has_ended = Paths(), "check", False

    def __call__(self, frame: FrameType, event: str, result: Any) -> None:
        if self.has_ended or event not in ("call", "return"):
            return
        if frame.f_code.co_name == "__init__" and frame.f_code.co_filename == "<string>":
            self._note_made(frame, event)
            return
        function = locate(frame.f_code)
        if function is None or function[0] in WRAPPERS:
            return
        if event == "call":
            self.phase = "stage" if function[1] == STAGE else self.phase
            self._note_machine(function, frame)
        self._note_backlash(function, frame, event, result)
        self.has_ended = event == "call" and function == LAST

    def _note_machine(self, function: tuple[str, str], frame: FrameType) -> None:
        arguments = arguments_of(frame)
        names = {name for name, value in arguments.items() if holds_machine(value)}
        if not names:
            return
        by_itself = isinstance(arguments.get("self"), Transmission | Machine) and names == {"self"}
        visit = self.paths.machine.setdefault(function, Visit(*function, by_itself))
        visit.phases.add(self.phase)
        visit.arguments |= names
        if (caller := caller_of(frame)) is not None:
            visit.callers.add(caller)

    def _note_backlash(self, function: tuple[str, str], frame: FrameType, event: str, result: Any) -> None:
        values = [value for value in frame.f_locals.values() if not is_whole_config(value)]
        is_back = event == "return" and not is_whole_config(result) and is_number(result)
        names_it = names_backlash(frame.f_code) and event == "return"
        uses_section = names_it and any(holds_number(value) for value in frame.f_locals.values())
        if function == TO_KERNEL and event == "return":
            self.paths.backlash.setdefault(function, Handling(*function)).hands_on = True
        elif is_back or uses_section or any(is_number(value) for value in values):
            handling = self.paths.backlash.setdefault(function, Handling(*function))
            handling.hands_on |= is_back or (names_it and holds_number(result))

    def _note_made(self, frame: FrameType, event: str) -> None:
        """Note the function that makes an object of the number; copies by `replace` are of an object."""
        maker = frame.f_back
        function = None if maker is None else locate(maker.f_code)
        if event == "call" and function is not None and is_number(tuple(arguments_of(frame).values())):
            self.paths.backlash.setdefault(function, Handling(*function)).hands_on = True


def is_whole_config(value: Any) -> bool:
    """Tell whether a value carries a section of the config, or more, as plain values.

    Parameters
    ----------
    value : Any
        The value.

    Returns
    -------
    bool
        True for a mapping, or a tuple or list with one, that has keys of the config with a backlash inside.
    """
    if isinstance(value, tuple | list):
        return any(is_whole_config(part) for part in value)
    if not isinstance(value, Mapping):
        return False
    return "backlash_um" in value or any(is_whole_config(part) for part in value.values())


def holds_number(value: Any) -> bool:
    """Tell whether the number stands anywhere in an object, a section of the config included.

    Parameters
    ----------
    value : Any
        The object.

    Returns
    -------
    bool
        True if it does.
    """
    if isinstance(value, Transmission):
        return is_number(value.backlash_um)
    return is_number(value, DEPTH, inside=True)


@contextmanager
def watch_calls(watch: Callable[[FrameType, str, Any], None]) -> Iterator[None]:
    """Watch every call of a block.

    Parameters
    ----------
    watch : callable
        Profile function.

    Yields
    ------
    None
        While it watches.
    """
    sys.setprofile(watch)
    try:
        yield
    finally:
        sys.setprofile(None)


def follow() -> Paths:
    """Follow machine and backlash of the example from the file to the compiled call.

    Returns
    -------
    Paths
        The functions that they pass.
    """
    text = (PACKAGE / "example.yaml").read_text()
    watch = Watch()
    with TemporaryDirectory() as folder:
        path = Path(folder) / "example.yaml"
        path.write_text(text.replace("backlash_um: 100", f"backlash_um: {BACKLASH_UM}"))
        with watch_calls(watch):
            gearbox = facegear.load(path, None)
            values = gearbox._chain.values
        assert is_whole_config(values)
        arguments = gearbox._chain.arguments(STAGE)
        watch.phase = "build"
        with watch_calls(watch):
            call(STAGES[STAGE], arguments)
    return watch.paths


def homes() -> list[str]:
    """Return the homes of half the backlash.

    Returns
    -------
    list of str
        Module and class of each field `half_backlash` of a class in facegear.
    """
    return [
        f"{'.'.join(path.relative_to(ROOT).with_suffix('').parts)}.{node.name}"
        for path in sorted(PACKAGE.rglob("*.py"))
        for node in ast.walk(ast.parse(path.read_text()))
        if isinstance(node, ast.ClassDef)
        for part in node.body
        if isinstance(part, ast.AnnAssign) and ast.unparse(part.target) == "half_backlash"
    ]


def main() -> None:
    """Print the functions and their numbers."""
    paths = follow()
    print(__doc__.partition("\n\n")[2])
    for phase, words in PHASE_WORDS.items():
        functions = paths.visits(phase)
        print(f"\nTransmission, {words}: {len(functions)} functions")
        _print_visits(functions)
    print(f"\nAttributes that machine and section compute from themselves: {len(paths.attributes)}")
    _print_visits(paths.attributes)
    print(f"\nCalls into a package above that of the caller: {len(paths.upward)} (none allowed)")
    for caller, function in paths.upward:
        print(f"  {caller} -> {function}")
    print(f"\nHomes of half_backlash: {', '.join(homes())} (one allowed)")
    count = f"{len(paths.on_the_way)} functions (at most {MOST_FOR_BACKLASH})"
    print(f"Half backlash, from the file to the kernel: {count}")
    for visit in paths.on_the_way:
        print(f"  {visit.module}.{visit.name}")
    print(f"\nBeside the way, using it up: {len(paths.beside_the_way)} functions")
    for visit in paths.beside_the_way:
        print(f"  {visit.module}.{visit.name}")


def _print_visits(functions: list[Visit]) -> None:
    for visit in functions:
        callers = ", ".join(sorted(name for _, name in visit.callers))
        print(f"  {visit.module}.{visit.name}({', '.join(sorted(visit.arguments))}) from {callers}")


if __name__ == "__main__":
    main()
