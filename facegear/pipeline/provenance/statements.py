"""Code of each statement of a module, and the names that it uses.

Docstrings, comments, layout and annotations that nothing reads when the program runs do not count. Names are
collected for each statement of the module: a function, a class, an assignment. A name counts even where it is
one of several things that could be meant.
"""

import ast
import builtins
import hashlib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from facegear.pipeline.provenance.syntax import (
    NAMED_MODULE,
    POSSIBLE_NAME,
    WHOLE_MODULE,
    Function,
    Import,
    Part,
    Walk,
    find_imports,
    is_guard,
    is_in_packages,
    says_nothing,
)

BUILTINS = frozenset(dir(builtins)) | {
    *("__file__", "__name__", "__doc__", "__path__", "__spec__", "__package__"),
}
"""Names that every module has."""


@dataclass(frozen=True)
class Statement:
    """One statement of a module.

    - names: names that it binds
    - code: hash of its syntax tree
    - uses: names that it uses, with the attributes behind those of imports (`module.function`)
    - imports: imports inside it
    - runs: whether it may do more than bind its names when the module is imported
    - signature, signature_uses: the same of the annotations of a function's arguments
    """

    names: tuple[str, ...]
    code: str
    uses: tuple[str, ...]
    imports: tuple[Import, ...] = ()
    runs: bool = False
    signature: str = ""
    signature_uses: tuple[str, ...] = ()


@dataclass(frozen=True)
class Source:
    """A module: its statements, and what it imports of the packages when it is imported itself."""

    statements: tuple[Statement, ...]
    imports: tuple[Import, ...]


def read_source(text: bytes, module: str, is_package: bool) -> Source:
    """Parse a module into its statements, each with a hash of its code and the names that it uses.

    Docstrings, the body of `if TYPE_CHECKING`, and `if __name__ == ...` are left out.

    Parameters
    ----------
    text : bytes
        Its text.
    module : str
        Its dotted name, from which relative imports count.
    is_package : bool
        Whether it is the `__init__` of a package.

    Returns
    -------
    Source
        Statements in their order, and imports from the packages that run when the module is imported.
    """
    package = module if is_package else module.rpartition(".")[0]
    walk = Walk(package)
    imports: list[Import] = []
    parts: list[tuple[ast.stmt, Part]] = []
    for_checkers: set[str] = set()
    for statement in ast.parse(text).body:
        if isinstance(statement, ast.Import | ast.ImportFrom):
            imports += find_imports(statement, package)
        elif is_guard(statement, "TYPE_CHECKING"):
            for inner in ast.walk(statement):
                for_checkers |= {name for name, *_ in find_imports(inner, package)}
            parts += [(inner, walk.collect(inner)) for inner in getattr(statement, "orelse", [])]
        elif not is_guard(statement, "__name__") and not says_nothing(statement):
            parts.append((statement, walk.collect(statement)))
    for statement, part in parts:
        if not isinstance(statement, Function):
            imports += part.imports
    scope = _Scope(
        {name for statement, part in parts for name in _names(statement, part)},
        {name for name, module, _ in imports if is_in_packages(module)},
        {name: (module, attribute) for name, module, attribute in imports if not is_in_packages(module)},
        for_checkers,
    )
    statements = tuple(_statement(statement, part, scope, walk) for statement, part in parts)
    package_imports = [binding for binding in imports if is_in_packages(binding[1])]
    return Source(statements, tuple(dict.fromkeys(package_imports)))


@dataclass(frozen=True)
class _Scope:
    """Names of a module, by where they come from.

    - bound: names that its statements bind
    - package_names: names that imports from the packages bind
    - foreign: module and attribute of each name that other imports bind
    - for_checkers: names that are imported for type checkers alone
    """

    bound: set[str]
    package_names: set[str]
    foreign: Mapping[str, tuple[str, str]]
    for_checkers: set[str]

    def counted_uses(self, part: Part) -> tuple[str, ...]:
        """Return the names used by a part that may lead to code of the packages, sorted.

        Dotted names stay dotted for imports and are cut to their first part for names of the module. A
        name that nothing explains becomes WHOLE_MODULE.
        """
        local = {name for name, *_ in part.imports}
        counted_names = set()
        for use in part.uses:
            name = use.removeprefix(POSSIBLE_NAME)
            root = name.partition(".")[0]
            if use[0] in (WHOLE_MODULE, NAMED_MODULE) or root in self.package_names or root in local:
                counted_names.add(name)
            elif root in self.bound:
                counted_names.add(root)
            elif not (
                use[0] == POSSIBLE_NAME
                or root in part.bound
                or root in BUILTINS
                or root in self.foreign
                or root in self.for_checkers
            ):
                counted_names.add(WHOLE_MODULE)
        return tuple(sorted(counted_names))

    def code(self, part: Part) -> str:
        """Return the hash (16 hexadecimal digits) of a part's code and of the origin of each name from
        other libraries.
        """
        roots = {use.removeprefix(POSSIBLE_NAME).partition(".")[0] for use in part.uses}
        origins = [f"{name} {self.foreign[name]}" for name in sorted(roots & self.foreign.keys())]
        return hashlib.sha256("\n".join([*origins, *part.code]).encode()).hexdigest()[:16]


def _statement(statement: ast.stmt, part: Part, scope: _Scope, walk: "Walk") -> Statement:
    """Return the Statement of a syntax node, given its part and the scope of the module."""
    signature = Part()
    if isinstance(statement, Function):
        signature = walk.collect_annotations(statement)
    return Statement(
        tuple(sorted(_names(statement, part))),
        scope.code(part),
        scope.counted_uses(part),
        tuple(dict.fromkeys(part.imports)),
        _runs(statement, scope),
        scope.code(signature) if signature.code else "",
        scope.counted_uses(signature),
    )


def _names(statement: ast.stmt, part: Part) -> set[str]:
    """Return the names that a statement of the module binds, or changes as `table[key] = value` does."""
    match statement:
        case ast.FunctionDef() | ast.AsyncFunctionDef() | ast.ClassDef():
            return {statement.name}
        case ast.Assign(targets=targets):
            pass
        case ast.AnnAssign(target=target) | ast.AugAssign(target=target):
            targets = [target]
        case _:
            return part.bound
    return {inner.id for target in targets for inner in ast.walk(target) if isinstance(inner, ast.Name)}


def _runs(statement: ast.stmt, scope: _Scope) -> bool:
    """Whether a statement may do more than bind its names when the module is imported.

    It may if a default value, decorator or assigned value calls code of the packages, or if it is no
    definition.
    """
    if isinstance(statement, Function):
        defaults = [*statement.args.defaults, *statement.args.kw_defaults]
        is_changed = _calls_package_code(statement.decorator_list, scope, decorates=True)
        return is_changed or _calls_package_code(defaults, scope)
    if isinstance(statement, ast.ClassDef):
        return bool(statement.keywords) or _calls_package_code(
            statement.decorator_list, scope, decorates=True
        )
    if isinstance(statement, ast.Assign | ast.AnnAssign):
        targets = statement.targets if isinstance(statement, ast.Assign) else [statement.target]
        if all(isinstance(target, ast.Name | ast.Tuple) for target in targets):
            return _calls_package_code([statement.value], scope)
    return True


def _calls_package_code(nodes: Iterable[ast.expr | None], scope: _Scope, decorates: bool = False) -> bool:
    """Whether one of the expressions calls a name of the module or of the packages.

    With `decorates` an expression itself counts as called, as a decorator without parentheses is.
    """
    for node in nodes:
        if node is None:
            continue
        callees = [inner.func for inner in ast.walk(node) if isinstance(inner, ast.Call)]
        for function in [*callees, *([node] if decorates and not isinstance(node, ast.Call) else [])]:
            root: ast.expr = function
            while isinstance(root, ast.Attribute | ast.Call | ast.Subscript):
                root = root.func if isinstance(root, ast.Call) else root.value
            if isinstance(root, ast.Name) and (root.id in scope.bound or root.id in scope.package_names):
                return True
    return False
