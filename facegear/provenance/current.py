"""Whether a stored result is what its stage would give now."""

import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from facegear.io.checksums import MANIFEST_SUFFIX, sha256

Manifest = Mapping[str, Any]


def current_manifest(
    path: Path, needs: Callable[[str], Mapping[str, Any] | None], code: Callable[[str], str]
) -> Manifest | None:
    """The manifest of a stored file if the file is up to date, else None.

    It is if its stage ran with the same slice of the config and the same code, on inputs that are the same
    files now and up to date themselves. `needs` and `code` give slice and stage fingerprint of a rule; None
    for a rule that they do not know. The bytes of the file itself are left to its reader.
    """
    manifest = _manifest(path)
    if manifest is None:
        return None
    try:
        current_needs = needs(manifest["rule"])
        if current_needs is None or manifest["params"].get("needs") != current_needs:
            return None
        if code(manifest["rule"]) not in manifest["code"].split("."):
            return None
        inputs = {path.parent / name: digest for name, digest in manifest["inputs"].items()}
    except (KeyError, TypeError, AttributeError):
        return None
    try:
        are_inputs_current = all(name.is_file() and sha256(name) == digest for name, digest in inputs.items())
    except OSError:
        return None
    made_inputs = [name for name in inputs if are_inputs_current and _manifest(name) is not None]
    return (
        manifest
        if are_inputs_current and all(current_manifest(name, needs, code) for name in made_inputs)
        else None
    )


def _manifest(path: Path) -> Manifest | None:
    """The readable manifest that covers a file; None where its folder cannot be read."""
    try:
        candidates = sorted(path.parent.glob(f"*{MANIFEST_SUFFIX}"))
    except OSError:
        return None
    for candidate in candidates:
        try:
            manifest = json.loads(candidate.read_text(encoding="utf-8"))
            if path.name in manifest["files"]:
                return manifest
        except (OSError, ValueError, KeyError, TypeError):
            continue
    return None
