"""Places in source code that use a private name of another library or replace what it defines."""

import ast
import re
from collections.abc import Iterable, Iterator

OURS = ("facegear", "paper", "validation", "workflow", "snakemake_logger_plugin_facegear")
PUBLIC = {"_asdict", "_fields", "_make", "_replace", "_field_defaults"}
"""Underscore names that the standard library documents: those of namedtuples."""
PATCHES = {"patch", "setattr", "delattr"}


def complaints(source: str, known: Iterable[str] = ()) -> list[str]:
    """Return a line for each place, with its line number.

    Foreign are modules that are imported and not ours, what is imported from them, and what is reached from
    either by attributes or by a call of `import_module`, `__import__` or `getattr`. Refused are their names
    that begin with one underscore, also as texts in calls; such a name of any object, if neither the file
    nor another of ours (`known`) defines it; and assignments and patches of any attribute of something
    foreign.
    """
    tree = ast.parse(source)
    foreign, own = _foreign(tree), {*known, *own_names(source)}
    found = []
    for node in ast.walk(tree):
        found += [f"line {node.lineno}: {what}" for what in _of(node, foreign, own)]
    return found


def own_names(source: str) -> set[str]:
    """Return the names that a file defines: functions, classes, variables, and attributes of `self`."""
    own: set[str] = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            own.add(node.name)
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            own.add(node.id)
        elif _is_of_self(node):
            own.add(node.attr)
    return own


def _is_of_self(node: ast.AST) -> bool:
    """Whether an attribute of `self` is assigned."""
    stored = isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store)
    return stored and isinstance(node.value, ast.Name) and node.value.id == "self"


def _foreign(tree: ast.AST) -> set[str]:
    """Names that stand for foreign modules, classes and objects."""
    names: set[str] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names |= {(one.asname or one.name).split(".")[0] for one in node.names if not _is_ours(one.name)}
        elif isinstance(node, ast.ImportFrom) and not node.level and not _is_ours(node.module or ""):
            names |= {one.asname or one.name for one in node.names}
    while True:
        more = {
            target.id
            for node in ast.walk(tree)
            if isinstance(node, ast.Assign | ast.AnnAssign | ast.NamedExpr) and _is_reached(node.value, names)
            for target in (node.targets if isinstance(node, ast.Assign) else [node.target])
            for target in ast.walk(target)
            if isinstance(target, ast.Name)
        }
        if more <= names:
            return names
        names |= more


def _is_ours(module: str) -> bool:
    return module.split(".")[0] in OURS


def _is_reached(node: ast.AST | None, names: set[str]) -> bool:
    """Whether an expression is a foreign module or something of one: no result of a call of it."""
    if isinstance(node, ast.Name):
        return node.id in names
    if isinstance(node, ast.Attribute | ast.Subscript):
        return _is_reached(node.value, names)
    if isinstance(node, ast.Call) and _name(node.func) in ("import_module", "__import__"):
        first = node.args[0] if node.args else None
        return isinstance(first, ast.Constant) and not _is_ours(str(first.value))
    if isinstance(node, ast.Call) and _name(node.func) == "getattr":
        return bool(node.args) and _is_reached(node.args[0], names)
    return False


def _name(node: ast.AST) -> str:
    return getattr(node, "attr", getattr(node, "id", ""))


def _is_private(name: str) -> bool:
    return re.fullmatch(r"_[A-Za-z]\w*", name) is not None and name not in PUBLIC


def _of(node: ast.AST, foreign: set[str], own: set[str]) -> Iterator[str]:
    if isinstance(node, ast.ImportFrom) and not node.level and not _is_ours(node.module or ""):
        parts = [*(node.module or "").split("."), *(one.name for one in node.names)]
        yield from (f"private name {part}" for part in parts if _is_private(part))
    elif isinstance(node, ast.Import):
        parts = [part for one in node.names if not _is_ours(one.name) for part in one.name.split(".")]
        yield from (f"private name {part}" for part in parts if _is_private(part))
    elif isinstance(node, ast.Attribute):
        yield from _attribute(node, foreign, own)
    elif isinstance(node, ast.Call):
        yield from _call(node, foreign)
    elif isinstance(node, ast.Delete):
        yield from (f"deletes {ast.unparse(one)}" for one in node.targets if _is_part(one, foreign))
    elif isinstance(node, ast.Assign | ast.AugAssign | ast.AnnAssign):
        targets = node.targets if isinstance(node, ast.Assign) else [node.target]
        for part in (part for target in targets for part in ast.walk(target)):
            if isinstance(part, ast.Attribute) and isinstance(part.ctx, ast.Store):
                yield from _assigned(part, foreign)


def _attribute(node: ast.Attribute, foreign: set[str], own: set[str]) -> Iterator[str]:
    """A private name of something foreign, or one that the file does not define."""
    if _is_private(node.attr) and (_is_reached(node.value, foreign) or node.attr not in own):
        yield f"private name {ast.unparse(node)}"


def _assigned(target: ast.Attribute, foreign: set[str]) -> Iterator[str]:
    if _is_reached(target.value, foreign):
        yield f"assigns to {ast.unparse(target)}"


def _is_part(node: ast.AST, foreign: set[str]) -> bool:
    return isinstance(node, ast.Attribute) and _is_reached(node.value, foreign)


def _call(node: ast.Call, foreign: set[str]) -> Iterator[str]:
    name = _name(node.func)
    texts = [one.value for one in node.args if isinstance(one, ast.Constant) and isinstance(one.value, str)]
    if name in ("getattr", "hasattr", "attrgetter", "methodcaller", *PATCHES):
        yield from (f"private name {text!r}" for text in texts if any(map(_is_private, text.split("."))))
    if name in ("setattr", "delattr") and node.args and _is_reached(node.args[0], foreign):
        yield f"{name} of {ast.unparse(node.args[0])}"
    if name == "patch" or (name in ("object", "dict", "multiple") and "patch" in ast.unparse(node.func)):
        yield f"patches {', '.join(map(ast.unparse, node.args[:2]))}"
