"""Run tests on kernels that watch addresses and undefined behaviour: `python building/sanitize.py TESTS`."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import kernels

COPIED = ("tests", "validation", "config", "conftest.py", "pyproject.toml")
"""What the tests need beside the package."""


def make_tree(tree: Path) -> None:
    """Make a checkout of links and copies, into which the kernels are installed."""
    shutil.rmtree(tree, ignore_errors=True)
    parts = tree / "facegear" / "_kernels"
    parts.mkdir(parents=True)
    for path in (kernels.ROOT / "facegear").iterdir():
        if path.name not in ("_kernels", "__pycache__"):
            (tree / "facegear" / path.name).symlink_to(path)
    for name in ("__init__.py", "src"):
        (parts / name).symlink_to(kernels.ROOT / "facegear" / "_kernels" / name)
    for name in COPIED:
        path = kernels.ROOT / name
        copy = shutil.copytree if path.is_dir() else shutil.copy
        copy(path, tree / name)


def find_libraries(compiler: str) -> list[str]:
    """Return the libraries that Python must load first, or calls of the C library would not be watched."""
    asked = ("libasan.so", "libstdc++.so")
    print_name = [[compiler, f"-print-file-name={name}"] for name in asked]
    return [
        subprocess.run(one, capture_output=True, text=True, check=True).stdout.strip() for one in print_name
    ]


def main(arguments: list[str]) -> int:
    """Compile, then run pytest with the arguments; return its exit code."""
    compiler = shutil.which("g++")
    if compiler is None:
        print("The sanitizers are those of g++, which is not installed here", file=sys.stderr)
        return 1
    os.environ["CXX"] = compiler
    folder = kernels.ROOT / "build" / f"{sys.implementation.cache_tag}-sanitize"
    tree = folder / "tree"
    make_tree(tree)
    kernels.build(folder, tree, "-DKERNELS_SANITIZE=ON")
    watched = {
        "LD_PRELOAD": " ".join(find_libraries(compiler)),
        "ASAN_OPTIONS": "detect_leaks=0",  # Python leaves memory to the end of the process
        "UBSAN_OPTIONS": "print_stacktrace=1",
        "PYTHONMALLOC": "malloc",
        "PYTHONPATH": str(tree),
    }
    command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", *arguments]
    return subprocess.run(command, cwd=tree, env={**os.environ, **watched}, check=False).returncode


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
