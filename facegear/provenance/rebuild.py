"""The command that makes a stored file again, as the run that made it was started."""

import json
import os
import shlex
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

DEFAULT_SNAKEFILES = ("Snakefile", "workflow/Snakefile")
"""Where Snakemake looks by itself, in the working directory."""


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
