"""Fingerprint of exactly the modules a stage imports, found from the imports themselves.

Snakemake does not see changes of an imported package; a rule that carries this fingerprint as a parameter
reruns when, and only when, code that it can reach has changed. Comments, docstrings and layout do not count.
"""

import ast
import hashlib
from collections.abc import Iterable
from functools import cache
from pathlib import Path

PACKAGE = "facegear"


def fingerprint(script: str | Path, root: str | Path) -> str:
    """Hash of a script's own code and of all package modules below `root` that it reaches by imports.

    Templates (`*.j2`) count with the package they lie in.
    """
    digest = hashlib.sha256(_code(Path(script)).encode())
    for module in reached_modules(script, root):
        file = _file(module, Path(root))
        digest.update(module.encode() + b"\0" + _code(file).encode())
        if file.name == "__init__.py":
            for template in sorted(file.parent.glob("*.j2")):
                digest.update(template.read_bytes())
    return digest.hexdigest()[:16]


def reached_modules(script: str | Path, root: str | Path) -> tuple[str, ...]:
    """Names of the package's modules that a script imports, directly or through others, sorted."""
    root = Path(root)
    reached: set[str] = set()
    todo = list(_imported(Path(script), root))
    while todo:
        module = todo.pop()
        if module not in reached:
            reached.add(module)
            todo.extend(_imported(_file(module, root), root))
    return tuple(sorted(reached))


def _imported(path: Path, root: Path) -> Iterable[str]:
    for node in ast.walk(_tree(path, path.stat().st_mtime_ns)):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module and node.level == 0:
            names = [node.module] + [f"{node.module}.{alias.name}" for alias in node.names]
        else:
            continue
        for name in names:
            if name.split(".")[0] == PACKAGE:
                parents = [name.rsplit(".", depth)[0] for depth in range(name.count(".") + 1)]
                yield from (parent for parent in parents if _exists(parent, root))


def _exists(module: str, root: Path) -> bool:
    base = root.joinpath(*module.split("."))
    return base.with_suffix(".py").is_file() or (base / "__init__.py").is_file()


def _file(module: str, root: Path) -> Path:
    base = root.joinpath(*module.split("."))
    return base.with_suffix(".py") if base.with_suffix(".py").is_file() else base / "__init__.py"


def _code(path: Path) -> str:
    return _normalised(path, path.stat().st_mtime_ns)


@cache
def _normalised(path: Path, modified: int) -> str:
    tree = ast.parse(path.read_text(encoding="utf-8"))
    for node in ast.walk(tree):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            body = node.body
            if body and isinstance(body[0], ast.Expr) and isinstance(body[0].value, ast.Constant):
                node.body = body[1:] or ([] if isinstance(node, ast.Module) else [ast.Pass()])
    return ast.unparse(tree)


@cache
def _tree(path: Path, modified: int) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"))
