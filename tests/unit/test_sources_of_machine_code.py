"""Whether stored machine code is found again only while all that it was made of has the same text."""

import os
import sys

from forked_python import run_together

PROGRAM = """
import importlib
from pathlib import Path
from types import CodeType, FunctionType

import facegear
from facegear.machine_code import stored

ROOT = Path(facegear.__file__).parent
noted, text_of, made = [], stored.text_of, stored.SourcesCache.__init__


def text(*sources):
    folders = [path.glob("*.py") if path.is_dir() else [path] for path in map(Path, sources)]
    noted.append([None, {file for files in folders for file in files}])
    return text_of(*sources)


def of_function(cache, function, *rest):
    noted[-1][0] = function
    made(cache, function, *rest)


def codes(code):
    yield code
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from codes(constant)


def meant(value):
    # a compiled function, an intrinsic, one that chooses by type among several, or what makes code for them
    yield from (getattr(value, name, None) for name in ("py_func", "_defn"))
    if isinstance(value, FunctionType) and hasattr(value, "of"):
        kept = [cell.cell_contents for cell in value.__closure__]
        yield from (function for part in kept if isinstance(part, dict) for function in part.values())
    elif isinstance(value, FunctionType):
        yield value


def reached(function, known):
    for code in codes(function.__code__):
        for name in code.co_names:
            for part in meant(function.__globals__.get(name)):
                part = getattr(part, "py_func", part)
                own = isinstance(part, FunctionType) and part.__module__.startswith("facegear")
                if own and part not in known:
                    known.add(part)
                    reached(part, known)
    return known


stored.text_of, stored.SourcesCache.__init__ = text, of_function
for path in sorted(ROOT.rglob("*.py")):
    if "compile" in path.read_text():
        importlib.import_module(".".join(path.relative_to(ROOT.parent).with_suffix("").parts))
for function, files in noted:
    parts = {Path(part.__code__.co_filename) for part in reached(function, set())}
    print(function.__module__, function.__name__, len(parts), *sorted(path.name for path in parts - files))
"""


def test_every_stored_function_names_the_files_of_all_that_is_compiled_into_it():
    (done,) = run_together([PROGRAM], {"PYTHONPATH": os.pathsep.join(sys.path)})
    assert done.returncode == 0, done.stderr
    lines = [line.split() for line in done.stdout.splitlines()]
    assert "run_periods" in {name for _, name, *_ in lines}
    assert sum(int(count) for _, _, count, *_ in lines) > len(lines)
    assert [line for line in lines if len(line) > 3] == []
