"""The record beside a stage's outputs: what made them, whether they are current, how to make them again."""

import json
import os
import platform
import shlex
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from facegear.io import documents
from facegear.io.atomic import MANIFEST_SUFFIX, sha256

LIBRARIES = ("numpy", "scipy", "scikit-fem", "gmsh", "meshio", "pandas", "snakemake")
"""Libraries whose versions a manifest names, as far as they were imported."""


def write_manifest(
    path: str | Path,
    outputs: Iterable[str | Path],
    inputs: Iterable[str | Path],
    params: Mapping[str, Any],
    rule: str,
    seconds: float,
    summary: str,
    rebuild: str,
) -> None:
    """Write the manifest of a stage's outputs, a JSON file: what made them, from which inputs, and how
    to make them again.

    It holds versions, slice of the config, fingerprint, machine, time, summary, and the SHA-256 of
    every input and output.

    Parameters
    ----------
    path : str or Path
        File to write.
    outputs : iterable of str or Path
        Files that the stage made.
    inputs : iterable of str or Path
        Files that it read; their paths are stored relative to the manifest's folder.
    params : mapping
        Slice of the config as `needs`, and the fingerprint of the stage as `code`.
    rule : str
        Name of the rule.
    seconds : float
        Time that the stage took, s.
    summary : str
        Summary of the results in one line.
    rebuild : str
        Command that makes a target again; it is stored with the folder of the outputs behind it and
        lacks only the name of a file.
    """
    documents.write(
        path,
        {
            "rule": rule,
            "summary": summary,
            "made_at": datetime.now(UTC).isoformat(timespec="seconds"),
            "seconds": round(seconds, 3),
            "versions": versions(),
            "machine": {"system": platform.platform(), "cpu": platform.machine(), "cores": os.cpu_count()},
            "params": {key: value for key, value in params.items() if key != "code"},
            "code": params.get("code"),
            "rebuild": f"{rebuild} {shlex.quote(f'{Path(path).parent}/')}",
            "inputs": {os.path.relpath(name, Path(path).parent): sha256(name) for name in inputs},
            "files": {
                Path(output).name: {"sha256": sha256(output), "bytes": Path(output).stat().st_size}
                for output in outputs
            },
        },
    )


def versions() -> dict[str, str]:
    """Return the versions of Python and of the libraries of LIBRARIES that were imported.

    Returns
    -------
    dict of str to str
        Version by name, `python` first.
    """
    versions = {"python": platform.python_version()}
    for name in LIBRARIES:
        module = name.replace("scikit-fem", "skfem")
        if module in sys.modules or name == "numpy":
            try:
                versions[name] = version(name)
            except PackageNotFoundError:
                continue
    return versions


Manifest = Mapping[str, Any]


def current_manifest(
    path: Path, needs: Callable[[str], Mapping[str, Any] | None], code: Callable[[str], str]
) -> Manifest | None:
    """Return the manifest of a stored file if the file is up to date.

    A file is up to date if its stage ran with the same slice of the config and the same code, on inputs
    that have not changed and are up to date themselves. The bytes of the file itself are left to its
    reader.

    Parameters
    ----------
    path : Path
        The stored file.
    needs : callable
        Function of the rule's name that returns its current slice of the config; None for a rule that
        it does not know.
    code : callable
        Function of the rule's name that returns the current fingerprint of its stage.

    Returns
    -------
    Manifest or None
        The manifest; None if the file is out of date or has none.
    """
    manifest = _manifest(path)
    if manifest is None:
        return None
    try:
        current_needs = needs(manifest["rule"])
        if current_needs is None or manifest["params"].get("needs") != current_needs:
            return None
        if code(manifest["rule"]) not in manifest["code"].split("."):
            return None
        inputs = {path.parent / name: digest for name, digest in manifest["inputs"].items()}
    except (KeyError, TypeError, AttributeError):
        return None
    try:
        are_inputs_current = all(name.is_file() and sha256(name) == digest for name, digest in inputs.items())
    except OSError:
        return None
    made_inputs = [name for name in inputs if are_inputs_current and _manifest(name) is not None]
    return (
        manifest
        if are_inputs_current and all(current_manifest(name, needs, code) for name in made_inputs)
        else None
    )


def _manifest(path: Path) -> Manifest | None:
    """Return the manifest (parsed JSON) beside a file that lists it; None if there is none or its
    folder cannot be read.
    """
    try:
        candidates = sorted(path.parent.glob(f"*{MANIFEST_SUFFIX}"))
    except OSError:
        return None
    for candidate in candidates:
        try:
            manifest = json.loads(candidate.read_text(encoding="utf-8"))
            if path.name in manifest["files"]:
                return manifest
        except (OSError, ValueError, KeyError, TypeError):
            continue
    return None


DEFAULT_SNAKEFILES = ("Snakefile", "workflow/Snakefile")
"""Paths at which Snakemake looks by itself, in the working directory."""


def rebuild_command(
    snakefile: str | Path,
    configfiles: Sequence[str | Path],
    config: Mapping[str, Any],
    directory: str | Path | None,
) -> str:
    """Compose the command line of Snakemake that makes one file again; only the file's name has to be
    added at its end.

    Parameters
    ----------
    snakefile : str or Path
        Snakefile of the run.
    configfiles : sequence of str or Path
        Config files of the run.
    config : mapping
        Values of `--config` by key.
    directory : str, Path or None
        Folder that `--directory` named, None without that option. With it all paths are absolute, so
        that the command works in any folder; without it they are relative to the current folder.

    Returns
    -------
    str
        The command line.
    """
    folder = Path.cwd()
    path_text = os.path.relpath if directory is None else os.path.abspath
    words = ["snakemake", "--cores", "2"]
    if directory is not None or not any(
        (folder / name).is_file() and os.path.samefile(folder / name, snakefile)
        for name in DEFAULT_SNAKEFILES
    ):
        words += ["--snakefile", path_text(snakefile)]
    if directory is not None:
        words += ["--directory", str(folder)]
    if configfiles:
        words += ["--configfile", *(path_text(file) for file in configfiles)]
    if config:
        words += ["--config", *(f"{key}={_plain(value)}" for key, value in config.items())]
    return shlex.join([*words, "--force"])


def _plain(value: Any) -> str:
    """Return a value as text that Snakemake reads from its command line, which is YAML."""
    return value if isinstance(value, str) else json.dumps(value)
