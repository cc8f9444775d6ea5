"""Build backend (PEP 517): scikit-build-core, with zig as compiler where a machine has none.

An editable install is a path, in which Snakemake finds its plugin, and its kernels lie beside their sources.
"""

import base64
import hashlib
import tempfile
import zipfile
from pathlib import Path

import kernels
from scikit_build_core import build as skbuild
from scikit_build_core.build import (
    build_sdist,
    get_requires_for_build_sdist,
    prepare_metadata_for_build_editable,
    prepare_metadata_for_build_wheel,
)

__all__ = [
    "build_editable",
    "build_sdist",
    "build_wheel",
    "get_requires_for_build_editable",
    "get_requires_for_build_sdist",
    "get_requires_for_build_wheel",
    "prepare_metadata_for_build_editable",
    "prepare_metadata_for_build_wheel",
]
Settings = dict[str, list[str] | str] | None


def get_requires_for_build_wheel(config_settings: Settings = None) -> list[str]:
    """Return what the build needs beside the backend: CMake, ninja and a compiler, where they are missing."""
    compiler = [] if kernels.compiler_is_installed() else ["ziglang>=0.15"]
    return [*skbuild.get_requires_for_build_wheel(config_settings), *compiler]


get_requires_for_build_editable = get_requires_for_build_wheel


def build_wheel(
    wheel_directory: str, config_settings: Settings = None, metadata_directory: str | None = None
) -> str:
    """Build the wheel, and return its file name."""
    with tempfile.TemporaryDirectory() as folder:
        kernels.choose_compiler(Path(folder))
        return skbuild.build_wheel(wheel_directory, config_settings, metadata_directory)


def build_editable(
    wheel_directory: str, config_settings: Settings = None, metadata_directory: str | None = None
) -> str:
    """Build the kernels beside their sources and the wheel that names this folder; return its file name."""
    kernels.build_in_place()
    with tempfile.TemporaryDirectory() as folder:
        name = skbuild.build_editable(folder, config_settings, metadata_directory)
        keep_path_alone(Path(folder) / name, Path(wheel_directory) / name)
    return name


def keep_path_alone(wheel: Path, result: Path) -> None:
    """Write the editable wheel without its import hook, which would go before PYTHONPATH."""
    record, rows = "", []
    with zipfile.ZipFile(wheel) as source, zipfile.ZipFile(result, "w", zipfile.ZIP_DEFLATED) as target:
        for name in source.namelist():
            content = source.read(name)
            if name.endswith(".dist-info/RECORD"):
                record = name
                continue
            if "/" not in name and name.endswith(".py"):
                continue
            if name.endswith(".pth"):
                lines = content.decode().splitlines(keepends=True)
                content = "".join(line for line in lines if not line.startswith("import ")).encode()
            digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
            rows.append(f"{name},sha256={digest},{len(content)}")
            target.writestr(source.getinfo(name), content)
        target.writestr(record, "\n".join([*rows, f"{record},,", ""]))
