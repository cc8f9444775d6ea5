"""A stage or its figures from files: read what it takes, call it, write what it gives.

This module names no stage: the fingerprint of a rule holds it and what that rule's stage reaches alone.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from facegear.blas_threads import one_blas_thread
from facegear.config.arguments import typed_arguments
from facegear.config.keys import keys_named
from facegear.io.files import write_part
from facegear.pipeline.stage import From, Stage, load

if TYPE_CHECKING:
    from facegear.stages.outcome import Outcome

Paths = Mapping[str, str | Sequence[str]]


def read_all(upstream: Mapping[str, From], paths: Paths, stages: Mapping[str, Stage]) -> dict[str, Any]:
    """Arguments from the files of earlier stages, those of `stages`; one without a file is left out.

    Raises CorruptFile if one is missing, altered or lacks something.
    """
    contents: dict[str, Any] = {}
    for name, source in upstream.items():
        file, given = stages[source.stage].files[source.file], paths[name]
        if source.each or file.each:
            contents[name] = [file.read(Path(path)) for path in given]
        elif given:
            contents[name] = file.read(Path(str(given)))
    return contents


def write_stage(stage: Stage, content: Mapping[str, Any], paths: Paths) -> list[Path]:
    """Write what a stage gave, each file in the format that its ending names; returns the paths."""
    written = []
    for name, file in stage.files.items():
        part = load(file.view)(content[file.of]) if file.view else content[name]
        for path, target in zip(paths[name], part, strict=True) if file.each else [(paths[name], part)]:
            write_part(str(path), target)
            written.append(Path(str(path)))
    return written


def call(stage: Stage, given: Mapping[str, Any], **more: Any) -> "Outcome":
    """The stage with arguments `given`, plain values of the config as the sections that it asks for.

    What it refuses is named by the key of the config. It runs on one thread of BLAS, in a job as through the
    Python door.
    """
    function = load(stage.function)
    with keys_named(), one_blas_thread():
        outcome: Outcome = function(**typed_arguments(function, given), **more)
    return outcome
