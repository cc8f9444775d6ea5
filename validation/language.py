"""Check the language of the code: openings of docstrings, bare names, and sections of public docstrings.

The rules are in CONTRIBUTING.md.

    python -m validation.language            # name what breaks a rule
"""

import argparse
import ast
import re
import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[1]
SOURCES = ("facegear", "paper", "validation", "workflow")
"""Folders whose names and public functions are checked; docstrings are checked in the tests, too."""

OPENING = re.compile(r"(Of|Those|That|What|The same|Some|As)\b")
"""How no docstring begins: a verb or the noun that is returned does."""
BARE = frozenset(
    word
    for line in (ROOT / "validation" / "bare_names.txt").read_text("utf-8").splitlines()
    if not line.startswith("#")
    for word in line.split()
)
"""Participles, pronouns and metaphors that tell nothing of a value where they stand alone as its name."""

UNIT = re.compile(
    r"(?<![\w/])(1|%|m|mm|um|µm|rad|deg|rpm|s|ms|Hz|kHz|N|kN|J|W|kW|K|C|kg|g|Pa|kPa|MPa|GPa|bytes?|seconds?|pixels?|"
    r"degrees?|pitches|modules|periods?|cycles?|teeth|(rad|m|N|kg|J|W|Pa|K|mm|um|1)[ *]?[/^*.]?[\w^/* ]*|"
    r"dimensionless|relative|fractions?|ratios?|factors?|shares?|counts?|number of|index|indices|unit|units|"
    r"percent|points an inch)(?!\w)"
)
"""Units in the description of a number, with "any unit" and words for pure numbers."""
NUMERIC = re.compile(r"\b(float|complex|Array|ComplexArray)\b")
ARRAY = re.compile(r"\b(Array|ComplexArray|Integers|Mask|AnyArray)\b")
SHAPE = re.compile(r"\([^()]*\)")
CONSTANT = re.compile(r"_?[A-Z][A-Z0-9_]+")
COMMENT = re.compile(r"(?m)(^|  )# ")
UNCHECKED_ARGUMENTS = frozenset(("self", "cls"))

PUBLIC_NAMES = {
    "facegear/gearbox.py::Gearbox.following::name": "answer of a gearbox",
    "facegear/pipeline/stages/sharing.py::following::name": "stage of that answer",
    "facegear/pipeline/displaced_contact.py::DisplacedContact.loaded::name": "answer of a displaced contact",
    "facegear/schema/casing.py::CasingFoot.held::name": "key of the config",
    "facegear/pipeline/results/machine.py::OperatingPoseResult.leaving::name": "table of a result",
    "facegear/pipeline/results/motion.py::BranchesResult.swept::name": "table of a result",
}
"""Methods that users call by a bare word, and why they may: public names stay as they are."""

Function = ast.FunctionDef | ast.AsyncFunctionDef
Definition = Function | ast.ClassDef


@dataclass(frozen=True)
class Entry:
    """One entry of a section of a docstring: a parameter or a returned value."""

    name: str
    text: str


def find_offenders() -> set[str]:
    """Return the keys of all places that break a rule.

    Returns
    -------
    set of str
        Keys `path::name::rule`; those of PUBLIC_NAMES only if they break no rule any more.
    """
    folders = [*(ROOT / name for name in SOURCES), ROOT / "tests"]
    paths = sorted(path for folder in folders for path in folder.rglob("*.py"))
    keys = {key for path in paths for key in offenders_of(path.relative_to(ROOT), path.read_text("utf-8"))}
    return keys ^ PUBLIC_NAMES.keys()


def offenders_of(path: Path, source: str) -> set[str]:
    """Return the keys of all places of a module that break a rule.

    Parameters
    ----------
    path
        Path of the module in the repository.
    source
        Its text.

    Returns
    -------
    set of str
        Keys `path::name::rule`.
    """
    tree = ast.parse(source)
    offenders = {(name, "opening") for name, text in docstrings(tree) if OPENING.match(text)}
    if "tests" not in path.parts:
        offenders |= {(name, "name") for name in defined_names(tree) if is_bare(name.rpartition(".")[2])}
        if is_bare(path.stem):
            offenders.add(("<module>", "name"))
        if path.parts[0] == "facegear":
            offenders |= {(name, "constant") for name in unexplained_constants(tree, source)}
        if "scripts" not in path.parts:
            for name, function in public_functions(tree):
                offenders |= {(name, rule) for rule in broken_sections(function)}
    return {f"{path.as_posix()}::{name}::{rule}" for name, rule in offenders}


def is_bare(name: str) -> bool:
    """Whether a name is a bare participle or pronoun, in any case, plural or private.

    Parameters
    ----------
    name
        The name, without that of its module, class or function.

    Returns
    -------
    bool
        True if the word alone is refused.
    """
    if name.startswith("__"):
        return False  # Python's own names, such as __all__
    word = name.strip("_").lower()
    return word in BARE or word.removesuffix("s") in BARE


def docstrings(tree: ast.Module) -> Iterator[tuple[str, str]]:
    """Yield the docstrings of a module, its classes, functions and constants.

    Parameters
    ----------
    tree
        The module.

    Yields
    ------
    tuple of str
        Qualified name (`<module>` of the module) and docstring.
    """
    yield from _docstrings_below(tree, "")


def _docstrings_below(node: ast.AST, prefix: str) -> Iterator[tuple[str, str]]:
    if isinstance(node, ast.Module | Definition):
        if text := ast.get_docstring(node):
            yield prefix.strip(".") or "<module>", text
        for statement, after in zip(node.body, node.body[1:], strict=False):
            match (statement, after):
                case (
                    ast.Assign(targets=[target, *_]) | ast.AnnAssign(target=target),
                    ast.Expr(ast.Constant(str(text))),
                ):
                    yield f"{prefix}{ast.unparse(target)}", text.strip()
    for child in ast.iter_child_nodes(node):
        yield from _docstrings_below(
            child, f"{prefix}{child.name}." if isinstance(child, Definition) else prefix
        )


def unexplained_constants(tree: ast.Module, source: str) -> Iterator[str]:
    """Yield the constants of a module that have neither a docstring nor a comment.

    What a docstring should say, a program cannot check: meaning, unit, and the reason for a free number.

    Parameters
    ----------
    tree
        The module.
    source
        Its text.

    Yields
    ------
    str
        Name, in upper case, of each constant; of several that are assigned together, all.
    """
    lines = source.splitlines()
    for statement, after in zip(tree.body, [*tree.body[1:], ast.Pass()], strict=True):
        match statement:
            case ast.Assign(targets=[target, *_]) | ast.AnnAssign(target=target, value=ast.expr()):
                names = [node.id for node in ast.walk(target) if isinstance(node, ast.Name)]
            case _:
                continue
        has_docstring = isinstance(after, ast.Expr) and isinstance(after.value, ast.Constant)
        text = "\n".join(lines[max(statement.lineno - 2, 0) : statement.end_lineno])
        if not has_docstring and not COMMENT.search(text):
            yield from (name for name in names if CONSTANT.fullmatch(name))


def defined_names(tree: ast.Module) -> Iterator[str]:
    """Yield the names of all functions, classes, arguments, variables and attributes.

    Parameters
    ----------
    tree
        The module.

    Yields
    ------
    str
        Qualified name.
    """
    yield from _names_below(tree, "")


def _names_below(node: ast.AST, prefix: str) -> Iterator[str]:
    for child in ast.iter_child_nodes(node):
        below = prefix
        if isinstance(child, Definition):
            yield f"{prefix}{child.name}"
            below = f"{prefix}{child.name}."
        elif isinstance(child, ast.arg):
            yield f"{prefix}{child.arg}"
        elif isinstance(child, ast.Name) and isinstance(child.ctx, ast.Store):
            yield f"{prefix}{child.id}"
        elif isinstance(child, ast.Attribute) and isinstance(child.ctx, ast.Store):
            yield f"{prefix}{child.attr}"
        elif isinstance(child, ast.alias) and child.asname:
            yield f"{prefix}{child.asname}"
        yield from _names_below(child, below)


def public_functions(tree: ast.Module) -> Iterator[tuple[str, Function]]:
    """Yield all public functions, and public methods of public classes.

    Parameters
    ----------
    tree
        The module.

    Yields
    ------
    tuple of str and Function
        Qualified name and node.
    """
    for node in tree.body:
        owner = node.name if isinstance(node, ast.ClassDef) else ""
        for inner in node.body if isinstance(node, ast.ClassDef) else [node]:
            name = f"{owner}.{inner.name}".strip(".") if isinstance(inner, Function) else "_"
            if isinstance(inner, Function) and not any(part.startswith("_") for part in name.split(".")):
                yield name, inner


def broken_sections(function: Function) -> Iterator[str]:
    """Yield the rules of numpydoc that the docstring of a public function breaks.

    Parameters
    ----------
    function
        The function's node.

    Yields
    ------
    str
        `parameters` where an argument is not described, `returns` where the result is not, `units` where a
        number has no unit, and `shapes` where an array has no shape.
    """
    text = ast.get_docstring(function) or ""
    decorators = {ast.unparse(decorator).rpartition(".")[2] for decorator in function.decorator_list}
    if decorators & {"overload", "property", "cached_property", "setter"}:
        return
    parameters = {entry.name.lstrip("*"): entry for entry in entries(text, "Parameters")}
    results = [*entries(text, "Returns"), *entries(text, "Yields")]
    arguments = [argument for argument in _arguments(function) if argument.arg not in UNCHECKED_ARGUMENTS]
    if any(argument.arg not in parameters for argument in arguments):
        yield "parameters"
    result = ast.unparse(function.returns) if function.returns else "None"
    if result not in ("None", "NoReturn", "Never") and not results:
        yield "returns"
    kinds = [
        (ast.unparse(argument.annotation or ast.Constant(None)), parameters[argument.arg].text)
        for argument in arguments
        if argument.arg in parameters
    ]
    kinds += [(result, "\n".join(f"{entry.name}\n{entry.text}" for entry in results))] if results else []
    if any(NUMERIC.search(kind) and not UNIT.search(text) for kind, text in kinds):
        yield "units"
    if any(ARRAY.search(kind) and not SHAPE.search(text) for kind, text in kinds):
        yield "shapes"


def _arguments(function: Function) -> list[ast.arg]:
    signature = function.args
    variadic = [argument for argument in (signature.vararg, signature.kwarg) if argument]
    return [*signature.posonlyargs, *signature.args, *signature.kwonlyargs, *variadic]


def entries(docstring: str, section: str) -> list[Entry]:
    """Return the entries of a numpydoc section.

    Parameters
    ----------
    docstring
        The docstring, without its indentation.
    section
        Title of the section, such as ``Parameters``.

    Returns
    -------
    list of Entry
        Name (of a returned value its type), and the type with the description.
    """
    parts = re.split(r"(?m)^(\w[\w ]*)\n-{3,}$\n?", docstring)
    content = dict(zip(parts[1::2], parts[2::2], strict=True)).get(section, "")
    blocks: list[list[str]] = []
    for line in content.strip("\n").splitlines():
        if line and not line[0].isspace():
            blocks.append([line])
        elif blocks:
            blocks[-1].append(line)
    return [
        Entry(name.strip(), "\n".join([lines[0].partition(":")[2], *lines[1:]]))
        for lines in blocks
        for name in lines[0].partition(":")[0].split(",")
    ]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line.

    Parameters
    ----------
    arguments
        Arguments of the command line, those of the process if None.

    Returns
    -------
    int
        Exit code: number 0 where nothing breaks a rule.
    """
    parser = argparse.ArgumentParser(
        "validation.language",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.parse_args(arguments)
    present = find_offenders()
    for key in sorted(present):
        print(f"{key}: breaks a rule (CONTRIBUTING.md, Language)", file=sys.stderr)
    counts = Counter(key.rpartition("::")[2] for key in present)
    print(", ".join(f"{rule}: {count}" for rule, count in sorted(counts.items())) or "no offender")
    return 1 if present else 0


if __name__ == "__main__":
    sys.exit(main())
