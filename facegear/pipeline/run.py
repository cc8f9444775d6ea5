"""A stage or its figures from files: read what it takes, call it, write what it gives.

This module names no stage: the fingerprint of a rule holds it and the modules of that rule's stage alone.
"""

from collections.abc import Mapping, Sequence
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

from facegear.blas_threads import one_blas_thread
from facegear.config.arguments import typed_arguments
from facegear.config.keys import keys_named
from facegear.io.files import write_part
from facegear.pipeline.stage import MACHINE_INPUTS, From, Stage, load

if TYPE_CHECKING:
    from facegear.config.machines import MachineInputs
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
        arguments = typed_arguments(function, with_machine(stage, given))
        outcome: Outcome = function(**arguments, **more)
    return outcome


def with_machine(stage: Stage, arguments: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return arguments with the machine, or its inputs, in place of the values that decide it.

    Parameters
    ----------
    stage : Stage
        Row of the table of stages.
    arguments : mapping
        Arguments from the config and from earlier stages by name.

    Returns
    -------
    mapping
        The arguments that the stage's function takes.

    Raises
    ------
    ConfigError
        If pinions or torques do not fit the layout.
    NotConverged
        If the loaded position of the bodies is not found.
    """
    if not stage.machine:
        return arguments
    inputs = machine_inputs(arguments)
    names = {field.name for field in fields(inputs)}
    other_arguments = {name: value for name, value in arguments.items() if name not in names}
    return {**other_arguments, stage.machine: inputs.build() if stage.machine == "machine" else inputs}


def machine_inputs(arguments: Mapping[str, Any]) -> "MachineInputs":
    """Return the inputs of the machine among the arguments of a stage.

    Parameters
    ----------
    arguments : mapping
        Arguments from the config and from earlier stages by name.

    Returns
    -------
    MachineInputs
        Everything that decides what the machine is.
    """
    kind = load(MACHINE_INPUTS)
    names = {field.name for field in fields(kind)}
    inputs_by_name = {name: value for name, value in arguments.items() if name in names}
    inputs: MachineInputs = kind(**typed_arguments(kind, inputs_by_name))
    return inputs
