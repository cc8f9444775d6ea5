"""Stages run again when, and only when, a function changes that they call."""

import ast
import functools
import random
import re
import shutil
import sys
from collections import defaultdict
from pathlib import Path

import pytest

import facegear
from facegear.pipeline import run
from facegear.pipeline.provenance.fingerprint import loaded_modules, reached_functions, stage_fingerprint
from facegear.pipeline.stage import load
from facegear.pipeline.table import STAGES

pytestmark = pytest.mark.xdist_group("functions_of_stages")  # one trace for all
ROOT = Path(__file__).parents[4]
ASKED = (
    "mesh",
    "modal",
    "topography",
    "hunting",
    "sharing_map",
    "load_sharing",
    "shaft_orders",
    "pose_surface",
)
ASKED += ("dynamics_response", "tooth_errors", "ratings", "law_loads")
"""Stages of the quick config that are computed with those before them, in a few seconds."""


@pytest.fixture(scope="module")
def calls():
    """Code objects of the package that each stage called, by stage."""
    called = defaultdict(set)

    def traced(name, function, *args, **given):
        codes = called[name]

        def note(frame, event, argument):
            if event == "call":
                codes.add(frame.f_code)

        before = sys.getprofile()
        sys.setprofile(note)
        try:
            return function(*args, **given)
        finally:
            sys.setprofile(before)

    def load_traced(reference):
        function = load(reference)
        if reference not in FUNCTIONS:
            return function
        return functools.wraps(function)(functools.partial(traced, function.__name__, function))

    def with_machine(stage, arguments):
        return traced(stage.name, make_machine, stage, arguments)

    make_machine = run.with_machine
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(run, "load", load_traced)
        patch.setattr(run, "with_machine", with_machine)
        chain = facegear.load(ROOT / "config/quick.yaml", None)._chain
        for name in ASKED:
            chain.output(name)
    return {name: {code for code in codes if is_counted(code)} for name, codes in called.items()}


FUNCTIONS = {stage.function for stage in STAGES.values()}


def is_counted(code):
    """Whether code of the package is the stage's, not that of the frame which calls stages."""
    path = Path(code.co_filename)
    if not path.is_relative_to(ROOT / "facegear") or code.co_qualname.startswith("<"):
        return False
    return (
        not path.is_relative_to(ROOT / "facegear/pipeline")
        and path != ROOT / "facegear/pipeline/arguments.py"
    )


def named(code):
    """Function or class of a module that a code object lies in, as `module:name`."""
    path = Path(code.co_filename).relative_to(ROOT).with_suffix("")
    return f"{'.'.join(path.parts).removesuffix('.__init__')}:{code.co_qualname.partition('.')[0]}"


@pytest.fixture(scope="module")
def copied(tmp_path_factory):
    """Copy of the package that tests may change."""
    root = tmp_path_factory.mktemp("copied")
    kept = ("*.so", "*.pyi", "*.pyc", "*.csv", "*.zip", "*.json")
    shutil.copytree(ROOT / "facegear", root / "facegear", ignore=shutil.ignore_patterns(*kept))
    return root


class Changed:
    """Texts of files of a copy, which are put back in the end."""

    def __init__(self, root):
        self.root, self.texts = root, {}

    def __enter__(self):
        return self

    def write(self, path, text):
        self.texts.setdefault(path, path.read_text())
        path.write_text(text)

    def __exit__(self, *error):
        for path, text in self.texts.items():
            path.write_text(text)


def returns(path, name, line=None):
    """Expressions that a function of a file returns; it is found by its name, or by its first line."""
    for node in ast.walk(ast.parse(path.read_text())):
        first = getattr(node, "decorator_list", None) or [node]
        if isinstance(node, ast.FunctionDef) and (first[0].lineno == line if line else node.name == name):
            return [inner.value for inner in ast.walk(node) if isinstance(inner, ast.Return) and inner.value]
    return []


def with_another_value(text, value):
    """The text in which a returned expression became a list."""
    lines = text.encode().splitlines(keepends=True)
    lines[value.end_lineno - 1] = insert(lines[value.end_lineno - 1], value.end_col_offset, b")]")
    lines[value.lineno - 1] = insert(lines[value.lineno - 1], value.col_offset, b"[(")
    return b"".join(lines).decode()


def insert(line, column, more):
    return line[:column] + more + line[column:]


def fingerprint_of(stage, root):
    return stage_fingerprint(STAGES[stage].functions, root)


def test_every_function_that_a_stage_calls_counts(calls):
    assert set(ASKED) <= set(calls)
    for stage, codes in calls.items():
        assert len(codes) > 5
        assert {named(code) for code in codes} <= reached_functions(STAGES[stage].functions, ROOT), stage


def test_fifty_changed_functions_leave_no_stage_fresh_that_calls_them(calls, copied):
    callers = defaultdict(list)
    for stage, codes in sorted(calls.items()):
        for code in codes:
            callers[code].append(stage)
    before = {stage: fingerprint_of(stage, copied) for stage in calls}
    chosen = random.Random(52)
    codes = sorted(callers, key=lambda code: (code.co_filename, code.co_firstlineno))
    chosen.shuffle(codes)
    changed = 0
    for code in codes:
        path = copied / Path(code.co_filename).relative_to(ROOT)
        values = returns(path, code.co_name, code.co_firstlineno)
        if values and changed < 50:
            changed += 1
            with Changed(copied) as files:
                files.write(path, with_another_value(path.read_text(), chosen.choice(values)))
                for stage in chosen.sample(callers[code], min(2, len(callers[code]))):
                    assert fingerprint_of(stage, copied) != before[stage], (code, stage)
    assert changed == 50


@pytest.mark.parametrize("stage", ["modal", "contact", "load_sharing", "topography"])
def test_changed_functions_that_a_stage_does_not_use_leave_it_fresh(stage, copied):
    functions, chosen = STAGES[stage].functions, random.Random(52)
    before, used = stage_fingerprint(functions, copied), reached_functions(functions, copied)
    modules = sorted(loaded_modules(functions, copied))
    unused = [
        (path, node.name)
        for module in modules
        if (path := copied / f"{module.replace('.', '/')}.py").is_file()
        for node in ast.parse(path.read_text()).body
        if isinstance(node, ast.FunctionDef) and f"{module}:{node.name}" not in used
    ]
    changed = 0
    with Changed(copied) as files:
        for path, name in chosen.sample(unused, min(30, len(unused))):
            for value in returns(path, name)[:1]:
                files.write(path, with_another_value(path.read_text(), value))
                changed += 1
        assert changed > 5
        assert stage_fingerprint(functions, copied) == before


def test_changed_comments_and_docstrings_leave_every_stage_fresh(copied):
    before = {stage: fingerprint_of(stage, copied) for stage in STAGES}
    with Changed(copied) as files:
        for path in sorted(copied.rglob("*.py")):
            text = path.read_text()
            docstring = re.compile(r'(?m)^( *)"""(?=\w)')
            other = docstring.sub(r'\1# Why it is so.\n\1"""Another text: ', text)
            if other != text:
                files.write(path, other)
        assert len(files.texts) > 300
        assert {stage: fingerprint_of(stage, copied) for stage in STAGES} == before


@pytest.mark.parametrize(
    ("what", "places"),
    [
        (r"\bmetaclass=|__init_subclass__|__subclasses__|__set_name__", set()),
        (r"import pickle|allow_pickle=True|__reduce__|\bjoblib\b|\bdill\b", set()),
        (
            r"get_type_hints|get_annotations|inspect\.signature|__annotations__",
            {"facegear/pipeline/arguments.py"},
        ),
    ],
)
def test_conditions_under_which_fingerprints_are_complete_hold(what, places):
    """`facegear.pipeline.provenance.fingerprint` names them."""
    own = ROOT / "facegear/pipeline/provenance"
    found = {
        path.relative_to(ROOT).as_posix()
        for path in (ROOT / "facegear").rglob("*.py")
        if not path.is_relative_to(own) and re.search(what, path.read_text())
    }
    assert found == places
