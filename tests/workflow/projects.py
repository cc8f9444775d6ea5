"""Runs of the whole workflow in folders of their own, from the sources of this checkout."""

import multiprocessing
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from facegear.pipeline.provenance.fingerprint import fingerprint, stage_fingerprint
from facegear.pipeline.provenance.sources import recall, remember
from facegear.pipeline.table import STAGES

ROOT = Path(__file__).parents[2]
FOLDERS = ("workflow", "facegear", "paper", "validation", "config")
SCRIPTS = sorted(path for name in FOLDERS for path in (ROOT / name / "scripts").glob("*.py"))
SOURCES = ROOT / ".snakemake" / "sources.json"
"""In the folder of the sources: what counts of each source file."""


@dataclass(frozen=True)
class Project:
    """A folder that results go to, and the sources that make them.

    It holds what a run leaves behind of the sources it parsed, so that not every start parses them anew.
    """

    folder: Path
    sources: Path = ROOT

    def __post_init__(self) -> None:
        parse_sources()

    def copied(self, folder: Path) -> "Project":
        """Copy the results, and Snakemake's records of them, to another folder."""
        for name in ("results", ".snakemake"):
            shutil.copytree(self.folder / name, folder / name)
        return Project(folder, self.sources)

    def command(self, *arguments: str) -> list[str]:
        """Start a process by itself, to be watched or killed."""
        return [sys.executable, "-m", "snakemake", *self._all(*arguments)]

    def _all(self, *arguments: str) -> list[str]:
        return [
            *("--cores", "2", "--nocolor", "--snakefile", str(self.sources / "workflow" / "Snakefile")),
            *("--directory", str(self.folder), *arguments),
        ]

    def run(self, *arguments: str, check: bool = True) -> subprocess.CompletedProcess[str]:
        """Run Snakemake and return its exit code, with what it has printed."""
        done = start(self._all(*arguments), environment())
        if check:
            assert done.returncode == 0, f"{arguments}\n{done.stdout[-3000:]}\n{done.stderr[-6000:]}"
        return done

    def planned(self, *arguments: str) -> set[str]:
        """Names of the rules that a dry run would execute."""
        done = self.run("-n", *arguments)
        return rules_in(done.stdout + done.stderr) - {"all"}


@cache
def dry_run(*arguments: str) -> subprocess.CompletedProcess[str]:
    """Run dry in a folder without results, which must hold no table afterwards; once for equal arguments."""
    with tempfile.TemporaryDirectory() as folder:
        done = Project(Path(folder)).run("-n", *arguments, check=False)
        assert not list(Path(folder).rglob("*.csv"))
        return done


@cache
def processes() -> multiprocessing.context.ForkServerContext:
    """Processes in which Snakemake is imported already, as its imports are most of a dry run."""
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(["snakemake.cli", "facegear.build.cases", "facegear.pipeline.needs"])
    return context


def start(arguments: Sequence[str], environment: Mapping[str, str]) -> subprocess.CompletedProcess[str]:
    """Run Snakemake with these arguments in the present folder."""
    with tempfile.TemporaryDirectory() as folder:
        files = [str(Path(folder, name)) for name in ("out", "error")]
        process = processes().Process(target=_snakemake, args=(arguments, environment, os.getcwd(), files))
        process.start()
        process.join()
        texts = [Path(file).read_text() for file in files]
        return subprocess.CompletedProcess(arguments, process.exitcode or 0, *texts)


def _snakemake(arguments: list[str], environment: dict[str, str], folder: str, files: list[str]) -> None:
    """Be what `python -m snakemake` is, in a process of its own."""
    for number, file in enumerate(files, 1):
        opened = os.open(file, os.O_WRONLY | os.O_CREAT)
        os.dup2(opened, number)
        os.close(opened)
    os.chdir(folder)
    os.environ.clear()
    os.environ.update(environment)
    sys.argv = ["snakemake", *arguments]
    from snakemake.cli import main

    main()


@cache
def parse_sources() -> None:
    """Leave what counts of this checkout's sources where each start looks for it."""
    recall(SOURCES)
    for script in SCRIPTS:
        fingerprint(script, ROOT)
    for stage in STAGES.values():
        drawn = (stage.figures.draw,) if stage.figures else ()
        stage_fingerprint((*stage.functions, *drawn), ROOT)
    remember(SOURCES)


def rules_in(text: str) -> set[str]:
    """Rule names in a Snakemake job table."""
    lines = text.splitlines()
    found: set[str] = set()
    for number, line in enumerate(lines):
        if line.split() == ["job", "count"]:
            for row in lines[number + 2 :]:
                words = row.split()
                if len(words) != 2 or words[0] == "total":
                    break
                found.add(words[0])
    return found


def environment() -> dict[str, str]:
    kept = {key: value for key, value in os.environ.items() if not key.startswith("SNAKEMAKE")}
    return {**kept, "PYTHONPATH": "", "COLUMNS": "200"}


def copy_sources(target: Path) -> Path:
    """A copy of the tracked and new source files, with their times, and of the compiled kernels."""
    listed = subprocess.run(
        ["git", "ls-files", "-co", "--exclude-standard", "Snakefile", *FOLDERS],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    ).stdout.splitlines()
    kernels = (ROOT / "facegear" / "_kernels").iterdir()
    listed += [str(file.relative_to(ROOT)) for file in kernels if file.suffix in (".so", ".pyd")]
    for name in listed:
        if (ROOT / name).is_file():
            (target / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, target / name, follow_symlinks=False)
    return target
