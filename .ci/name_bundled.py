"""Adds code of others that the package carries, and no lock file names, to a CycloneDX list of components."""

import hashlib
import json
import re
import sys
from pathlib import Path

PLOTLY = Path(__file__).parents[1] / "facegear" / "report" / "plotly-cartesian.min.js"
NAME = "plotly.js-cartesian-dist-min"


def bundled() -> dict[str, object]:
    """The plotly.js that reports carry: version by its first lines, SHA-256 of the file."""
    content = PLOTLY.read_bytes()
    version = re.search(rb"plotly\.js \(cartesian - minified\) v([\d.]+)", content[:500])
    if version is None:
        raise SystemExit(f"{PLOTLY}: its first lines must name its version")
    number = version[1].decode()
    return {
        "type": "library",
        "bom-ref": NAME,
        "name": NAME,
        "version": number,
        "purl": f"pkg:npm/{NAME}@{number}",
        "licenses": [{"license": {"id": "MIT"}}],
        "hashes": [{"alg": "SHA-256", "content": hashlib.sha256(content).hexdigest()}],
        "description": "Bundled in facegear/report; draws the figures of the report",
    }


def named(document: dict[str, object]) -> dict[str, object]:
    """The list of components with the bundled one at its end."""
    return {**document, "components": [*document.get("components", []), bundled()]}


if __name__ == "__main__":
    path = Path(sys.argv[1])
    document = named(json.loads(path.read_text(encoding="utf-8")))
    path.write_text(json.dumps(document, indent=2) + "\n", encoding="utf-8")
