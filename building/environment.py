"""Prepare `.venv` for `make`: `python building/environment.py`.

An environment that is there is kept with all that it holds, whoever made it. It gets pip where it has none.
It is made anew only where its Python cannot be started any more. What no lock file names is listed with the
command that removes it, since only its user knows whether that is left of an older version.
"""

import re
import subprocess
import sys
from importlib.metadata import distributions
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
FOLDER = ROOT / ".venv"
PYTHON = FOLDER / "bin" / "python"
OLDEST = (3, 11)
"""Oldest Python, as `requires-python` in pyproject.toml."""
UNLOCKED = {"facegear", "pip", "setuptools", "wheel"}
"""Packages that `make` puts there, or venv, without a lock file."""


def starts(*arguments: object) -> bool:
    """Return whether a command can be started and succeeds."""
    try:
        return subprocess.run([*map(str, arguments)], capture_output=True, check=False).returncode == 0
    except OSError:
        return False


def make_environment() -> None:
    """Make the environment, or mend the one that is there."""
    if not starts(PYTHON, "-c", ""):
        if FOLDER.exists():
            print("The Python of .venv cannot be started: the environment is made anew.", flush=True)
        if subprocess.run([sys.executable, "-m", "venv", "--clear", FOLDER], check=False).returncode:
            raise SystemExit(f"{sys.executable} makes no environment: `make PYTHON=...` names another Python")
    elif not starts(PYTHON, "-m", "pip", "--version"):
        print("There is no pip in .venv: it is installed.", flush=True)
        if not starts(PYTHON, "-m", "ensurepip", "--default-pip"):
            raise SystemExit("The Python of .venv has no ensurepip: install pip into it, or remove .venv")


def check_environment() -> None:
    """Exit where this Python is too old, and list the packages that no lock file names."""
    if sys.version_info < OLDEST:
        found, oldest = (".".join(map(str, version[:2])) for version in (sys.version_info, OLDEST))
        raise SystemExit(
            f"The Python of .venv is {found}, and {oldest} or newer is needed: `rm -r .venv`, then "
            f"`make PYTHON=python{oldest}`"
        )
    names = {re.sub(r"[-_.]+", "-", found.metadata["Name"]).lower() for found in distributions()}
    if left := sorted(names - UNLOCKED - locked_names()):
        print(
            f"No lock file names {len(left)} packages of .venv: {' '.join(left)}. They are kept; "
            f"`.venv/bin/pip uninstall {' '.join(left)}` removes what an older version left."
        )


def locked_names() -> set[str]:
    """Return the names of the packages in all lock files."""
    texts = (path.read_text(encoding="utf-8") for path in ROOT.glob("requirements*.lock"))
    return {name.lower() for text in texts for name in re.findall(r"(?m)^([A-Za-z0-9_.-]+)==", text)}


if __name__ == "__main__":
    if sys.argv[1:] == ["--check"]:
        check_environment()
    else:
        make_environment()
