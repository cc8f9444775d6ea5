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
    """Write versions, config slice, fingerprint, machine, time and the checksum of every input and output.

    Inputs are named as the folder of the manifest counts them. `rebuild`: command that makes a target again;
    it is stored with the folder of the outputs behind it and lacks only the name of a file.
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
    """Versions of Python and of those of LIBRARIES that were imported."""
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
    """The manifest of a stored file if the file is up to date, else None.

    It is if its stage ran with the same slice of the config and the same code, on inputs that are the same
    files now and up to date themselves. `needs` and `code` give slice and stage fingerprint of a rule; None
    for a rule that they do not know. The bytes of the file itself are left to its reader.
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
    """The readable manifest that covers a file; None where its folder cannot be read."""
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
    """A command line for a shell, to which only the target has to be added.

    `directory`: what `--directory` named, None without that option. With it all paths are absolute, so that
    the command works in any folder; without it they count from the current folder. `config`: values of
    `--config`.
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
    """A value as Snakemake reads it from its command line, which is YAML."""
    return value if isinstance(value, str) else json.dumps(value)
