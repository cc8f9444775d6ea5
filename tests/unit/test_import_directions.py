"""The pipeline's packages import only what comes before them, and no workflow engine."""

import ast
from functools import cache
from graphlib import TopologicalSorter
from pathlib import Path
from statistics import median

import pytest

pytestmark = pytest.mark.xdist_group("import_directions")  # a module is parsed once a process
PACKAGE = Path(__file__).parents[2] / "facegear"
FOUNDATION = {
    *("arrays", "by_content", "errors", "harmonics", "io", "number_format"),
    *("progress", "quantities", "rigid_body", "ties", "_kernels"),
}
MAY_IMPORT = {
    "arrays": set(),
    "by_content": set(),
    "errors": set(),
    "number_format": set(),
    "progress": set(),
    "quantities": set(),
    "rigid_body": {"arrays"},
    "ties": {"arrays"},
    "io": {"errors"},
    "harmonics": {"arrays"},
    "schema": set(),
    "teeth": set(),
    "meshing": set(),
    "sparse": set(),
    "contact": {"teeth", "meshing", "sparse"},
    "parts": {"teeth", "sparse", "contact"},
    "bearings": {"parts"},
    "casing": set(),
    "machine": {"teeth", "meshing", "parts", "bearings", "casing"},
    "motion": {"machine", "meshing"},
    "sharing": {"motion", "machine", "meshing"},
    "strength": {"teeth", "contact", "bearings", "machine", "motion", "sharing"},
    "lubrication": {"teeth", "contact"},
    "build": {
        *("schema", "teeth", "meshing", "contact", "parts", "bearings", "casing", "machine", "motion"),
        *("sharing", "strength", "lubrication"),
    },
    "exchange": {"schema", "build", "teeth", "meshing", "machine", "motion"},
    "studies": {
        *("schema", "build", "teeth", "meshing", "contact", "parts", "machine", "motion", "sharing"),
        *("strength", "lubrication"),
    },
    "new_machine": {
        *("schema", "build", "teeth", "meshing", "contact", "machine", "sharing", "strength"),
    },
    "report": {"schema", "build", "teeth", "meshing", "contact", "machine", "motion", "sharing"},
    "pipeline": {
        *(
            "schema",
            "build",
            "teeth",
            "meshing",
            "contact",
            "parts",
            "bearings",
            "casing",
            "machine",
            "motion",
        ),
        *("sharing", "strength", "lubrication", "studies", "exchange", "report"),
    },
    "door": {"schema", "build", "machine", "exchange", "studies", "pipeline"},
}
"""Packages from the foundation up: each names only packages above it in this list."""
TENANTS = ("paper", "validation")
"""Packages beside the library that use it; no module of the library, nor the other tenant, imports them."""
MODULES = sorted(PACKAGE.rglob("*.py"))


@cache
def parsed(module: Path) -> tuple[frozenset[str], frozenset[str], frozenset[str]]:
    """Read a module's text: modules that it imports, names that it takes from them, and its types
    NDArray[...].
    """
    modules, taken, types = set(), set(), set()
    for node in ast.walk(ast.parse(module.read_text())):
        if isinstance(node, ast.Import):
            modules |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            modules.add(node.module)
            taken |= {f"{node.module}.{alias.name}" for alias in node.names}
        elif isinstance(node, ast.Subscript) and getattr(node.value, "id", "") == "NDArray":
            types.add(ast.unparse(node))
    return frozenset(modules), frozenset(taken), frozenset(types)


def imported(module: Path, inside: bool = False) -> frozenset[str]:
    """Modules that a module imports, anywhere in its text; `inside`: and what it takes from them."""
    modules, taken, _ = parsed(module)
    return modules | taken if inside else modules


@pytest.mark.parametrize("package", sorted(MAY_IMPORT))
def test_data_flows_one_way(package):
    allowed = MAY_IMPORT[package] | FOUNDATION | {package}
    for module in MODULES:
        inside = module.relative_to(PACKAGE).with_suffix("").parts
        if inside[0] != package:
            continue
        reached = {name.split(".")[1] for name in imported(module) if name.startswith("facegear.")}
        assert reached <= allowed, module


def test_packages_import_only_what_stands_before_them_in_the_table():
    names = list(MAY_IMPORT)
    for number, name in enumerate(names):
        assert MAY_IMPORT[name] <= set(names[:number]), name


def test_every_package_stands_in_the_table():
    above = {"__init__", "__main__", "_kernels", "checking", "gearbox", "questions", "system_check"}
    found = {path.relative_to(PACKAGE).with_suffix("").parts[0] for path in MODULES}
    assert found == {*MAY_IMPORT, *above}


def test_sections_of_the_config_import_no_physics():
    for module in MODULES:
        if module.relative_to(PACKAGE).parts[0] == "schema":
            reached = {name.split(".")[1] for name in imported(module) if name.startswith("facegear.")}
            assert reached <= {*FOUNDATION, "schema"} - {"_kernels"}, module


def test_no_module_reaches_itself_by_imports_not_even_inside_a_package():
    names = {".".join(path.relative_to(PACKAGE.parent).with_suffix("").parts): path for path in MODULES}
    reached = {name: imported(path, True) & set(names) for name, path in names.items()}
    assert len(tuple(TopologicalSorter(reached).static_order())) == len(MODULES)


def test_what_config_stands_on_names_quantities_and_no_keys_of_the_config():
    below = MAY_IMPORT["build"] - {"schema"} | {"harmonics"}
    for module in MODULES:
        if module.relative_to(PACKAGE).parts[0] in below:
            assert not {"facegear.errors.ConfigError", "facegear.errors.ConfigErrors"} & imported(
                module, True
            )


def test_no_stage_validates_what_was_validated_with_the_config():
    for module in MODULES:
        if module.relative_to(PACKAGE).parts[0] in ("pipeline",):
            assert "facegear.schema.base.parse" not in imported(module, True), module


@pytest.mark.parametrize("tenant", TENANTS)
def test_the_library_never_imports_its_tenants(tenant):
    others = [path for name in TENANTS if name != tenant for path in (PACKAGE.parent / name).rglob("*.py")]
    assert others
    for module in [*MODULES, *others]:
        assert not any(name.split(".")[0] == tenant for name in imported(module)), module


DOOR = ("facegear.gearbox", "facegear.door", "facegear.pipeline.results")


def test_nothing_stands_on_the_door():
    for module in MODULES:
        inside = module.relative_to(PACKAGE).parts
        if inside[0] not in ("__init__.py", "gearbox.py", "door") and "results" not in inside:
            taken = imported(module)
            assert not any(name.startswith(DOOR) for name in taken), module


def test_no_module_of_the_package_knows_the_workflow_engine():
    for module in MODULES:
        assert not any(name.split(".")[0] == "snakemake" for name in imported(module)), module


def test_matplotlib_is_only_known_to_what_draws_with_it():
    """A figure is described as data; the scales of colours are matplotlib's."""
    drawing = {
        PACKAGE / "report" / "figures" / f"{name}.py"
        for name in ("colours", "draw_matplotlib", "matplotlib_marks")
    }
    for module in set(MODULES) - drawing:
        assert not any(name.split(".")[0] == "matplotlib" for name in imported(module)), module


def test_array_types_have_their_names_from_one_module():
    named = {"np.float64", "np.int64", "np.bool_", "np.complex128", "Any"}
    for module in set(MODULES) - {PACKAGE / "arrays.py"}:
        assert not {f"NDArray[{name}]" for name in named} & parsed(module)[2], module


MOST_MODULES, MOST_LINES, LEAST_MEDIAN = 490, 450, 110
"""Limits of the package: modules, lines of the longest one, median of their lines.

Modules were 430 when the rooms were made; 60 more are for bearings, casing and other kinds of teeth.
"""


def test_modules_are_few_and_neither_shredded_nor_overlong():
    lines = {module: len(module.read_text().splitlines()) for module in MODULES}
    assert len(MODULES) <= MOST_MODULES
    assert max(lines.values()) <= MOST_LINES, max(lines, key=lambda module: lines[module])
    assert median(lines.values()) >= LEAST_MEDIAN


def test_imports_inside_functions_are_few_and_say_why():
    found = {}
    for module in MODULES:
        lines = module.read_text().splitlines()
        for function in ast.walk(ast.parse("\n".join(lines))):
            if isinstance(function, ast.FunctionDef):
                inner = (node for node in ast.walk(function) if isinstance(node, ast.Import | ast.ImportFrom))
                found |= {(module, node.lineno): lines[node.lineno - 2 : node.lineno] for node in inner}
    assert len(found) <= 30
    assert [place for place, lines in found.items() if "#" not in "".join(lines)] == []
