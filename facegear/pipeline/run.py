"""Run a stage or its figures from files: read the inputs, call the function, write the results.

This module names no stage: the fingerprint of a rule holds it and what that rule's stage reaches alone.
"""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import fields
from pathlib import Path
from typing import Any

from threadpoolctl import threadpool_limits

from facegear.build.machine import MachineInputs
from facegear.io.files import write_part
from facegear.pipeline.arguments import typed_arguments
from facegear.pipeline.outcome import Outcome
from facegear.pipeline.stage import MACHINE_INPUTS, From, Stage, load
from facegear.schema.base import keys_named

Paths = Mapping[str, str | Sequence[str]]


def read_all(upstream: Mapping[str, From], paths: Paths, stages: Mapping[str, Stage]) -> dict[str, Any]:
    """Read the arguments from the files of earlier stages; an argument without a file is left out.

    Parameters
    ----------
    upstream : Mapping[str, From]
        Source of each argument by name: an earlier stage and one of its files.
    paths : Paths
        Path, or list of paths, of each argument by name; an empty one leaves the argument out.
    stages : Mapping[str, Stage]
        Rows of the table of stages by name.

    Returns
    -------
    dict[str, Any]
        Tables, arrays or records by name of the argument; a list of them where a source stands for
        several files.

    Raises
    ------
    CorruptFile
        If a file is missing, altered or lacks something.
    """
    contents: dict[str, Any] = {}
    for name, source in upstream.items():
        file, argument_paths = stages[source.stage].files[source.file], paths[name]
        if source.each_wildcards or file.each_text:
            contents[name] = [file.read(Path(path)) for path in argument_paths]
        elif argument_paths:
            contents[name] = file.read(Path(str(argument_paths)))
    return contents


def write_stage(stage: Stage, content: Mapping[str, Any], paths: Paths) -> list[Path]:
    """Write the content of a stage, each file in the format that its ending names.

    Parameters
    ----------
    stage : Stage
        Row of the table of stages.
    content : Mapping[str, Any]
        Content of each file by name, as `Outcome.content`; files with a `view` are made from the
        content of another.
    paths : Paths
        Path, or list of paths, of each file by name.

    Returns
    -------
    list[Path]
        The paths.
    """
    written_paths = []
    for name, file in stage.files.items():
        part = load(file.view)(content[file.of]) if file.view else content[name]
        for path, target in zip(paths[name], part, strict=True) if file.each_text else [(paths[name], part)]:
            write_part(str(path), target)
            written_paths.append(Path(str(path)))
    return written_paths


def call(stage: Stage, arguments_given: Mapping[str, Any], **extra_arguments: Any) -> "Outcome":
    """Run a stage; plain values of the config become the sections that its function takes.

    A value that the stage refuses is named by its key in the config. It runs on one thread of BLAS, in
    a job as through the Python interface.

    Parameters
    ----------
    stage : Stage
        Row of the table of stages.
    arguments_given : Mapping[str, Any]
        Arguments from the config and from earlier stages by name.
    **extra_arguments : Any
        Further arguments of the stage's function: wildcards, and settings such as `threads` or
        `partial` that decide no number.

    Returns
    -------
    'Outcome'
        Content of its files by name, and one line about it; nothing is written.
    """
    function = load(stage.function)
    with keys_named(), one_blas_thread():
        arguments = typed_arguments(function, with_machine(stage, arguments_given))
        outcome: Outcome = function(**arguments, **extra_arguments)
    return outcome


def with_machine(stage: Stage, arguments: Mapping[str, Any]) -> Mapping[str, Any]:
    """Replace the arguments that are fields of MachineInputs by one argument: the machine, or its
    inputs.

    The row's `machine` says which: `machine` gives the built machine, `inputs` gives MachineInputs,
    empty changes nothing.

    Parameters
    ----------
    stage : Stage
        Row of the table of stages.
    arguments : mapping
        Arguments from the config and from earlier stages by name.

    Returns
    -------
    mapping
        The arguments that the stage's function takes, with `machine` or `inputs` among them.

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
    """Collect the arguments that are fields of MachineInputs, convert config values to sections, and
    build the object.

    Parameters
    ----------
    arguments : mapping
        Arguments from the config and from earlier stages by name; others are passed over.

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


@contextmanager
def one_blas_thread() -> Iterator[None]:
    """Limit the libraries of linear algebra to one thread; afterwards they have as many as before.

    Fronts of an elimination and matrices of a contact or of a machine are small. Threads that wait for one
    another at full speed take several times the processor time there, and on a busy machine longer as well.

    Returns
    -------
    Iterator[None]
        A context, with nothing to be used inside.
    """
    with threadpool_limits(limits=1):
        yield
