"""The frame around every workflow script: log, one-line errors, summary, manifest of the outputs."""

import shlex
import sys
import time
import traceback
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from types import TracebackType
from typing import Any, BinaryIO

from facegear.errors import CorruptFile, FacegearError
from facegear.io.atomic import NO_SPACE, NO_SPACE_HINT
from facegear.io.checksums import MANIFEST_SUFFIX, require_manifest
from facegear.provenance.manifest import write_manifest

RESULTS = "results"
"""Folder of what stages write, each file with its manifest; inputs elsewhere are the user's."""


class StageRun:
    """What a script may tell about its stage; `name` leads its line on the terminal."""

    def __init__(self, name: str) -> None:
        self.name, self.text = name, ""

    def summary(self, text: str) -> None:
        """Print and record the stage's one-line summary of what it found."""
        self.text = text
        print(f"{self.name}: {text}", file=sys.stderr, flush=True)


@contextmanager
def stage(snakemake: Any) -> Iterator[StageRun]:
    """Run a script's body: copy standard error to the rule's log and write the manifest at the end.

    A FacegearError or a full disk ends the script with one line, the log's path and exit code 1, without a
    traceback. The manifest goes to the output whose name ends in `.provenance.json` and covers all others.
    """
    run, start = (
        StageRun(" ".join([snakemake.rule, *dict(snakemake.wildcards.items()).values()])),
        time.perf_counter(),
    )
    outputs = [Path(output) for output in snakemake.output]
    manifests = [output for output in outputs if output.name.endswith(MANIFEST_SUFFIX)]
    log = Path(snakemake.log[0])
    with _one_line_errors(snakemake, log):
        log.parent.mkdir(parents=True, exist_ok=True)
        with open(log, "wb", buffering=0) as stream, _Copied(stream), _one_line_errors(snakemake, log):
            for manifest in manifests:
                manifest.unlink(missing_ok=True)
            for path in snakemake.input:
                if Path(path).parts[0] == RESULTS:
                    require_manifest(path)
            yield run
            if not run.text:
                run.summary(
                    "wrote " + ", ".join(output.name for output in outputs if output not in manifests)
                )
            for manifest in manifests:
                write_manifest(
                    manifest,
                    [output for output in outputs if output not in manifests],
                    list(snakemake.input),
                    dict(snakemake.params.items()),
                    snakemake.rule,
                    time.perf_counter() - start,
                    run.text,
                    snakemake.config["rebuild_command"],
                )


@contextmanager
def _one_line_errors(snakemake: Any, log: Path) -> Iterator[None]:
    try:
        yield
    except (FacegearError, OSError) as error:
        if isinstance(error, OSError) and error.errno not in NO_SPACE:
            raise
        where = f"{snakemake.rule} of {snakemake.wildcards.get('case', 'this workflow')}"
        what = f"{log}: {NO_SPACE_HINT}" if isinstance(error, OSError) else str(_rebuilt(error, snakemake))
        print(f"error in {where}: {what} (log: {log})", file=sys.stderr, flush=True)
        raise SystemExit(1) from None


def _rebuilt(error: FacegearError, snakemake: Any) -> FacegearError:
    """The same error; where a stored file is at fault, with the command that makes it again in this run."""
    if not isinstance(error, CorruptFile):
        return error
    command = snakemake.config["rebuild_command"]
    return CorruptFile(error.path, error.what, f"{command} {shlex.quote(str(error.path))}")


class _Copied:
    """Standard error also goes to a log."""

    def __init__(self, log: BinaryIO) -> None:
        self.log, self.terminal = log, sys.stderr

    def __enter__(self) -> None:
        sys.stderr = self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        sys.stderr = self.terminal
        if kind is not None and kind is not SystemExit:
            self._keep("".join(traceback.format_exception(kind, error, trace)))

    def write(self, text: str) -> int:
        self._keep(text)
        return self.terminal.write(text)

    def flush(self) -> None:
        self.terminal.flush()

    def _keep(self, text: str) -> None:
        with suppress(OSError):  # a full disk must not keep the message from the terminal
            self.log.write(text.encode())
