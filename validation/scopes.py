"""Names of a module by the scope that binds them, with the places where they stand in its text.

`ast` says where a statement begins, but not where the name in it stands, and `symtable` says which scope
binds a name, but not where it is used. Tools that compare or change names need both.
"""

import ast
import re
from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import accumulate

from validation.formatted_strings import find_expressions

Function = ast.FunctionDef | ast.AsyncFunctionDef
Comprehension = ast.ListComp | ast.SetComp | ast.DictComp | ast.GeneratorExp


@dataclass(eq=False)
class Scope:
    """One scope of a module.

    - kind: `module`, `class`, `function`, `lambda` or `comprehension`
    - name: classes and functions around it and its own name, with dots; lambdas and comprehensions have that
      of the function around them
    - node: the node that opens the scope
    - parent: the scope around it, None for the module
    - bound: names that the scope binds
    - outside: names that a `global` or `nonlocal` statement binds elsewhere, with the word of the statement
    """

    kind: str
    name: str
    node: ast.AST
    parent: "Scope | None"
    bound: set[str] = field(default_factory=set)
    outside: dict[str, str] = field(default_factory=dict)

    def binding(self, name: str) -> "Scope | None":
        """Find the scope that binds a name which is used in this scope.

        Parameters
        ----------
        name
            The name.

        Returns
        -------
        Scope or None
            The scope; None for a name of Python itself.
        """
        scope: Scope | None = self
        if self.outside.get(name) == "global":
            while scope and scope.parent:
                scope = scope.parent
            return scope
        while scope:
            is_visible = scope is self or scope.kind != "class"
            if is_visible and name in scope.bound and name not in scope.outside:
                return scope
            scope = scope.parent
        return None


@dataclass(frozen=True, eq=False)
class Occurrence:
    """One place where a name stands.

    - name: the name
    - start: first byte of it in the module's text
    - scope: scope in which it stands
    - node: node that it belongs to
    - role: `name` of a variable, `attribute` behind a dot, `keyword` of a call or of a class pattern,
      `imported` behind `from ... import`
    - binds: whether the place binds the name
    """

    name: str
    start: int
    scope: Scope
    node: ast.AST
    role: str
    binds: bool


class Names:
    """Scopes and occurrences of all names of a module, in the order of its syntax tree.

    Parameters
    ----------
    source
        Text of the module.
    """

    def __init__(self, source: bytes) -> None:
        self.source = source
        self.starts = _line_starts(source)
        self.tree = ast.parse(source)
        self.parents = {child: node for node in ast.walk(self.tree) for child in ast.iter_child_nodes(node)}
        for node, parent in self.parents.items():
            if isinstance(node, ast.JoinedStr) and getattr(parent, "format_spec", None) is not node:
                self._place_fields(node)
        visitor = _Visitor(self)
        self.module = visitor.scope
        self.scopes = visitor.scopes
        self.occurrences = visitor.occurrences

    def start(self, node: ast.AST) -> int:
        """Return the first byte of a node in the text.

        Parameters
        ----------
        node
            A node with a position.

        Returns
        -------
        int
            Index of the byte.
        """
        return self.starts[node.lineno - 1] + node.col_offset  # type: ignore[attr-defined]

    def end(self, node: ast.AST) -> int:
        """Return the index behind the last byte of a node in the text.

        Parameters
        ----------
        node
            A node with a position.

        Returns
        -------
        int
            Index of the byte.
        """
        return self.starts[node.end_lineno - 1] + node.end_col_offset  # type: ignore[attr-defined]

    def _place_fields(self, formatted_string: ast.JoinedStr) -> None:
        """Give the expressions in an f-string their places; Python 3.11 gets some of them wrong."""
        begin = self.start(formatted_string)
        text = self.source[begin : self.end(formatted_string)].decode()
        expressions = list(find_expressions(text))
        values = _formatted(formatted_string)
        if len(expressions) != len(values):
            raise ValueError(f"line {formatted_string.lineno}: fields of an f-string cannot be told apart")
        for (at, expression), value in zip(expressions, values, strict=True):
            shift = begin + len(text[:at].encode())
            source = f"({expression}\n)".encode()
            starts = _line_starts(source)
            for old, new in zip(
                ast.walk(value.value), ast.walk(ast.parse(source, mode="eval").body), strict=True
            ):
                if isinstance(old, ast.expr | ast.keyword | ast.arg) and isinstance(new, type(old)):
                    start = starts[new.lineno - 1] + new.col_offset - 1 + shift
                    end = starts[(new.end_lineno or 1) - 1] + (new.end_col_offset or 0) - 1 + shift
                    old.lineno, old.col_offset = self._line(start)
                    old.end_lineno, old.end_col_offset = self._line(end)

    def _line(self, start: int) -> tuple[int, int]:
        line = bisect_right(self.starts, start)
        return line, start - self.starts[line - 1]


class _Visitor(ast.NodeVisitor):
    """Walk through a module that notes its scopes and names."""

    def __init__(self, names: Names) -> None:
        self.names = names
        self.scopes: list[Scope] = []
        self.occurrences: list[Occurrence] = []
        self.scope = self._open("module", "", names.tree, None)
        self.generic_visit(names.tree)

    def _open(self, kind: str, name: str, node: ast.AST, parent: Scope | None) -> Scope:
        scope = Scope(kind, name, node, parent)
        self.scopes.append(scope)
        return scope

    def _note(self, name: str, start: int, node: ast.AST, role: str = "name", binds: bool = True) -> None:
        text = name.encode()
        if self.names.source[start : start + len(text)] != text:
            raise ValueError(
                f"line {getattr(node, 'lineno', '?')}: {name} does not stand where it was looked for"
            )
        self.occurrences.append(Occurrence(name, start, self.scope, node, role, binds))
        if role == "name" and binds and name not in self.scope.outside:
            self.scope.bound.add(name)

    def _behind(self, word: str, name: str, start: int) -> int:
        """Index of the first byte of a name that follows a word, searched from `start` on."""
        pattern = rf"(?:{word})\s*({re.escape(name)})\b".encode()
        match = re.compile(pattern).search(self.names.source, start)
        if match is None:
            raise ValueError(f"{name} does not follow {word}")
        return match.start(1)

    def _visit_all(self, nodes: Sequence[ast.AST | None]) -> None:
        for node in nodes:
            if node is not None:
                self.visit(node)

    def visit_FunctionDef(self, node: ast.FunctionDef) -> None:
        """Note the name of a function, and what stands in it in a scope of its own."""
        self._visit_function(node)

    def visit_AsyncFunctionDef(self, node: ast.AsyncFunctionDef) -> None:
        """Note the name of a function, and what stands in it in a scope of its own."""
        self._visit_function(node)

    def _visit_function(self, node: Function) -> None:
        self._visit_all(node.decorator_list)
        self._note(node.name, self._behind("def", node.name, self.names.start(node)), node)
        signature = node.args
        arguments = all_arguments(signature)
        self._visit_all([*signature.defaults, *signature.kw_defaults])
        self._visit_all([argument.annotation for argument in arguments])
        self._visit_all([node.returns])
        self._enter("function", node.name, node, arguments, node.body)

    def visit_Lambda(self, node: ast.Lambda) -> None:
        """Note what stands in a lambda in a scope of its own."""
        self._visit_all([*node.args.defaults, *node.args.kw_defaults])
        self._enter("lambda", "", node, all_arguments(node.args), [node.body])

    def _enter(
        self, kind: str, name: str, node: ast.AST, arguments: list[ast.arg], body: Sequence[ast.AST]
    ) -> None:
        outer = self.scope
        self.scope = self._open(kind, f"{outer.name}.{name}".strip("."), node, outer)
        for statement in body:
            self._note_outside(statement)
        for argument in arguments:
            self._note(argument.arg, self.names.start(argument), argument)
        self._visit_all(body)
        self.scope = outer

    def _note_outside(self, node: ast.AST) -> None:
        """Note the `global` and `nonlocal` statements of a function before its names."""
        if isinstance(node, ast.Global | ast.Nonlocal):
            word = "global" if isinstance(node, ast.Global) else "nonlocal"
            self.scope.outside.update(dict.fromkeys(node.names, word))
        if not isinstance(node, Function | ast.Lambda | ast.ClassDef):
            for child in ast.iter_child_nodes(node):
                self._note_outside(child)

    def visit_ClassDef(self, node: ast.ClassDef) -> None:
        """Note the name of a class, and what stands in it in a scope of its own."""
        self._visit_all(node.decorator_list)
        self._note(node.name, self._behind("class", node.name, self.names.start(node)), node)
        self._visit_all([*node.bases, *node.keywords])
        self._enter("class", node.name, node, [], node.body)

    def _visit_comprehension(self, node: Comprehension) -> None:
        first = node.generators[0]
        self.visit(first.iter)
        outer = self.scope
        self.scope = self._open("comprehension", outer.name, node, outer)
        self.visit(first.target)
        self._visit_all(first.ifs)
        for generator in node.generators[1:]:
            self.visit(generator)
        self._visit_all([node.key, node.value] if isinstance(node, ast.DictComp) else [node.elt])
        self.scope = outer

    visit_ListComp = visit_SetComp = visit_DictComp = visit_GeneratorExp = _visit_comprehension

    def visit_NamedExpr(self, node: ast.NamedExpr) -> None:
        """Note the target of an assignment in an expression; a comprehension does not bind it."""
        inner = self.scope
        while self.scope.kind == "comprehension" and self.scope.parent:
            self.scope = self.scope.parent
        self.visit(node.target)
        self.scope = inner
        self.visit(node.value)

    def visit_Name(self, node: ast.Name) -> None:
        """Note a variable."""
        self._note(node.id, self.names.start(node), node, binds=not isinstance(node.ctx, ast.Load))

    def visit_Attribute(self, node: ast.Attribute) -> None:
        """Note what stands behind a dot."""
        self.visit(node.value)
        start = self.names.end(node) - len(node.attr.encode())
        self._note(node.attr, start, node, "attribute", not isinstance(node.ctx, ast.Load))

    def visit_keyword(self, node: ast.keyword) -> None:
        """Note the keyword of a call."""
        if node.arg is not None:
            self._note(node.arg, self.names.start(node), node, "keyword", False)
        self.visit(node.value)

    def visit_alias(self, node: ast.alias) -> None:
        """Note what an import binds, and the name that it takes from a module."""
        if isinstance(self.names.parents[node], ast.ImportFrom) and node.name != "*":
            self._note(node.name, self.names.start(node), node, "imported", False)
        if node.asname:
            self._note(node.asname, self.names.end(node) - len(node.asname.encode()), node)
        elif node.name != "*":
            self._note(node.name.partition(".")[0], self.names.start(node), node)

    def visit_ExceptHandler(self, node: ast.ExceptHandler) -> None:
        """Note the name of an error that is caught."""
        self._visit_all([node.type])
        if node.name and node.type:
            self._note(node.name, self._behind("as", node.name, self.names.end(node.type)), node)
        self._visit_all(node.body)

    def _visit_outside(self, node: ast.Global | ast.Nonlocal) -> None:
        for name in node.names:
            self._note(
                name,
                self._behind(r"global[^\n]*?|nonlocal[^\n]*?", name, self.names.start(node)),
                node,
                binds=False,
            )

    visit_Global = visit_Nonlocal = _visit_outside

    def visit_MatchAs(self, node: ast.MatchAs) -> None:
        """Note the name that a pattern binds."""
        self._visit_all([node.pattern])
        if node.name:
            self._note(node.name, self.names.end(node) - len(node.name.encode()), node)

    def visit_MatchStar(self, node: ast.MatchStar) -> None:
        """Note the name that takes the rest of a sequence."""
        if node.name:
            self._note(node.name, self.names.end(node) - len(node.name.encode()), node)

    def visit_MatchMapping(self, node: ast.MatchMapping) -> None:
        """Note the name that takes the rest of a mapping."""
        self._visit_all([*node.keys, *node.patterns])
        if node.rest:
            last = node.patterns[-1] if node.patterns else node
            start = self.names.end(last) if node.patterns else self.names.start(node)
            self._note(node.rest, self._behind(r"\*\*", node.rest, start), node)

    def visit_MatchClass(self, node: ast.MatchClass) -> None:
        """Note the attributes that a pattern compares."""
        self._visit_all([node.cls, *node.patterns])
        for name, pattern in zip(node.kwd_attrs, node.kwd_patterns, strict=True):
            before = self.names.source[: self.names.start(pattern)]
            match = re.search(rb"(\w+)\s*=\s*\(*\s*$", before)
            if match is None:
                raise ValueError(f"{name} does not stand before its pattern")
            self._note(name, match.start(1), node, "keyword", False)
            self.visit(pattern)


def all_arguments(signature: ast.arguments) -> list[ast.arg]:
    """Return all arguments of a function.

    Parameters
    ----------
    signature
        Node of its arguments.

    Returns
    -------
    list of ast.arg
        The nodes, in the order of the text.
    """
    variadic = [signature.vararg] if signature.vararg else []
    last = [signature.kwarg] if signature.kwarg else []
    return [*signature.posonlyargs, *signature.args, *variadic, *signature.kwonlyargs, *last]


def _line_starts(source: bytes) -> list[int]:
    return [0, *accumulate(len(line) for line in source.splitlines(keepends=True))]


def _formatted(formatted_string: ast.JoinedStr) -> list[ast.FormattedValue]:
    """Fields of an f-string in the order of the text, with those in format specifications."""
    fields = []
    for value in formatted_string.values:
        if isinstance(value, ast.FormattedValue):
            fields.append(value)
            if isinstance(value.format_spec, ast.JoinedStr):
                fields += _formatted(value.format_spec)
    return fields
