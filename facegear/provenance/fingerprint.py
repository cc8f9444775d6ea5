"""Fingerprint of exactly the modules a stage imports, found from the imports themselves.

Snakemake does not see changes of an imported package; a rule that carries this fingerprint as a parameter
reruns when, and only when, code that it can reach has changed. Comments, docstrings and layout do not count.
"""

import ast
import hashlib
import json
import os
import sys
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from facegear.errors import FacegearError
from facegear.io.atomic import atomic_path

PACKAGES = ("facegear", "paper", "validation")
"""The library and, in a checkout, what stands beside it."""
BESIDE = ("*.j2", "src/**/*.cpp", "src/**/*.hpp")
"""Files that count with the package that they lie in: templates, and sources of compiled kernels."""


@dataclass(frozen=True)
class _Source:
    """What counts of a file: hash of its code without docstrings, and what it imports of our packages.

    Of `from package.module import name` that is `package.module.name` too, be it a module or not.
    """

    code: str
    names: tuple[str, ...]


KEPT = 3000
"""Source files that `remember` keeps: those of some versions, a kilobyte each."""
_known: dict[str, _Source] = {}
"""By the hash of a file's text: what `recall` read, and all that was parsed since; used last stands last."""
_recalled: set[str] = set()
"""Keys of `_known` that `recall` read."""


def recall(file: Path) -> None:
    """Take from `file` what counts of source files, as `remember` left it; the others are parsed.

    Clones share such a file, as their sources are known by their text. One that cannot be read, or that
    another version wrote, is passed over.
    """
    with suppress(OSError, ValueError, KeyError, TypeError):
        stored = json.loads(file.read_text(encoding="utf-8"))
        if stored["version"] == _version():
            _known.update(
                {key: _Source(code, tuple(names)) for key, (code, names) in stored["files"].items()}
            )
            _recalled.update(_known)


def remember(file: Path) -> None:
    """Leave in `file` what counts of the source files used last for the next process, if any was parsed here.

    Where nothing can be written the next process parses again.
    """
    if _known.keys() - _recalled:
        files = {key: (source.code, source.names) for key, source in [*_known.items()][-KEPT:]}
        with suppress(OSError, FacegearError), atomic_path(file) as partial:
            partial.write_text(json.dumps({"version": _version(), "files": files}), encoding="utf-8")


def _version() -> str:
    return f"{sys.version_info[:2]} {hashlib.sha256(Path(__file__).read_bytes()).hexdigest()}"


def fingerprint(script: str | Path, root: str | Path, modules: Sequence[str] = ()) -> str:
    """Hash of a script's own code and of all package modules below `root` that it reaches by imports.

    Templates and the C++ sources of kernels (BESIDE) count with the package they lie in. Where the script
    calls `modules` that it does not import itself, their own fingerprint follows after a dot, so that results
    can be known without the script.
    """
    root, script = Path(root), Path(script)
    own = _hash(_source(script).code, reached_modules(script, root), root)
    return f"{own}.{stage_fingerprint(modules, root)}" if modules else own


def stage_fingerprint(modules: Sequence[str], root: str | Path) -> str:
    """Hash of modules of the package (by their dotted names) and of all that they reach by imports."""
    root = Path(root)
    reached = {name for module in modules for name in reached_modules(_file(module, root), root)}
    return _hash("", reached, root, *modules)


def _hash(code: str, modules: Iterable[str], root: Path, *more: str) -> str:
    digest = hashlib.sha256(code.encode())
    for module in sorted({*modules, *more}):
        file = _file(module, root)
        digest.update(module.encode() + b"\0" + _source(file).code.encode())
        if file.name == "__init__.py":
            for pattern in BESIDE:
                for beside in sorted(file.parent.glob(pattern)):
                    status = os.stat(beside)
                    digest.update(_text_hash(str(beside), status.st_size, status.st_mtime_ns))
    return digest.hexdigest()[:16]


def reached_modules(script: str | Path, root: str | Path) -> tuple[str, ...]:
    """Names of the package's modules that a script imports, directly or through others, sorted."""
    root = Path(root)
    reached: set[str] = set()
    todo = list(_source(Path(script)).names)
    while todo:
        module = todo.pop()
        if module not in reached and _exists(module, root):
            reached.add(module)
            todo.extend(_source(_file(module, root)).names)
    return tuple(sorted(reached))


@cache
def _text_hash(path: str, size: int, mtime_ns: int) -> bytes:
    return hashlib.sha256(Path(path).read_bytes()).digest()


def _source(path: Path) -> _Source:
    status = os.stat(path)
    return _looked_up(str(path), status.st_size, status.st_mtime_ns)


@cache
def _looked_up(path: str, size: int, mtime_ns: int) -> _Source:
    """Texts, as they are compared faster than paths: a start of the workflow asks ten thousand times."""
    text = Path(path).read_bytes()
    key = hashlib.sha256(text).hexdigest()[:32]
    _known[key] = source = _known.pop(key, None) or _parsed(text)
    return source


def _parsed(text: bytes) -> _Source:
    tree = ast.parse(text)
    modules: set[str] = set()
    for node in _executed(tree):
        if isinstance(node, ast.Import | ast.ImportFrom):
            for name in _names(node):
                if name.split(".")[0] in PACKAGES:
                    modules.update(name.rsplit(".", depth)[0] for depth in range(name.count(".") + 1))
        elif isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            body = node.body
            if body and isinstance(body[0], ast.Expr) and isinstance(body[0].value, ast.Constant):
                node.body = body[1:] or ([] if isinstance(node, ast.Module) else [ast.Pass()])
    return _Source(hashlib.sha256(ast.unparse(tree).encode()).hexdigest(), tuple(sorted(modules)))


def _executed(node: ast.AST) -> Iterator[ast.AST]:
    """A node and all statements inside it, but those that only a type checker reads."""
    if not (isinstance(node, ast.If) and isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING"):
        yield node
        for part in ("body", "orelse", "finalbody", "handlers", "cases"):
            for inner in getattr(node, part, ()):
                yield from _executed(inner)


def _names(node: ast.Import | ast.ImportFrom) -> list[str]:
    if isinstance(node, ast.Import):
        return [alias.name for alias in node.names]
    if node.module is None or node.level:
        return []
    return [node.module] + [f"{node.module}.{alias.name}" for alias in node.names]


def _exists(module: str, root: Path) -> bool:
    return _known_file(module, str(root))[1]


def _file(module: str, root: Path) -> Path:
    return _known_file(module, str(root))[0]


@cache
def _known_file(module: str, root: str) -> tuple[Path, bool]:
    """The file of a module, and whether there is one."""
    base = Path(root, *module.split("."))
    alone = base.with_suffix(".py")
    if alone.is_file():
        return alone, True
    package = base / "__init__.py"
    return package, package.is_file()
