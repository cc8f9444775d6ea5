"""Recipes of CONTRIBUTING.md: their steps, and a copy of the sources in which they are followed."""

import os
import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from projects import ROOT, environment

TEXT = (ROOT / "CONTRIBUTING.md").read_text()
PLACE = r"(below|above|in place of) `([^`]+)`"


@dataclass(frozen=True)
class Insertion:
    """Code of a step: below, above or in place of a line of its file, or the whole of a new file."""

    side: str
    line: str
    code: str


@dataclass(frozen=True)
class Step:
    """A numbered step: a file, whether it is new, and what is written into it."""

    file: str
    is_new: bool
    insertions: tuple[Insertion, ...]

    def follow(self, sources: Path):
        """Write the step's code into a copy of the sources."""
        path = sources / self.file
        for insertion in self.insertions:
            if self.is_new:
                assert not path.exists(), self.file
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(insertion.code)
                continue
            line = f"{insertion.line}\n"
            text = path.read_text()
            assert text.count(line) == 1, (self.file, line)
            before, after = text.split(line)
            parts = {"below": (line, insertion.code), "above": (insertion.code, line)}
            path.write_text(before + "".join(parts.get(insertion.side, (insertion.code,))) + after)


def read_recipe(title: str) -> list[Step]:
    """Steps of the section of CONTRIBUTING.md with this title."""
    section = re.search(rf"^## {title}\n(.*?)^## ", TEXT, flags=re.DOTALL | re.MULTILINE)[1]
    steps = re.split(r"^(?=\d+\. )", section, flags=re.MULTILINE)[1:]
    return [_read_step(text) for text in steps]


def _read_step(text):
    file, rest = re.match(r"\d+\. `([^`]+)`(.*)", text, flags=re.DOTALL).groups()
    blocks = re.finditer(r"([^\n]*)\n( +)```\w+\n(.*?)\n\2```", rest, flags=re.DOTALL)
    insertions = []
    for block in blocks:
        place = re.search(PLACE, block[1], flags=re.IGNORECASE)
        side, line = (place[1].lower(), place[2]) if place else ("", "")
        insertions.append(Insertion(side, line, _without_list(block[3], block[2])))
    return Step(file, rest.startswith(", new"), tuple(insertions))


def _without_list(code, indent):
    """The code less the columns by which the list indents it."""
    return "".join(f"{line.removeprefix(indent)}\n" for line in code.split("\n"))


def python(sources, *arguments, folder=None):
    """Run Python in a copy of the sources."""
    return subprocess.run(
        [sys.executable, *arguments],
        cwd=folder or sources,
        env={**environment(), "PYTHONPATH": os.pathsep.join([str(sources), str(ROOT / "tests" / "helpers")])},
        capture_output=True,
        text=True,
        check=False,
    )


def assert_test_passes(sources, steps):
    """The recipe's own test passes, and ruff finds nothing in the files that it makes."""
    tests = [step.file for step in steps if step.file.startswith("tests/")]
    codes = [step.file for step in steps if step.is_new]
    tested = ("pytest", "-q", "-p", "references", "-p", "no:cacheprovider", "-c", "/dev/null", *tests)
    for command in (tested, ("ruff", "check", "--config", str(ROOT / "pyproject.toml"), *codes)):
        done = python(sources, "-m", *command)
        assert done.returncode == 0, done.stdout + done.stderr
