"""The frame around every workflow script: log, one-line errors, summary, manifest of the outputs."""

import sys
import time
import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import TracebackType
from typing import Any, TextIO

from facegear.errors import FacegearError
from facegear.io.checksums import MANIFEST_SUFFIX
from facegear.provenance.manifest import write_manifest


class Run:
    """What a script may tell about its stage."""

    def __init__(self) -> None:
        self.text = ""

    def summary(self, text: str) -> None:
        """Print and record the stage's one-line summary of what it found."""
        self.text = text
        print(f"summary: {text}", file=sys.stderr, flush=True)


@contextmanager
def stage(snakemake: Any) -> Iterator[Run]:
    """Run a script's body: copy standard error to the rule's log and write the manifest at the end.

    A FacegearError ends the script with its own line, the log's path and exit code 1, without a traceback.
    The manifest goes to the output whose name ends in `.provenance.json` and covers all other outputs.
    """
    run, start = Run(), time.perf_counter()
    outputs = [Path(output) for output in snakemake.output]
    manifests = [output for output in outputs if output.name.endswith(MANIFEST_SUFFIX)]
    log = Path(snakemake.log[0])
    log.parent.mkdir(parents=True, exist_ok=True)
    with open(log, "w", encoding="utf-8") as stream, _Copied(stream):
        for manifest in manifests:
            manifest.unlink(missing_ok=True)
        try:
            yield run
        except FacegearError as error:
            where = f"{snakemake.rule} of {snakemake.wildcards.get('case', 'this workflow')}"
            print(f"error in {where}: {error} (log: {log})", file=sys.stderr, flush=True)
            raise SystemExit(1) from None
        for manifest in manifests:
            write_manifest(
                manifest,
                [output for output in outputs if output not in manifests],
                dict(snakemake.params.items()),
                snakemake.rule,
                time.perf_counter() - start,
                run.text,
                snakemake.config.get("rebuild_command", "snakemake --cores 2 --force"),
            )


class _Copied:
    """Standard error also goes to a log."""

    def __init__(self, log: TextIO) -> None:
        self.log, self.terminal = log, sys.stderr

    def __enter__(self) -> None:
        sys.stderr = self  # type: ignore[assignment]

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        sys.stderr = self.terminal
        if kind is not None and kind is not SystemExit:
            traceback.print_exception(kind, error, trace, file=self.log)

    def write(self, text: str) -> int:
        self.log.write(text)
        self.log.flush()
        return self.terminal.write(text)

    def flush(self) -> None:
        self.log.flush()
        self.terminal.flush()
