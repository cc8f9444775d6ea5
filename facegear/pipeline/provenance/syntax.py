"""Walk through a statement: its code without what says nothing, and the names that stand in it."""

import ast
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

PACKAGES = ("facegear", "paper", "validation")
"""The library and, in a checkout, what stands beside it."""
WHOLE_MODULE = "*"
"""Use of anything in the module itself."""
NAMED_MODULE = "="
"""Before the name of a module that is imported by its name as text."""
POSSIBLE_NAME = "?"
"""Before a word that may be a name."""
DYNAMIC = frozenset(("globals", "locals", "vars", "eval", "exec", "compile", "__import__"))
"""Functions by which code reaches names that it does not spell."""
UNREAD = frozenset(
    {
        *("property", "cached_property", "staticmethod", "classmethod", "cache", "lru_cache"),
        *("contextmanager", "overload", "wraps", "abstractmethod"),
    }
)
"""Decorators of the standard library that do not read the annotations of a function."""
FIELDS = {
    kind: tuple(name for name in kind._fields if name not in ("ctx", "type_comment", "kind"))
    for kind in vars(ast).values()
    if isinstance(kind, type) and issubclass(kind, ast.AST)
}
"""Fields of each kind of syntax node that affect what code does."""
Import = tuple[str, str, str]
"""Name that an import binds, module, and name in the module (empty for the module itself)."""
Function = ast.FunctionDef | ast.AsyncFunctionDef
SCOPES = (ast.Lambda, ast.ListComp, ast.SetComp, ast.DictComp, ast.GeneratorExp)
"""Kinds of expressions with a scope of their own."""


def is_in_packages(module: str) -> bool:
    """Whether a module belongs to the packages.

    Parameters
    ----------
    module : str
        Dotted name.

    Returns
    -------
    bool
        True if it lies in one of `PACKAGES`.
    """
    return module.partition(".")[0] in PACKAGES


def find_imports(node: ast.AST, package: str) -> Iterator[Import]:
    """Yield what an import binds, one tuple a name; nothing for a node that is no import.

    Parameters
    ----------
    node : ast.AST
        Any node.
    package : str
        Dotted name of the package of its module, from which relative imports count.

    Yields
    ------
    tuple of str
        Bound name (``*`` for all, empty for the submodule of ``import a.b``), module, and name in the
        module (empty for the module itself).
    """
    if isinstance(node, ast.Import):
        for alias in node.names:
            if alias.asname:
                yield alias.asname, alias.name, ""
            else:
                yield alias.name.partition(".")[0], alias.name.partition(".")[0], ""
                if "." in alias.name:
                    yield "", alias.name, ""
    elif isinstance(node, ast.ImportFrom):
        parents = package.split(".")
        base = parents[: len(parents) - node.level + 1] if node.level else []
        module = ".".join([*base, *([node.module] if node.module else [])])
        for alias in node.names:
            yield alias.asname or alias.name, module, alias.name


def says_nothing(statement: ast.stmt) -> bool:
    """Whether a statement is a docstring or `pass`.

    Parameters
    ----------
    statement : ast.stmt
        The statement.

    Returns
    -------
    bool
        True if it does nothing.
    """
    match statement:
        case ast.Expr(ast.Constant()) | ast.Pass():
            return True
    return False


def is_guard(statement: ast.stmt, name: str) -> bool:
    """Whether a statement is `if TYPE_CHECKING` or `if __name__ == ...`.

    Parameters
    ----------
    statement : ast.stmt
        The statement.
    name : str
        `TYPE_CHECKING` or `__name__`.

    Returns
    -------
    bool
        True if the condition is this name, or a comparison with it.
    """
    if not isinstance(statement, ast.If):
        return False
    test = statement.test.left if isinstance(statement.test, ast.Compare) else statement.test
    return name in (getattr(test, "id", ""), getattr(test, "attr", ""))


@dataclass
class Part:
    """Code and names of one statement, as `Walk` collects them.

    - code: kinds of its syntax nodes, with names and values, in their order; equal lists mean equal
      code
    - uses: dotted names that it reads (a.b.c), and marks WHOLE_MODULE, NAMED_MODULE and POSSIBLE_NAME
    - bound: names that it binds, in any scope
    - imports: imports from the packages in it
    """

    code: list[str] = field(default_factory=list)
    uses: set[str] = field(default_factory=set)
    bound: set[str] = field(default_factory=set)
    imports: list[Import] = field(default_factory=list)


class Walk:
    """Walk through the syntax trees of statements of a module in `package`; the methods write into
    `part`.
    """

    def __init__(self, package: str) -> None:
        self.package = package
        self.part = Part()
        self.in_class = False

    def collect(self, statement: ast.stmt) -> Part:
        """Return the code of a statement without docstrings and comments, and the names that it binds
        and uses.

        Parameters
        ----------
        statement : ast.stmt
            The statement.

        Returns
        -------
        Part
            Its code and names; a new one for each call.
        """
        self.part = part = Part()
        self.visit(statement)
        return part

    def collect_annotations(self, function: Function) -> Part:
        """Return code and names of the annotations of a function's arguments.

        Parameters
        ----------
        function : Function
            The function.

        Returns
        -------
        Part
            Their code and names.
        """
        self.part = part = Part()
        self._visit_annotations(function)
        return part

    def visit(self, node: ast.AST) -> None:
        """Record a syntax node and all nodes inside it, by the method that METHODS gives for its kind,
        or field by field.

        Parameters
        ----------
        node : ast.AST
            The node.
        """
        kind = type(node)
        method = METHODS.get(kind)
        if method is not None:
            method(self, node)
            return
        self.part.code.append(kind.__name__)
        for name in FIELDS[kind]:
            value = getattr(node, name, None)
            if isinstance(value, ast.AST):
                self.visit(value)
            elif isinstance(value, list):
                self._visit_list(value)
            else:
                self.part.code.append(repr(value))

    def _visit_list(self, values: Sequence[object]) -> None:
        """Record a list of nodes and plain values, without statements that have no effect."""
        self.part.code.append("[")
        for value in values:
            if isinstance(value, ast.AST):
                if not (isinstance(value, ast.stmt) and says_nothing(value)):
                    self.visit(value)
            else:
                self.part.code.append(repr(value))
        self.part.code.append("]")

    def _visit_name(self, node: ast.Name) -> None:
        """Record a name as used or as bound."""
        self.part.code.append(node.id)
        if isinstance(node.ctx, ast.Load):
            self._use(node.id)
        else:
            self.part.bound.add(node.id)

    def _visit_attribute(self, node: ast.Attribute) -> None:
        """Record a dotted name such as a.b.c as one use; behind an expression that is no name, visit
        that expression.
        """
        chain: list[str] = []
        root: ast.expr = node
        while isinstance(root, ast.Attribute):
            chain.append(root.attr)
            root = root.value
        self.part.code.append("." + ".".join(chain))
        if isinstance(root, ast.Name):
            self.part.code.append(root.id)
            self._use(".".join([root.id, *reversed(chain)]))
        else:
            self.visit(root)

    def _use(self, name: str) -> None:
        """Record the use of a dotted name; a function of DYNAMIC or `sys.modules` uses the whole
        module.
        """
        if name in DYNAMIC or name == "sys.modules" or name.startswith("sys.modules."):
            self.part.uses.add(WHOLE_MODULE)
        self.part.uses.add(name)

    def _visit_call(self, node: ast.Call) -> None:
        """Record a call. `import_module("package.module")` uses that module; with a computed name it
        uses the whole module.
        """
        if "import_module" in (getattr(node.func, "id", ""), getattr(node.func, "attr", "")):
            match node.args:
                case [ast.Constant(str(module))] if is_in_packages(module):
                    self.part.uses.add(f"{NAMED_MODULE}{module}")
                case _:
                    self.part.uses.add(WHOLE_MODULE)
        self.part.code.append("Call")
        self.visit(node.func)
        self._visit_list(node.args)
        self._visit_list(node.keywords)

    def _visit_constant(self, node: ast.Constant) -> None:
        """Record a literal value."""
        self.part.code.append(repr(node.value))

    def _visit_import(self, node: ast.Import | ast.ImportFrom) -> None:
        """Record an import, from these packages as a dependency, else as a bound name."""
        for binding in find_imports(node, self.package):
            self.part.code.append(repr(binding))
            if is_in_packages(binding[1]):
                self.part.imports.append(binding)
            else:
                self.part.bound.add(binding[0])

    def _visit_if(self, node: ast.If) -> None:
        """Record a condition; the body of `if TYPE_CHECKING` never runs and is left out."""
        if is_guard(node, "TYPE_CHECKING"):
            self._visit_list(node.orelse)
            return
        self.part.code.append("If")
        self.visit(node.test)
        self._visit_list(node.body)
        self._visit_list(node.orelse)

    def _visit_annotated(self, node: ast.AnnAssign) -> None:
        """Record an annotated assignment; a field of a class counts with its annotation, other variables
        without.
        """
        self.part.code.append("AnnAssign")
        self.visit(node.target)
        if self.in_class:
            self._visit_annotation(node.annotation)
        if node.value:
            self.visit(node.value)

    def _visit_annotation(self, node: ast.expr) -> None:
        """Record an annotation; every word of a string in it is a possible name, as it may name a type
        or be a `Literal`.
        """
        self.visit(node)
        for inner in ast.walk(node):
            if isinstance(inner, ast.Constant) and isinstance(inner.value, str):
                self.part.uses |= {f"{POSSIBLE_NAME}{word}" for word in re.findall(r"[\w.]+", inner.value)}

    def _visit_annotations(self, node: Function) -> None:
        """Record the annotations of a function's arguments, not of its result."""
        for argument in _arguments(node.args):
            if argument.annotation:
                self.part.code.append(argument.arg)
                self._visit_annotation(argument.annotation)

    def _visit_class(self, node: ast.ClassDef) -> None:
        """Record a class with decorators, bases, keywords and body; its fields count with their
        annotations.
        """
        self.part.code.append(f"class {node.name}")
        self.part.bound.add(node.name)
        for part in (node.decorator_list, node.bases, node.keywords):
            self._visit_list(part)
        outer, self.in_class = self.in_class, True
        self._visit_list(node.body)
        self.in_class = outer

    def _visit_function(self, node: Function) -> None:
        """Record a function with decorators, arguments and body.

        Names that the body binds are local and count as no use of the module, unless declared `global`.
        Annotations count only if a decorator outside UNREAD may read them.
        """
        self.part.code.append(f"{type(node).__name__} {node.name}")
        self.part.bound.add(node.name)
        self._visit_list(node.decorator_list)
        if any(_last_name(decorator) not in UNREAD for decorator in node.decorator_list):
            self._visit_annotations(node)
        self._visit_signature(node.args)
        outer, outer_class = self.part, self.in_class
        self.in_class = False
        self.part = part = Part(code=outer.code, imports=outer.imports)
        part.bound |= {argument.arg for argument in _arguments(node.args)}
        self._visit_list(node.body)
        self.part, self.in_class = outer, outer_class
        local_names = _local_names(node)
        outer.uses |= {use for use in part.uses if use.partition(".")[0] not in local_names}
        outer.bound |= part.bound

    def _visit_lambda(self, node: ast.Lambda) -> None:
        """Record a lambda; its arguments are bound names."""
        self.part.code.append("lambda")
        self._visit_signature(node.args)
        self.part.bound |= {argument.arg for argument in _arguments(node.args)}
        self.visit(node.body)

    def _visit_signature(self, node: ast.arguments) -> None:
        """Record the arguments of a function with their kinds and defaults."""
        self.part.code.append(f"{len(node.posonlyargs)} {node.vararg is not None} {len(node.kwonlyargs)}")
        self.part.code += [argument.arg for argument in _arguments(node)]
        for default in (*node.defaults, *node.kw_defaults):
            if default is None:
                self.part.code.append("-")
            else:
                self.visit(default)

    def _visit_caught(self, node: ast.ExceptHandler) -> None:
        """Record an except clause: type, body, and the name that it binds."""
        self.part.bound.add(node.name or "")
        self.part.code.append(f"except {node.name}")
        if node.type:
            self.visit(node.type)
        self._visit_list(node.body)

    def _visit_pattern(self, node: ast.MatchAs | ast.MatchStar | ast.MatchMapping) -> None:
        """Record a pattern of a match statement; the name that it captures is bound."""
        name = node.rest if isinstance(node, ast.MatchMapping) else node.name
        self.part.bound.add(name or "")
        self.part.code.append(f"{type(node).__name__} {name}")
        for child in ast.iter_child_nodes(node):
            self.visit(child)


METHODS: Mapping[type, Callable[..., None]] = {
    ast.Name: Walk._visit_name,
    ast.Attribute: Walk._visit_attribute,
    ast.Call: Walk._visit_call,
    ast.Constant: Walk._visit_constant,
    ast.Import: Walk._visit_import,
    ast.ImportFrom: Walk._visit_import,
    ast.If: Walk._visit_if,
    ast.AnnAssign: Walk._visit_annotated,
    ast.ClassDef: Walk._visit_class,
    ast.FunctionDef: Walk._visit_function,
    ast.AsyncFunctionDef: Walk._visit_function,
    ast.Lambda: Walk._visit_lambda,
    ast.ExceptHandler: Walk._visit_caught,
    ast.MatchAs: Walk._visit_pattern,
    ast.MatchStar: Walk._visit_pattern,
    ast.MatchMapping: Walk._visit_pattern,
}
"""Method of Walk that records each kind of node; other kinds are recorded field by field."""


def _last_name(decorator: ast.expr) -> str:
    """Return the last part of a decorator's dotted name, such as `cache` of `functools.cache(...)`;
    empty if it has none.
    """
    node = decorator.func if isinstance(decorator, ast.Call) else decorator
    return str(getattr(node, "attr", getattr(node, "id", "")))


def _arguments(node: ast.arguments) -> list[ast.arg]:
    """Return all arguments of a signature, variadic ones last."""
    variadic = [argument for argument in (node.vararg, node.kwarg) if argument]
    return [*node.posonlyargs, *node.args, *node.kwonlyargs, *variadic]


def _local_names(function: Function) -> set[str]:
    """Return the names that a function binds in its own scope: arguments, assignments, inner functions
    and classes.

    Names declared `global` or `nonlocal` are not among them; lambdas and comprehensions have scopes of
    their own.
    """
    names = {argument.arg for argument in _arguments(function.args)}
    elsewhere: set[str] = set()
    todo: list[ast.AST] = [*function.body]
    while todo:
        node = todo.pop()
        if isinstance(node, Function | ast.ClassDef):
            names.add(node.name)
        elif isinstance(node, ast.Global | ast.Nonlocal):
            elsewhere.update(node.names)
        elif isinstance(node, ast.Name) and not isinstance(node.ctx, ast.Load):
            names.add(node.id)
        elif not isinstance(node, SCOPES):
            todo += ast.iter_child_nodes(node)
    return names - elsewhere
