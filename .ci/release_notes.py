"""Prints the changelog's section of a version, or what is unreleased where the version has none."""

import re
import sys
from pathlib import Path


def notes(changelog: str, version: str) -> str:
    """The text under the version's heading, with the heading."""
    parts = re.split(r"(?m)^## ", changelog)[1:]
    headings = [part.splitlines()[0].split()[0].strip("[]") for part in parts]
    number = headings.index(version) if version in headings else headings.index("Unreleased")
    return f"## {parts[number].rstrip()}\n"


if __name__ == "__main__":
    sys.stdout.write(notes(Path(sys.argv[1]).read_text(encoding="utf-8"), sys.argv[2]))
