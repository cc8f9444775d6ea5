"""The record that lies beside a stage's outputs and says what made them."""

import os
import platform
import shlex
import sys
from collections.abc import Iterable, Mapping
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from facegear.io import documents
from facegear.io.checksums import sha256

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
