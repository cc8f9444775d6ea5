"""Runs of the whole workflow in folders of their own, from the sources of this checkout."""

import os
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from snakemake_server import Server

from facegear.machine_code import kept
from facegear.pipeline.table import STAGES
from facegear.provenance.fingerprint import fingerprint, recall, remember, stage_fingerprint

ROOT = Path(__file__).parents[2]
FOLDERS = ("workflow", "profiles", "facegear", "paper", "validation", "config")
SCRIPTS = sorted(path for name in FOLDERS for path in (ROOT / name / "scripts").glob("*.py"))
SOURCES = kept.folder().with_name("sources.json")
"""In Snakemake's folder: what counts of each source file."""


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
        """The same results, and what Snakemake knows of them, in another folder."""
        for name in ("results", ".snakemake"):
            shutil.copytree(self.folder / name, folder / name)
        return Project(folder, self.sources)

    def command(self, *arguments: str) -> list[str]:
        """Of a process for itself, to be watched or killed."""
        return [sys.executable, "-m", "snakemake", *self._all(*arguments)]

    def _all(self, *arguments: str) -> list[str]:
        return [
            *("--cores", "2", "--nocolor", "--snakefile", str(self.sources / "Snakefile")),
            *("--directory", str(self.folder), *arguments),
        ]

    def run(
        self, *arguments: str, check: bool = True, warm: bool = False, disk: tuple[str, str] | None = None
    ) -> subprocess.CompletedProcess[str]:
        """warm: jobs begin where their imports were made; else Python starts for each, as for a user's."""
        assert not warm or self.sources == ROOT
        done = server().start(self._all(*arguments), environment(), warm, disk)
        if check:
            assert done.returncode == 0, f"{arguments}\n{done.stdout[-3000:]}\n{done.stderr[-6000:]}"
        return done

    def planned(self, *arguments: str) -> set[str]:
        """Names of the rules that a dry run would execute."""
        done = self.run("-n", *arguments)
        return rules_in(done.stdout + done.stderr) - {"all"}


@cache
def dry_run(*arguments: str) -> subprocess.CompletedProcess[str]:
    """Of a folder without results, which must hold no table afterwards; for the same arguments made once."""
    with tempfile.TemporaryDirectory() as folder:
        done = Project(Path(folder)).run("-n", *arguments, check=False)
        assert not list(Path(folder).rglob("*.csv"))
        return done


@cache
def server() -> Server:
    return Server(ROOT)


@cache
def parse_sources() -> None:
    """Leave what counts of this checkout's sources where each start looks for it."""
    recall(SOURCES)
    for script in SCRIPTS:
        fingerprint(script, ROOT)
    for stage in STAGES.values():
        drawn = (stage.figures.draw.partition(":")[0],) if stage.figures else ()
        stage_fingerprint((*stage.modules, *drawn), ROOT)
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
    """A copy of the tracked and new source files, with their times."""
    listed = subprocess.run(
        ["git", "ls-files", "-co", "--exclude-standard", "Snakefile", *FOLDERS],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    ).stdout.splitlines()
    for name in listed:
        if (ROOT / name).is_file():
            (target / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, target / name, follow_symlinks=False)
    return target
