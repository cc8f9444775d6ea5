"""Libraries are declared where they are imported, and nothing else is installed for a run."""

import ast
import re
import sys
import tomllib
from pathlib import Path

from facegear.schema.yaml_file import read_yaml

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
EXTRAS = PROJECT["optional-dependencies"]
IMPORTED_AS = {"scikit-fem": "skfem", "ruamel.yaml": "ruamel"}
NOT_IMPORTED = {"snakemake", "snakemake-executor-plugin-slurm", "openpyxl"}
"""Programs that are run, and what pandas imports to write a workbook."""
BROUGHT = {"contourpy", "mpl_toolkits", "pydantic_core"}
"""Parts of matplotlib and pydantic, and what matplotlib requires to contour."""


def names(requirements):
    """Names of the libraries of a list of requirements, without the project's own extras."""
    found = {re.match(r"[A-Za-z0-9_.-]+", requirement)[0] for requirement in requirements}
    return found - {"facegear"}


def imported():
    """Top-level names of all libraries that a module of the package imports."""
    found = set()
    for path in (ROOT / "facegear").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                found |= {alias.name.split(".")[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom):
                found.add(str(node.module).split(".")[0])
    return found - set(sys.stdlib_module_names) - {"facegear"}


def test_the_package_imports_each_declared_library_and_no_other():
    parts = ("fe", "workflow", "cluster", "search", "excel", "exchange")
    declared = names(PROJECT["dependencies"]).union(*(names(EXTRAS[part]) for part in parts))
    assert imported() - BROUGHT == {IMPORTED_AS.get(name, name) for name in declared - NOT_IMPORTED}


def test_a_run_needs_no_mkl():
    for lock in ("requirements-run.lock", "requirements-cluster.lock"):
        assert not re.search(r"(?m)^(mkl|pypardiso|tbb|intel-openmp)==", (ROOT / lock).read_text())
    assert "pypardiso" in names(EXTRAS["benchmark"])


def test_the_conda_environment_of_jobs_holds_what_the_package_imports():
    given = read_yaml(ROOT / "workflow" / "envs" / "facegear.yaml")["dependencies"][-1]["pip"]
    wanted = names([*PROJECT["dependencies"], *EXTRAS["fe"], *EXTRAS["workflow"]]) - NOT_IMPORTED
    assert {name.replace(".", "-") for name in wanted} == {line.split("==")[0] for line in given}
