"""Stops where a library that a run installs has a licence that nobody has looked at."""

import csv
import re
import sys
from pathlib import Path

ALLOWED = (
    "MIT",
    "BSD",
    "Apache",
    "PSF",
    "Python Software Foundation",
    "ISC",
    "MPL",
    "Mozilla Public",
    "Zlib",
)
MIT_FILE = "MIT by its licence file; the metadata name none"
LOOKED_AT = {
    "gmsh": "GPL 2 or later with an exception for linking; meshes the teeth, not part of our wheel",
    "conda-inject": MIT_FILE,
    "snakemake-interface-common": MIT_FILE,
    "snakemake-interface-logger-plugins": MIT_FILE,
    "snakemake-interface-report-plugins": MIT_FILE,
    "snakemake-interface-scheduler-plugins": MIT_FILE,
    "snakemake-interface-storage-plugins": MIT_FILE,
}
"""Libraries with another licence, and what was found about it."""


def locked(text: str) -> set[str]:
    """Names of the libraries in a lock file."""
    return {match.lower() for match in re.findall(r"(?m)^([A-Za-z0-9_.-]+)==", text)}


def unknown(rows: list[dict[str, str]], names: set[str]) -> list[str]:
    """One line for each installed library of the lock whose licence nobody has looked at."""
    asked = [row for row in rows if re.sub(r"[-_.]+", "-", row["Name"]).lower() in names]
    return [
        f"{row['Name']} {row['Version']}: licence {row['License']!r} must be looked at"
        for row in asked
        if row["Name"].lower() not in LOOKED_AT and not any(word in row["License"] for word in ALLOWED)
    ]


if __name__ == "__main__":
    with open(sys.argv[1], encoding="utf-8") as stream:
        complaints = unknown(
            list(csv.DictReader(stream)), locked(Path(sys.argv[2]).read_text(encoding="utf-8"))
        )
    sys.exit("\n".join(complaints) or 0)
