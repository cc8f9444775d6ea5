"""Possible causes of a moved table: config, code and versions of its stage and of all stages before it."""

import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from facegear.io import documents
from facegear.io.checksums import MANIFEST_SUFFIX

Manifest = Mapping[str, Any]


def causes(name: str, old: Path, new: Path) -> list[str]:
    """List the differences behind a table of two folders of results.

    That is a changed value of the config, with both values; changed code of a stage; another version of a
    library. A line says so where there is none, or where a folder does not say how a table was made.

    Parameters
    ----------
    name : str
        Path of the table inside the folders.
    old : Path
        Folder of the earlier results.
    new : Path
        Folder of the later results.

    Returns
    -------
    list[str]
        A line for each difference.
    """
    before, after = _history(old / name), _history(new / name)
    if not before or not after:
        return ["a manifest is missing: how the table was made is not known"]
    lines = list(dict.fromkeys([*_config(before, after), *_code(before, after), *_versions(before, after)]))
    return lines or ["config, code and versions are the same: the difference is in the run itself"]


def _history(path: Path) -> dict[str, Manifest]:
    """Manifests of a table's stage and of all before it that the folder still holds, by rule."""
    folders: dict[Path, dict[str, tuple[Path, Manifest]]] = {}
    history: dict[str, Manifest] = {}
    visited, pending = set(), [path]
    while pending:
        near = pending.pop()
        if near.parent not in folders:
            folders[near.parent] = _manifests(near.parent)
        source, manifest = folders[near.parent].get(near.name, (None, {}))
        if source is None or source in visited:
            continue
        visited.add(source)
        history.setdefault(str(manifest["rule"]), manifest)
        before = [Path(os.path.normpath(near.parent / name)) for name in manifest.get("inputs", {})]
        pending += reversed(before)
    return history


def _manifests(folder: Path) -> dict[str, tuple[Path, Manifest]]:
    """Path and content of the manifest behind each file of a folder."""
    manifests: dict[str, tuple[Path, Manifest]] = {}
    for path in sorted(folder.glob(f"*{MANIFEST_SUFFIX}")):
        manifest = documents.read(path, ("rule", "files", "params"))
        manifests = {**dict.fromkeys(manifest["files"], (path, manifest)), **manifests}
    return manifests


def _config(before: Mapping[str, Manifest], after: Mapping[str, Manifest]) -> Iterator[str]:
    for rule in sorted(before.keys() & after.keys()):
        old, new = (dict(_leaves("", side[rule]["params"].get("needs") or {})) for side in (before, after))
        for key in sorted(old.keys() | new.keys()):
            if old.get(key) != new.get(key):
                yield f"config {key}: {_value_text(old, key)} -> {_value_text(new, key)}"


def _leaves(key: str, value: Any) -> Iterator[tuple[str, Any]]:
    if isinstance(value, Mapping):
        inside = list(value.items())
    elif isinstance(value, list) and any(isinstance(item, Mapping) for item in value):
        inside = [
            (item.get("name", number) if isinstance(item, Mapping) else number, item)
            for number, item in enumerate(value)
        ]
    else:
        yield key, value
        return
    for name, item in inside:
        yield from _leaves(f"{key}.{name}" if key else str(name), item)


def _value_text(values: Mapping[str, Any], key: str) -> str:
    return repr(values[key]) if key in values else "absent"


def _code(before: Mapping[str, Manifest], after: Mapping[str, Manifest]) -> Iterator[str]:
    for rule in sorted(before.keys() & after.keys()):
        if before[rule].get("code") != after[rule].get("code"):
            yield f"code of stage {rule}"
    for rule in sorted(before.keys() ^ after.keys()):
        yield f"stage {rule} is behind one of them only"


def _versions(before: Mapping[str, Manifest], after: Mapping[str, Manifest]) -> Iterator[str]:
    for rule in sorted(before.keys() & after.keys()):
        old, new = before[rule].get("versions", {}), after[rule].get("versions", {})
        for library in sorted(old.keys() & new.keys()):
            if old[library] != new[library]:
                yield f"{library} {old[library]} -> {new[library]}"
