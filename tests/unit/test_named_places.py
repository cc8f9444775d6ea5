"""Files, folders, modules and functions that pages, docstrings and comments name are there."""

import ast
import json
import re
import subprocess
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

import facegear

ROOT = Path(__file__).parents[2]
FILES = [
    ROOT / line
    for line in subprocess.run(
        ["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True
    ).stdout.splitlines()
    if (ROOT / line).is_file()
]
PATHS = {path.relative_to(ROOT).as_posix() for path in FILES}
PLACES = PATHS | {folder.as_posix() for path in PATHS for folder in Path(path).parents}
NAMES = {Path(path).name for path in PATHS}
MODULES = {
    path.removesuffix(".py").replace("/", ".").removesuffix(".__init__")
    for path in PATHS
    if path.endswith(".py")
}
TOPS = "facegear|tests|validation|docs|config|building|workflow|examples|paper"
SOURCE = "py|hpp|cpp|smk|j2|css|js"
MADE_BY_THE_READER = re.findall(
    r"`([\w/]+\.(?:py|hpp))`, new", (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
)
"""Files that a recipe of CONTRIBUTING.md adds."""
NOT_STORED = {"docs/build", "docs/api", "config/own.yaml", *MADE_BY_THE_READER}
"""Paths that a command, a recipe or the reader makes."""
OF_OTHERS = {"plotly.js", "heyoka.py", "script.py", "model.hpp"}
"""Programs of others, a reader's script, and a header that the FMU's generator writes."""
OF_PAGES = {
    *("x_lower", "y_lower", "z_lower", "th_lower", "x_upper", "y_upper", "z_upper", "th_upper"),
    *("test_gear_ratio", "slurm_account", "slurm_partition", "cpu_time", "x86_64_v3", "vibratory_torque"),
    *("study_web_forces", "test_next_to_no_torque_against_a_ring_"),
}
"""Symbols of the theory page, options of other programs, and names that are made of parts."""


COMPILED = {path.stem for path in (ROOT / "facegear/_kernels/src/bindings").glob("*.cpp")}
"""Modules of the kernels, which are made by the build."""
OF_WORKFLOW = {"facegear.yaml", "facegear.lock"}
"""Files of a user's project."""
VARIABLES = {"facegear", "_kernels", "gearbox", "study", "sys", "tool", "module"}
"""Words that name compiled modules, objects of a reader's script, tables, or what another test checks."""
FILE_ENDS = {
    *(
        "py",
        "pyi",
        "cpp",
        "hpp",
        "js",
        "css",
        "html",
        "md",
        "txt",
        "LICENSE",
        "lock",
        "toml",
        "yaml",
        "cff",
        "json",
    ),
    *("csv", "tsv", "xml", "npz", "parquet", "zip", "partial", "inp", "msh", "vtu"),
}


class Text(NamedTuple):
    """A text for people, and the place where it begins."""

    file: str
    line: int
    text: str


def docstrings(node: ast.AST) -> Iterator[ast.Constant]:
    """Strings that stand alone in a module, a class, a function, or below an assignment in one."""
    for statement in getattr(node, "body", ()):
        if isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant):
            if isinstance(statement.value.value, str):
                yield statement.value
        elif isinstance(statement, ast.ClassDef | ast.FunctionDef):
            yield from docstrings(statement)


def code_and_texts(source: str) -> tuple[set[str], list[tuple[int, str]]]:
    """Words of a Python file's code, and its docstrings and comments with their lines."""
    lines, texts = source.splitlines(), []
    for constant in docstrings(ast.parse(source)):
        texts.append((constant.lineno, constant.value))
        lines[constant.lineno - 1 : constant.end_lineno] = [""] * (constant.end_lineno - constant.lineno + 1)
    for number, line in enumerate(lines):
        lines[number], mark, comment = line.partition("# ")
        if mark:
            texts.append((number + 1, comment))
    return set(re.findall(r"\w+", "\n".join(lines))), texts


@cache
def read_all() -> tuple[frozenset[str], tuple[Text, ...]]:
    """All words of the code, and all texts for people except those of tests and the history of versions."""
    words: set[str] = {part for path in PLACES for part in re.split(r"[/.]", path)}
    texts: list[Text] = []
    for path in FILES:
        name = path.relative_to(ROOT).as_posix()
        found: list[tuple[int, str]] = []
        if path.suffix in (".png", ".svg", ".zip", ".lock") or path.name in ("CHANGELOG.md", "LICENSE"):
            continue
        if path.suffix == ".py":
            new, found = code_and_texts(path.read_text(encoding="utf-8"))
            words |= new
        elif path.suffix in (".hpp", ".cpp"):
            source = path.read_text(encoding="utf-8")
            comments = list(re.finditer(r"//[^\n]*", source))
            words.update(re.findall(r"\w+", re.sub(r"//[^\n]*", "", source)))
            found = [(source[: match.start()].count("\n") + 1, match[0]) for match in comments]
        elif path.suffix == ".md":
            found = [(1, path.read_text(encoding="utf-8"))]
        elif path.suffix == ".ipynb":
            cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
            found = [(0, "".join(cell["source"])) for cell in cells]
        elif (
            path.suffix in (".smk", ".yaml", ".toml", ".json", ".csv", ".j2", ".js", ".css")
            or not path.suffix
        ):
            source = path.read_text(encoding="utf-8", errors="ignore")
            words.update(re.findall(r"\w+", source))
            stored = path.suffix in (".json", ".csv") or path.name.endswith(".min.js")
            found = [] if stored else [(1, source)]
        if "tests" not in path.relative_to(ROOT).parts:
            texts += [Text(name, line, text) for line, text in found]
    return frozenset(words), tuple(texts)


def offenders(pattern: str, is_there, code_blocks: bool = True) -> list[str]:
    """File, line and name of everything that a pattern finds in the texts and that is not there."""
    found = []
    for text in read_all()[1]:
        shown = (
            text.text
            if code_blocks
            else re.sub(r"(?s)```.*?```", lambda m: "\n" * m[0].count("\n"), text.text)
        )
        for match in re.finditer(pattern, shown):
            if not is_there(match):
                line = text.line + shown[: match.start()].count("\n")
                found.append(f"{text.file}:{line} {match[1]}")
    return found


def test_paths_from_the_top_exist():
    def is_there(match):
        path, after = match[1].rstrip("/"), match.string[match.end() : match.end() + 1]
        return (Path(path).parent.as_posix() if after and after in "*<{" else path) in PLACES | NOT_STORED

    assert offenders(rf"(?<![\w/.<-])((?:{TOPS})/[\w./-]*\w)", is_there) == []


def test_paths_of_sources_below_the_top_exist():
    def is_there(match):
        return match[1] in NOT_STORED or any(
            path.endswith(f"/{match[1]}") or path == match[1] for path in PATHS
        )

    assert offenders(rf"`((?:[\w-]+/)+[\w.-]+\.(?:{SOURCE}))`", is_there) == []


def test_bare_names_of_source_files_exist():
    def is_there(match):
        return match[1] in NAMES | OF_OTHERS | {Path(path).name for path in MADE_BY_THE_READER}

    assert offenders(rf"(?<![\w/.<>*{{}}-])(\w+\.(?:{SOURCE}))\b", is_there) == []


@cache
def defined_names(module: str) -> frozenset[str]:
    """Names that a module or a class in it defines or imports."""
    path = ROOT / module.replace(".", "/")
    source = path.with_suffix(".py") if path.with_suffix(".py").exists() else path / "__init__.py"
    names: set[str] = {"__file__"}
    for node in ast.walk(ast.parse(source.read_text(encoding="utf-8"))):
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            names.add(node.name)
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            names.add(node.id)
        elif isinstance(node, ast.alias):
            names.add((node.asname or node.name).partition(".")[0])
    return frozenset(names)


def is_defined(name: str) -> bool:
    """Whether a dotted name is a module, or a name in one."""
    parts = name.split(".")
    for count in range(len(parts), 0, -1):
        module = ".".join(parts[:count])
        if module in MODULES:
            return count == len(parts) or parts[count] in defined_names(module)
    return False


def test_dotted_names_of_the_library_exist():
    made = {path.removesuffix(".py").replace("/", ".") for path in MADE_BY_THE_READER}

    def is_there(match):
        name, first = match[1], match[1].split(".")[1]
        if first == "_kernels":
            return name.split(".")[2] in (*COMPILED, "PART")
        return is_defined(name) or name in made | OF_WORKFLOW or first in facegear.__all__

    assert offenders(r"(?<![\w./-])(facegear(?:\.[A-Za-z_]\w*)+)", is_there) == []


@cache
def config_words() -> frozenset[str]:
    """Keys of the config."""
    schema = json.loads((ROOT / "facegear/schema/config.schema.json").read_text(encoding="utf-8"))
    found: set[str] = set()

    def walk(node):
        if isinstance(node, dict):
            found.update(node.get("properties", {}))
        for inner in node.values() if isinstance(node, dict) else node if isinstance(node, list) else ():
            walk(inner)

    walk(schema)
    return frozenset(found)


def test_short_dotted_names_are_modules_keys_or_attributes():
    """`geometry.design` was a module before its package moved."""
    words, keys = read_all()[0], config_words()
    by_stem: dict[str, list[str]] = {}
    for module in MODULES:
        by_stem.setdefault(module.rpartition(".")[2], []).append(module)

    def is_there(match):
        first, *rest = match[1].split(".")
        if all(part in keys | {"upper", "lower"} for part in (first, *rest)) or rest[-1] in FILE_ENDS:
            return True
        if any(is_defined(".".join([module, *rest])) for module in by_stem.get(first, ())):
            return True
        return (first[0].isupper() or first in VARIABLES) and all(part in words for part in rest)

    pattern = r"`([a-zA-Z_]\w*(?:\.[a-zA-Z_]\w*)+)(?:\(\))?`"
    assert offenders(pattern, is_there, code_blocks=False) == []


def test_names_in_code_letters_exist():
    words = read_all()[0]

    def is_there(match):
        name = match[1]
        return name in words | OF_PAGES or name.endswith("_") or name.startswith("_")

    assert offenders(r"`(\w{3,}_\w+|[A-Z][a-z]+[A-Z]\w+)(?:\(\))?`", is_there, code_blocks=False) == []


def test_unit_tests_lie_in_folders_named_like_the_packages():
    folders = {Path(path).parent for path in PATHS if path.startswith("tests/unit/") and path.endswith(".py")}
    for folder in folders:
        assert (ROOT / "facegear" / folder.relative_to("tests/unit")).is_dir(), folder
