"""The frame around every workflow script: lock, log, one-line errors, summary, manifest of the outputs."""

import glob
import shlex
import signal
import sys
import time
import traceback
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager, redirect_stderr, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO

from filelock import FileLock, Timeout

from facegear.errors import CorruptFile, FacegearError
from facegear.io.atomic import MANIFEST_SUFFIX, NO_SPACE, NO_SPACE_HINT, require_manifest
from facegear.pipeline.provenance.manifest import write_manifest

RESULTS = "results"
"""Folder of what stages write, each file with its manifest; inputs elsewhere are the user's."""
Paths = Mapping[str, Any]
"""Paths by name, a list where there are several."""


class StageRun:
    """Run of a stage, to which a script tells its summary; `name` leads its line on the terminal,
    `text` is the summary.
    """

    def __init__(self, name: str) -> None:
        self.name, self.text = name, ""

    def summary(self, text: str) -> None:
        """Print and record the stage's one-line summary of what it found.

        Parameters
        ----------
        text : str
            The summary.
        """
        self.text = text
        print(f"{self.name}: {text}", file=sys.stderr, flush=True)


@dataclass(frozen=True)
class Part:
    """Extent of one manifest: a whole job of Snakemake, or one case of a job that makes several.

    - rule: what the manifest calls it
    - wildcards: values of its wildcards, behind its name on the terminal
    - input, output: paths, or lists of paths, by name; the manifest is among the outputs
    - params: slice of the config as `needs`, fingerprint as `code`
    - rebuild: command that makes a target again
    """

    rule: str
    wildcards: tuple[str, ...]
    input: Paths
    output: Paths
    params: Mapping[str, Any]
    rebuild: str

    @property
    def inputs(self) -> list[str]:
        """Paths of all inputs."""
        return _flatten_paths(self.input)

    @property
    def manifest(self) -> Path | None:
        """Path of the manifest among the outputs; None if the rule writes none."""
        return next(
            (Path(path) for path in _flatten_paths(self.output) if path.endswith(MANIFEST_SUFFIX)), None
        )

    @property
    def files(self) -> list[Path]:
        """Paths of all outputs but the manifest."""
        return [Path(path) for path in _flatten_paths(self.output) if not path.endswith(MANIFEST_SUFFIX)]


def _flatten_paths(paths: Paths) -> list[str]:
    """Return all paths in one list; `paths` holds a path or several under each name."""
    path_lists = [[path] if isinstance(path, str) else [*path] for path in paths.values()]
    return [str(path) for path_list in path_lists for path in path_list]


def parts_of(snakemake: Any) -> list[Part]:
    """Split a job of a stage into parts with a manifest each: one, or one for each of its `cases`.

    In a job of several cases the names of inputs and outputs end in `__n`, n being the number of the
    case.

    Parameters
    ----------
    snakemake : Any
        Snakemake's object in the script.

    Returns
    -------
    list[Part]
        The parts.
    """
    params, rebuild = snakemake.params, snakemake.config["rebuild_command"]
    input_paths, output_paths = dict(snakemake.input.items()), dict(snakemake.output.items())
    part_params = {"needs": params.needs, "code": params.code}
    if params.get("cases") is None:
        wildcards = tuple(dict(snakemake.wildcards.items()).values())
        return [Part(params.stage, wildcards, input_paths, output_paths, part_params, rebuild)]
    return [
        Part(
            params.stage,
            (case,),
            _ending(f"__{n}", input_paths),
            _ending(f"__{n}", output_paths),
            {**part_params, "needs": params.needs[n]},
            rebuild,
        )
        for n, case in enumerate(params.cases)
    ]


def _ending(end: str, paths: Paths) -> Paths:
    """Return the paths whose names end in `end`, by their names without this ending."""
    return {name.removesuffix(end): path for name, path in paths.items() if name.endswith(end)}


@contextmanager
def stage(snakemake: Any) -> Iterator[StageRun]:
    """Make a context around the body of a script whose rule has one manifest, which covers all other
    outputs.

    It joins `job` and `record_part`: lock, log, one-line errors, checked inputs, manifest.

    Parameters
    ----------
    snakemake : Any
        Snakemake's object in the script.

    Yields
    ------
    StageRun
        The run, which takes the stage's summary.
    """
    whole = Part(
        snakemake.rule,
        tuple(dict(snakemake.wildcards.items()).values()),
        {"": list(snakemake.input)},
        {"": list(snakemake.output)},
        dict(snakemake.params.items()),
        snakemake.config["rebuild_command"],
    )
    with job(snakemake), record_part(whole) as run:
        yield run


@contextmanager
def job(snakemake: Any) -> Iterator[None]:
    """Copy standard error to the rule's log while a script works, and let no second job write its files.

    A FacegearError or a full disk ends the script with one line, the log's path and exit code 1, without a
    traceback. Ctrl-C ends it at once and without a word: the run that has started it says what is to be said.

    Parameters
    ----------
    snakemake : Any
        Snakemake's object in the script.

    Yields
    ------
    None
        Nothing.
    """
    log = Path(snakemake.log[0])
    with _one_line_errors(snakemake, log), ExitStack() as locks:
        locks.callback(signal.signal, signal.SIGINT, signal.signal(signal.SIGINT, signal.SIG_DFL))
        log.parent.mkdir(parents=True, exist_ok=True)
        _hold(locks, log.with_suffix(".lock"), snakemake.rule)
        with open(log, "wb", buffering=0) as stream, _copy_output(stream), _one_line_errors(snakemake, log):
            yield


def _hold(locks: ExitStack, path: Path, rule: str) -> None:
    """Take the lock file at `path`, and give it back when `locks` closes.

    While another job holds it, say so once and wait. A disk that cannot lock is used without.
    """
    lock = FileLock(path)
    with suppress(OSError):  # a disk without locks
        try:
            lock.acquire(blocking=False)
        except Timeout:
            print(
                f"{rule}: waiting for a job that a killed run has left working", file=sys.stderr, flush=True
            )
            lock.acquire()
        locks.callback(lock.release)


@contextmanager
def record_part(part: Part) -> Iterator[StageRun]:
    """Make a context around the work on one part: check its inputs before, write its manifest after.

    The old manifest and half-written files are removed first, so that a part that fails has no
    manifest. Inputs below RESULTS must have a manifest. Without a summary from the script the names of
    the files are the summary.

    Parameters
    ----------
    part : Part
        The part.

    Yields
    ------
    StageRun
        The run, which takes the stage's summary.
    """
    run, start = StageRun(" ".join([part.rule, *part.wildcards])), time.perf_counter()
    if part.manifest:
        part.manifest.unlink(missing_ok=True)
    for path in part.files:
        for left in path.parent.glob(f".[0-9]*.{glob.escape(path.name)}"):  # by a job that was killed
            left.unlink(missing_ok=True)
    for input_path in part.inputs:
        if Path(input_path).parts[0] == RESULTS:
            require_manifest(input_path)
    yield run
    if not run.text:
        run.summary("wrote " + ", ".join(path.name for path in part.files))
    if part.manifest:
        write_manifest(
            part.manifest,
            part.files,
            part.inputs,
            part.params,
            part.rule,
            time.perf_counter() - start,
            run.text,
            part.rebuild,
        )


@contextmanager
def _one_line_errors(snakemake: Any, log: Path) -> Iterator[None]:
    """End a job with exit code 1 and one line on standard error for FacegearError and a full disk;
    other errors go on.
    """
    try:
        yield
    except (FacegearError, OSError) as error:
        if isinstance(error, OSError) and error.errno not in NO_SPACE:
            raise
        job_name = f"{snakemake.rule} of {snakemake.wildcards.get('case', 'this workflow')}"
        message = f"{log}: {NO_SPACE_HINT}" if isinstance(error, OSError) else str(_rebuilt(error, snakemake))
        print(f"error in {job_name}: {message} (log: {log})", file=sys.stderr, flush=True)
        raise SystemExit(1) from None


def _rebuilt(error: FacegearError, snakemake: Any) -> FacegearError:
    """Return the error; a CorruptFile gets the command that makes its file again in this run."""
    if not isinstance(error, CorruptFile):
        return error
    command = snakemake.config["rebuild_command"]
    return CorruptFile(error.path, error.problem, f"{command} {shlex.quote(str(error.path))}")


class _CopiedStream:
    """Stream in place of standard error that writes to the terminal and to a log file."""

    def __init__(self, log: BinaryIO) -> None:
        self.log, self.terminal = log, sys.stderr

    def write(self, text: str) -> int:
        """Write text to the log, as far as the disk allows, and to the terminal; return the number of
        characters.
        """
        with suppress(OSError):  # a full disk must not keep the message from the terminal
            self.log.write(text.encode())
        return self.terminal.write(text)

    def flush(self) -> None:
        """Flush the terminal."""
        self.terminal.flush()


@contextmanager
def _copy_output(log: BinaryIO) -> Iterator[None]:
    """Copy standard error to an open log while the block runs; a traceback goes to the log alone, as
    Python prints it too.
    """
    try:
        with redirect_stderr(_CopiedStream(log)):
            yield
    except Exception:
        with suppress(OSError):
            log.write(traceback.format_exc().encode())
        raise
