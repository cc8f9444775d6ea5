"""Statements that others reach by the names that they use, over all modules of the packages."""

import hashlib
import os
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from facegear.pipeline.provenance.sources import source_of
from facegear.pipeline.provenance.statements import Source, Statement
from facegear.pipeline.provenance.syntax import NAMED_MODULE, WHOLE_MODULE, Import, is_in_packages

BESIDE = ("*.j2", "src/**/*.cpp", "src/**/*.hpp")
"""Files that count with the package that they lie in: templates, and sources of compiled kernels."""


class Node(NamedTuple):
    """Something that may count.

    - kind: `statement` that something uses, `signature` of a function, `run` for a statement that counts
      because its module is imported, `loaded` for an imported module, `whole` for all statements of a module
    - module: dotted name
    - number: of the statement in its module
    """

    kind: str
    module: str
    number: int = 0


@dataclass(frozen=True, eq=False)
class _Module:
    """A module that was read: its statements, and by name the numbers of the statements and the imports
    that bind it.
    """

    source: Source
    statements: dict[str, list[int]]
    imports: dict[str, list[Import]]
    is_package: bool
    is_script: bool = False


class Closure:
    """Search over the packages for the statements that other statements reach through the names that
    they use.

    It is a graph search. Its nodes are statements and modules (`Node`); an edge leads from a statement
    to each definition that one of its names may mean. Files are read when first met; nothing is
    imported or run.

    Parameters
    ----------
    root : str
        Folder that holds the packages.
    """

    def __init__(self, root: str) -> None:
        self.root = Path(root)
        self._modules: dict[str, _Module | None] = {}
        self._edges: dict[Node, tuple[Node, ...]] = {}
        self._states: dict[str, tuple[int, int]] = {}
        self._beside: dict[str, bytes] = {}

    @property
    def is_current(self) -> bool:
        """Whether all files that were read have the size and time of change that they had then; False
        if one is gone.
        """
        try:
            return all(_state(path) == state for path, state in self._states.items())
        except OSError:
            return False

    def find_functions(self, functions: Sequence[str]) -> list[Node]:
        """Find the nodes at which a search for some functions begins.

        Parameters
        ----------
        functions : sequence of str
            `module:name` (a function, class or constant), or a module alone, which counts whole.

        Returns
        -------
        list of Node
            Their statements, and for each a node `signature` with the annotations of its arguments.
        """
        entry_nodes: list[Node] = []
        for reference in functions:
            module, _, name = reference.partition(":")
            nodes = [*self._resolve_chain(module, [name] if name else [])]
            entry_nodes += nodes
            entry_nodes += [Node("signature", *node[1:]) for node in nodes if node.kind == "statement"]
        return entry_nodes

    def add_script(self, path: Path) -> list[Node]:
        """Read a script that belongs to no package, and return the node at which a search for it
        begins.

        Parameters
        ----------
        path : Path
            The script.

        Returns
        -------
        list of Node
            One node `whole`: all statements of the script.
        """
        if str(path) not in self._modules:
            self._modules[str(path)] = self._read(path, "", is_script=True)
        return [Node("whole", str(path))]

    def search(self, nodes: Iterable[Node]) -> set[Node]:
        """Find all nodes that some nodes reach, directly or through others, by depth-first search;
        these nodes are included.

        Parameters
        ----------
        nodes : iterable of Node
            Where the search begins.

        Returns
        -------
        set of Node
            All nodes, in no order.
        """
        closure_nodes = set(nodes)
        todo = [*closure_nodes]
        while todo:
            node = todo.pop()
            edges = self._edges.get(node)
            if edges is None:
                edges = self._edges[node] = tuple(dict.fromkeys(self._direct_successors(node)))
            for successor in edges:
                if successor not in closure_nodes:
                    closure_nodes.add(successor)
                    todo.append(successor)
        return closure_nodes

    def digest(self, nodes: Iterable[Node]) -> str:
        """Compute the hash (SHA-256, cut) of the code of all nodes, and of templates and kernel sources
        of their packages.

        Parameters
        ----------
        nodes : iterable of Node
            All nodes that count, as `search` returns them; their order does not matter.

        Returns
        -------
        str
            Sixteen hexadecimal digits.
        """
        digest = hashlib.sha256()
        packages: set[str] = set()
        for kind, name, number in sorted(nodes):
            module = self._modules[name]
            if module is None or kind == "loaded":
                continue
            if kind in ("statement", "whole") and not module.is_script:
                packages.add(name if module.is_package else name.rpartition(".")[0])
            if kind == "whole":
                continue
            statement = module.source.statements[number]
            module_name = "" if module.is_script else name
            code = statement.signature if kind == "signature" else statement.code
            digest.update(f"{module_name} {statement.names} {code}\n".encode())
        for package in sorted(packages):
            digest.update(self._beside_hash(package))
        return digest.hexdigest()[:16]

    def names(self, nodes: Iterable[Node]) -> set[str]:
        """Return the names that the statements among some nodes bind, which are functions, classes and
        constants.

        Parameters
        ----------
        nodes : iterable of Node
            Nodes, as `search` returns them.

        Returns
        -------
        set of str
            What the statements bind, as ``module:name``.
        """
        bound_names: set[str] = set()
        for kind, name, number in nodes:
            module = self._modules[name]
            if module and kind in ("statement", "run"):
                bound_names |= {f"{name}:{bound}" for bound in module.source.statements[number].names}
        return bound_names

    def modules(self, nodes: Iterable[Node]) -> set[str]:
        """Return the modules to which some nodes belong.

        Parameters
        ----------
        nodes : iterable of Node
            Nodes, as `search` returns them.

        Returns
        -------
        set of str
            Dotted names of the modules that exist.
        """
        return {node.module for node in nodes if self._modules[node.module]}

    def _beside_hash(self, package: str) -> bytes:
        """Return the hash of the templates and kernel sources (BESIDE) in a package's folder, computed
        once.
        """
        if package not in self._beside:
            folder, digest = self.root.joinpath(*package.split(".")), hashlib.sha256()
            for path in sorted(path for pattern in BESIDE for path in folder.glob(pattern)):
                self._states[str(path)] = _state(str(path))
                digest.update(hashlib.sha256(path.read_bytes()).digest())
            self._beside[package] = digest.digest()
        return self._beside[package]

    def _direct_successors(self, node: Node) -> Iterator[Node]:
        """Yield the nodes to which one edge leads from a node.

        A statement leads to what its names mean and to the modules that its imports load; `whole` leads
        to all statements and imports of the module; `loaded` leads to what runs when the module is
        imported.
        """
        module = self._module(node.module)
        if module is None:
            return
        if node.kind == "loaded":
            yield from self._load_module(node.module, module)
            return
        yield Node("loaded", node.module)
        if node.kind == "whole":
            yield from (Node("statement", node.module, n) for n in range(len(module.source.statements)))
            for _, origin, attribute in module.source.imports:
                for target in self._resolve_chain(origin, [attribute] if attribute else []):
                    if not (module.is_script and target.kind == "whole"):  # a script spells what it takes
                        yield target
            return
        statement = module.source.statements[node.number]
        uses = statement.signature_uses if node.kind == "signature" else statement.uses
        for use in uses:
            yield from self._resolve_use(node.module, module, statement, use)
        yield from self._load_imports(statement.imports)
        yield from (Node("whole", origin) for _, origin, name in module.source.imports if name == "*")

    def _load_module(self, name: str, module: _Module) -> Iterator[Node]:
        """Yield what runs when a module is imported: its parent packages, its imports, and statements
        with effects (`run`).
        """
        parents = name.split(".") if not module.is_script else []
        yield from (Node("loaded", ".".join(parents[:n])) for n in range(1, len(parents)))
        yield from self._load_imports(module.source.imports)
        for number, statement in enumerate(module.source.statements):
            if statement.runs:
                yield Node("run", name, number)

    def _load_imports(self, imports: Iterable[Import]) -> Iterator[Node]:
        """Yield a node `loaded` for each module that imports load, submodules taken from a package
        included.
        """
        for _, origin, name in imports:
            yield Node("loaded", origin)
            package = self._module(origin)
            if package and package.is_package and name and self._module(f"{origin}.{name}"):
                yield Node("loaded", f"{origin}.{name}")

    def _resolve_use(self, name: str, module: _Module, statement: Statement, use: str) -> Iterator[Node]:
        """Yield the nodes to which a name that a statement uses may refer: definitions, imports or
        whole modules.

        `name` is the module of the statement. `use` is a dotted name, WHOLE_MODULE, or NAMED_MODULE
        before a module's name.
        """
        if use == WHOLE_MODULE:
            yield Node("whole", name)
        elif use.startswith(NAMED_MODULE):
            if not module.is_script:
                yield Node("whole", use.removeprefix(NAMED_MODULE))
        else:
            root, *rest = use.split(".")
            yield from (Node("statement", name, number) for number in module.statements.get(root, ()))
            inner = [imported_name for imported_name in statement.imports if imported_name[0] == root]
            for _, origin, attribute in [*module.imports.get(root, ()), *inner]:
                yield from self._resolve_chain(origin, [attribute, *rest] if attribute else rest)

    def _resolve_chain(self, name: str, chain: list[str]) -> Iterator[Node]:
        """Yield the nodes that a dotted name, `chain` by its parts, means in the module `name`.

        Imports are followed from module to module. An empty chain, or one that is not found, yields the
        whole module.
        """
        if not is_in_packages(name):
            return
        module = self._module(name)
        if module is None:
            parent = name.rpartition(".")[0]
            if parent:  # a compiled module counts with the package that it lies in
                yield Node("whole", parent)
            return
        if not chain or chain[0] == "*":
            yield Node("whole", name)
            return
        first, rest = chain[0], chain[1:]
        numbers, imports = module.statements.get(first, ()), module.imports.get(first, ())
        if numbers or imports:
            yield from (Node("statement", name, number) for number in numbers)
            yield Node("loaded", name)
            for _, origin, attribute in imports:
                if (origin, attribute) == (name, first):  # a package that imports its own module
                    yield from self._resolve_chain(f"{name}.{first}", rest)
                else:
                    yield from self._resolve_chain(origin, [attribute, *rest] if attribute else rest)
        elif module.is_package and self._module(f"{name}.{first}"):
            yield from self._resolve_chain(f"{name}.{first}", rest)
        else:
            yield Node("whole", name)

    def _module(self, name: str) -> _Module | None:
        """Return the module of a dotted name, read when first asked for; None if the packages have no
        such file.
        """
        if name not in self._modules:
            base = self.root.joinpath(*name.split("."))
            alone, package = base.with_suffix(".py"), base / "__init__.py"
            path = next((path for path in (alone, package) if is_in_packages(name) and path.is_file()), None)
            self._modules[name] = self._read(path, name) if path else None
        return self._modules[name]

    def _read(self, path: Path, name: str, is_script: bool = False) -> _Module:
        """Read a module and index its statements and imports by the names that they bind."""
        self._states[str(path)] = _state(str(path))
        source = source_of(path, name)
        statements: dict[str, list[int]] = {}
        imports: dict[str, list[Import]] = {}
        for number, statement in enumerate(source.statements):
            for bound in statement.names:
                statements.setdefault(bound, []).append(number)
        for imported_name in source.imports:
            imports.setdefault(imported_name[0], []).append(imported_name)
        return _Module(source, statements, imports, path.name == "__init__.py", is_script)


def _state(path: str) -> tuple[int, int]:
    """Return size (bytes) and time of change (ns) of a file; a file with both unchanged is taken as
    unchanged.
    """
    status = os.stat(path)
    return status.st_size, status.st_mtime_ns
