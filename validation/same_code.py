"""Show that two commits have the same code apart from docstrings, comments, layout and names.

    python -m validation.same_code OLD             # OLD against the working tree
    python -m validation.same_code OLD NEW
    python -m validation.same_code OLD NEW --names # print all names that changed
    python -m validation.same_code OLD NEW --texts # messages may differ; they are printed

Files are compared one by one. Their syntax trees must be equal but for names. Names may differ if the same
binding has one name in all its places, two bindings of a scope do not become one, and a name that other
modules import has its new name there, too. An attribute or keyword may differ if some class, function or
module of the changed files renames a member or argument in the same way; which class an object has is left to
mypy and the tests. A string that follows a renamed name (`__all__`, `getattr`, a column) is printed.
"""

import argparse
import ast
import re
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import Any

from validation.scopes import Names, Occurrence, Scope

ROOT = Path(__file__).parents[1]
IDENTIFIERS = frozenset(
    (
        "id",
        "arg",
        "attr",
        "name",
        "asname",
        "names",
        "rest",
        "kwd_attrs",
        "ctx",
        "type_comment",
        "type_ignores",
    )
)
"""Fields of nodes that hold names, or say nothing about what the code does."""
Import = tuple[str, str, str]
"""Module, name that is taken from it (empty for `import module`), and name that is bound."""
Pair = tuple[str, str]
"""Old and new name, or old and new text."""


@dataclass
class Comparison:
    """Two versions of a file.

    - path: path of the new version
    - differences: lines that say where the code differs
    - bindings: new name of each binding, by scope and old name
    - members: pairs of attributes and of keywords with the line of the first place
    - definitions: pairs that classes, functions or the module define
    - texts: pairs of strings that differ, with the line
    - imports: pairs of blocks of imports, with the scope in which they stand
    """

    path: str
    differences: list[str] = field(default_factory=list)
    bindings: dict[tuple[str, str], str] = field(default_factory=dict)
    module: dict[str, str] = field(default_factory=dict)
    members: dict[Pair, int] = field(default_factory=dict)
    definitions: set[Pair] = field(default_factory=set)
    texts: list[tuple[int, Pair]] = field(default_factory=list)
    imports: list[tuple[int, list[Import], list[Import]]] = field(default_factory=list)


def compare_files(
    files: Mapping[str, tuple[bytes, bytes]], moves: Mapping[str, str] = MappingProxyType({})
) -> list[Comparison]:
    """Compare two versions of files.

    Parameters
    ----------
    files
        Old and new text by the file's new path.
    moves
        New path by old path, of files that were moved.

    Returns
    -------
    list of Comparison
        One a file; those without `differences` differ in names, docstrings, comments and layout alone.
    """
    comparisons = {path: _compare(path, old, new) for path, (old, new) in files.items()}
    modules = {module_name(old): module_name(new) for old, new in moves.items()}
    homes = {module_name(path): comparison for path, comparison in comparisons.items()}
    pairs = {pair for comparison in comparisons.values() for pair in comparison.definitions}
    for comparison in comparisons.values():
        for line, old, new in comparison.imports:
            _compare_imports(comparison, line, old, new, modules, homes)
        for (before, after), line in comparison.members.items():
            if (before, after) not in pairs:
                comparison.differences.append(f"line {line}: nothing renames {before} to {after}")
    return list(comparisons.values())


def module_name(path: str) -> str:
    """Return the dotted name of a module.

    Parameters
    ----------
    path
        Path of its file in the repository.

    Returns
    -------
    str
        The name.
    """
    return path.removesuffix(".py").removesuffix("/__init__").replace("/", ".")


def _compare(path: str, old: bytes, new: bytes) -> Comparison:
    result = Comparison(path)
    before, after = Names(old), Names(new)
    result.differences += _differences(before.tree, after.tree, result)
    if result.differences:
        return result
    occurrences = _without_imports(before), _without_imports(after)
    numbers = {scope: n for n, scope in enumerate(before.scopes)}
    new_numbers = {scope: n for n, scope in enumerate(after.scopes)}
    reverse: dict[tuple[int, str], str] = {}
    forward: dict[tuple[int, str], str] = {}
    for occurrence, new_occurrence in zip(*occurrences, strict=True):
        line = getattr(new_occurrence.node, "lineno", 0)
        if occurrence.role != "name":
            if occurrence.name != new_occurrence.name:
                result.members.setdefault((occurrence.name, new_occurrence.name), line)
                if occurrence.role == "attribute" and occurrence.binds:
                    result.definitions.add((occurrence.name, new_occurrence.name))
            continue
        homes = occurrence.scope.binding(occurrence.name), new_occurrence.scope.binding(new_occurrence.name)
        if homes[0] is None or homes[1] is None:
            if homes != (None, None) or occurrence.name != new_occurrence.name:
                result.differences.append(
                    f"line {line}: {occurrence.name} became {new_occurrence.name}, which is bound elsewhere"
                )
            continue
        number = numbers[homes[0]]
        is_same_binding = number == new_numbers[homes[1]]
        is_same_binding &= (
            forward.setdefault((number, occurrence.name), new_occurrence.name) == new_occurrence.name
        )
        is_same_binding &= (
            reverse.setdefault((number, new_occurrence.name), occurrence.name) == occurrence.name
        )
        if not is_same_binding:
            result.differences.append(
                f"line {line}: {occurrence.name} and {new_occurrence.name} are not one binding"
            )
        elif occurrence.name != new_occurrence.name:
            _define(result, homes[0], occurrence, new_occurrence)
    result.module = {name: now for (number, name), now in forward.items() if number == 0}
    return result


def _define(result: Comparison, home: Scope, occurrence: Occurrence, new_occurrence: Occurrence) -> None:
    result.bindings[home.name, occurrence.name] = new_occurrence.name
    if home.kind in ("class", "module") or isinstance(occurrence.node, ast.arg):
        result.definitions.add((occurrence.name, new_occurrence.name))


def _without_imports(names: Names) -> list[Occurrence]:
    return [occurrence for occurrence in names.occurrences if not isinstance(occurrence.node, ast.alias)]


def _differences(old: ast.AST, new: ast.AST, result: Comparison) -> Iterator[str]:
    """Yield where two trees differ, apart from names, docstrings and blocks of imports."""
    line = getattr(new, "lineno", 0)
    if type(old) is not type(new):
        yield f"line {line}: {type(old).__name__} became {type(new).__name__}"
        return
    if isinstance(old, ast.Constant) and isinstance(new, ast.Constant):
        if isinstance(old.value, str) and isinstance(new.value, str):
            if old.value != new.value:
                result.texts.append((line, (old.value, new.value)))
        elif repr(old.value) != repr(new.value):
            yield f"line {line}: {old.value!r} became {new.value!r}"
        return
    for name in old._fields:
        old_value: Any = getattr(old, name, None)
        new_value: Any = getattr(new, name, None)
        if name in IDENTIFIERS and not isinstance(old_value, ast.AST):
            if not isinstance(old_value, list) and (old_value is None) != (new_value is None):
                yield f"line {line}: {old_value} became {new_value}"
            if isinstance(old_value, list) and len(old_value) != len(new_value):
                yield f"line {line}: {len(old_value)} names became {len(new_value)}"
        elif isinstance(old_value, list):
            old_blocks, new_blocks = _blocks(old_value), _blocks(new_value)
            if len(old_blocks) != len(new_blocks):
                yield f"line {line}: {len(old_blocks)} parts of {type(old).__name__} became {len(new_blocks)}"
                return
            for left, right in zip(old_blocks, new_blocks, strict=True):
                if isinstance(left, list) and isinstance(right, list):
                    result.imports.append((line, left, right))
                elif isinstance(left, ast.AST) and isinstance(right, ast.AST):
                    yield from _differences(left, right, result)
                elif left != right:
                    yield f"line {line}: {left!r} became {right!r}"
        elif isinstance(old_value, ast.AST) and isinstance(new_value, ast.AST):
            yield from _differences(old_value, new_value, result)
        elif old_value != new_value:
            yield f"line {line}: {name} of {type(old).__name__} differs"


def _blocks(nodes: list[object]) -> list[object]:
    """Nodes of a list, with each run of imports as one list, and without docstrings."""
    blocks: list[object] = []
    for node in nodes:
        if (
            isinstance(node, ast.Expr)
            and isinstance(node.value, ast.Constant)
            and isinstance(node.value.value, str)
        ):
            continue
        if isinstance(node, ast.Import | ast.ImportFrom):
            if not (blocks and isinstance(blocks[-1], list)):
                blocks.append([])
            run = blocks[-1]
            if isinstance(run, list):
                run += _imports(node)
        else:
            blocks.append(node)
    if len(blocks) < len(nodes) and not blocks:
        return [ast.Pass()]  # a body that was a docstring alone
    return blocks


def _imports(node: ast.Import | ast.ImportFrom) -> list[Import]:
    if isinstance(node, ast.Import):
        return [(alias.name, "", alias.asname or alias.name.partition(".")[0]) for alias in node.names]
    module = "." * node.level + (node.module or "")
    return [(module, alias.name, alias.asname or alias.name) for alias in node.names]


def _compare_imports(
    result: Comparison,
    line: int,
    old: list[Import],
    new: list[Import],
    modules: Mapping[str, str],
    homes: Mapping[str, Comparison],
) -> None:
    """Compare two blocks of imports after the names of the old one have been made new."""
    rest = Counter(new)
    for module, name, bound in old:
        now = modules.get(module, module)
        as_module = modules.get(f"{module}.{name}")
        if as_module:
            now, _, new_name = as_module.rpartition(".")
        else:
            new_name = homes[now].module.get(name, name) if now in homes else name
        candidates = [item for item in rest if item[:2] == (now, new_name) and rest[item]]
        bound_now = next((value for (_, key), value in result.bindings.items() if key == bound), bound)
        best = next((item for item in candidates if item[2] in (bound_now, bound, new_name)), None)
        if best is None:
            result.differences.append(f"line {line}: import of {module} {name} as {bound} is missing")
            continue
        rest[best] -= 1
        if bound != best[2] and result.bindings.get(("", bound), best[2]) != best[2]:
            result.differences.append(f"line {line}: {bound} is imported as {best[2]}")
    for item in rest.elements():
        result.differences.append(f"line {line}: import of {' '.join(item)} is new")


def follows(text: Pair, pairs: set[Pair]) -> bool:
    """Whether a changed string differs only in words that were renamed as names.

    Parameters
    ----------
    text
        Old and new string.
    pairs
        Old and new names.

    Returns
    -------
    bool
        True if each word is equal or renamed, and all between the words is equal.
    """
    old, new = (re.split(r"(\w+)", part) for part in text)
    return len(old) == len(new) and all(a == b or (a, b) in pairs for a, b in zip(old, new, strict=True))


def _run_git(*arguments: str) -> bytes:
    return subprocess.run(["git", *arguments], cwd=ROOT, capture_output=True, check=True).stdout


def read_changes(
    old: str, new: str | None
) -> tuple[dict[str, tuple[bytes, bytes]], dict[str, str], list[str]]:
    """Read the Python files that differ between two commits.

    Parameters
    ----------
    old
        First commit.
    new
        Second commit, None for the working tree.

    Returns
    -------
    tuple
        Old and new text by new path; new path by old path of moved files; paths that only one of them has.
    """
    commits = [old] if new is None else [old, new]
    listing = _run_git("diff", "--name-status", "-M", "-z", *commits, "--", "*.py").decode().split("\0")
    files, moves, alone = {}, {}, []
    at = 0
    while at < len(listing) and listing[at]:
        status, before = listing[at], listing[at + 1]
        after = listing[at + 2] if status.startswith("R") else before
        at += 3 if status.startswith("R") else 2
        if status[0] in "AD":
            alone.append(before)
            continue
        if before != after:
            moves[before] = after
        now = (ROOT / after).read_bytes() if new is None else _run_git("show", f"{new}:{after}")
        files[after] = (_run_git("show", f"{old}:{before}"), now)
    return files, moves, alone


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line.

    Parameters
    ----------
    arguments
        Arguments of the command line, those of the process if None.

    Returns
    -------
    int
        Exit code: number 0 where all files have the same code.
    """
    parser = argparse.ArgumentParser(
        "validation.same_code", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("old", help="first commit")
    parser.add_argument("new", nargs="?", help="second commit; the working tree without it")
    parser.add_argument("--names", action="store_true", help="print all names that changed")
    parser.add_argument("--texts", action="store_true", help="strings may differ; they are printed")
    options = parser.parse_args(arguments)
    files, moves, alone = read_changes(options.old, options.new)
    comparisons = compare_files(files, moves)
    pairs = {pair for result in comparisons for pair in result.definitions}
    pairs |= {(name, now) for result in comparisons for (_, name), now in result.bindings.items()}
    for result in comparisons:
        for line, text in result.texts:
            if follows(text, pairs) or options.texts:
                print(f"{result.path}: line {line}: text {text[0]!r} became {text[1]!r}")
            else:
                result.differences.append(f"line {line}: text {text[0]!r} became {text[1]!r}")
        if options.names:
            for (scope, name), now in sorted(result.bindings.items()):
                print(f"{result.path}::{f'{scope}.{name}'.strip('.')} -> {now}")
    for path in alone:
        print(f"{path}: only one commit has it", file=sys.stderr)
    for result in comparisons:
        for difference in result.differences:
            print(f"{result.path}: {difference}", file=sys.stderr)
    changed_paths = [result.path for result in comparisons if result.differences] + alone
    print(
        f"{len(comparisons) + len(alone) - len(changed_paths)} files have the same code, "
        f"{len(changed_paths)} differ otherwise"
    )
    return 1 if changed_paths else 0


if __name__ == "__main__":
    sys.exit(main())
