"""Two trees of the code, each with an environment of its own: the present one and that of a commit."""

import hashlib
import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from validation.growth.measure import ONE_THREAD

ROOT = Path(__file__).parents[2]
CACHE = ROOT / "results" / "ratios"
"""Folder of environments and built packages of earlier commits; they are used again until it is removed."""
LOCK = "requirements-run.lock"
"""Libraries that a run needs, with their hashes; the environment of a commit is made from its own."""
EXTENSION = Path("facegear", "_kernels")
"""Sources of the compiled extension; a commit that has them is built before it is measured."""
READY = "ready"
"""Name of the empty file that is written last into an environment or package."""


@dataclass(frozen=True)
class Tree:
    """Code of one commit, and how to run it.

    Attributes
    ----------
    sources
        Folder of the whole repository at that commit.
    package
        Folder in which Python finds `facegear`: the sources, or where the built package is.
    python
        Interpreter of the environment.
    """

    sources: Path
    package: Path
    python: Path

    @property
    def variables(self) -> dict[str, str]:
        """Variables of the environment of its processes, all libraries on one thread.

        Bytecode is kept, whatever the shell says, as it is where a package is installed.
        """
        shell = {name: text for name, text in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
        return {**shell, **ONE_THREAD, "NUMBA_NUM_THREADS": "1", "PYTHONPATH": str(self.package)}

    def command(self, script: Path, *arguments: str) -> list[str]:
        """Return the command that runs a script, whichever tree it is from, with this code.

        Parameters
        ----------
        script : Path
            The script.
        *arguments : str
            Its arguments.

        Returns
        -------
        list of str
            The command.
        """
        return [str(self.python), str(script), *arguments]


def present() -> Tree:
    """Return the tree that this file is in, with the environment that runs it.

    Returns
    -------
    Tree
        The tree.
    """
    return Tree(ROOT, ROOT, Path(sys.executable))


@contextmanager
def checked_out(commit: str) -> Iterator[Tree]:
    """Check a commit of this repository out into a folder of its own and make its environment.

    Parameters
    ----------
    commit : str
        Any name of the commit that git knows.

    Yields
    ------
    Tree
        The tree; its folder is removed afterwards, its environment is kept for the next time.
    """
    with TemporaryDirectory() as folder:
        sources = Path(folder) / "sources"
        git = ["git", "-C", str(ROOT), "worktree"]
        subprocess.run([*git, "add", "--quiet", "--detach", str(sources), commit], check=True)
        try:
            python = environment(sources)
            yield Tree(sources, build_package(sources, python), python)
        finally:
            subprocess.run([*git, "remove", "--force", str(sources)], check=True)


def environment(sources: Path, cache: Path = CACHE) -> Path:
    """Make the environment that a commit's own lock file names, unless it is there already.

    Parameters
    ----------
    sources : Path
        Folder of the commit's files.
    cache : Path
        Folder of all environments.

    Returns
    -------
    Path
        Its interpreter.
    """
    version = sys.version.encode()
    texts = [(sources / name).read_bytes() for name in (LOCK, "pyproject.toml")]
    folder = cache / "environments" / _digest(version, *texts)
    python = folder / "bin" / "python"
    if not (folder / READY).exists():
        print(f"installing {LOCK} of the commit into {folder}", file=sys.stderr, flush=True)
        _uv("venv", "--clear", "--python", sys.executable, str(folder))
        locked = ("--require-hashes", "-r", str(sources / LOCK))
        _uv("pip", "install", "--python", str(python), "--compile-bytecode", *locked)
        (folder / READY).touch()
    return python


def build_package(sources: Path, python: Path, cache: Path = CACHE) -> Path:
    """Build the package of a commit that has a compiled extension, unless it is there already.

    Parameters
    ----------
    sources : Path
        Folder of the commit's files, checked out by git.
    python : Path
        Interpreter that the package is for.
    cache : Path
        Folder of all packages.

    Returns
    -------
    Path
        Folder in which Python finds the package: that of the sources where nothing is compiled.
    """
    if not (sources / EXTENSION).exists():
        return sources
    commit = subprocess.check_output(["git", "-C", str(sources), "rev-parse", "HEAD"])
    folder = cache / "packages" / _digest(commit, str(python).encode())
    if not (folder / READY).exists():
        print(f"building the extension of the commit into {folder}", file=sys.stderr, flush=True)
        _uv("pip", "install", "--python", str(python), "--no-deps", "--target", str(folder), str(sources))
        (folder / READY).touch()
    return folder


def _uv(*arguments: str) -> None:
    subprocess.run([sys.executable, "-m", "uv", *arguments, "--quiet"], check=True)


def _digest(*parts: bytes) -> str:
    return hashlib.sha256(b"\0".join(parts)).hexdigest()[:16]
