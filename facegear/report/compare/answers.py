"""Answers of the example machines, stored small with each release."""

import json
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.resources import files
from pathlib import Path
from tempfile import TemporaryDirectory

from facegear.errors import require_choice
from facegear.io import documents
from facegear.io.atomic import MANIFEST_SUFFIX, atomic_path
from facegear.report.compare.judge import NOT_STORED, answer_tables

MAX_BYTES = 60_000
"""A table larger than this is a history, and not stored with a release."""
SAME_DATE = (2000, 1, 1, 0, 0, 0)
"""Date of all files in a stored answer, so that equal answers give equal bytes."""


def answer_names() -> list[str]:
    """Return the names `version/machine` of the stored answers.

    Returns
    -------
    list[str]
        The names, sorted, such as `current/quick`; empty if none are installed.
    """
    folder = files("facegear.report.compare").joinpath("stored")
    if not folder.is_dir():
        return []
    return sorted(
        f"{version.name}/{entry.name.removesuffix('.zip')}"
        for version in folder.iterdir()
        if version.is_dir()
        for entry in version.iterdir()
        if entry.name.endswith(".zip")
    )


def store(folder: Path, path: Path) -> None:
    """Write the small tables of a folder of results, with their manifests, as one file.

    The file names the larger tables too, so that nothing is compared with them. Two equal folders give the
    same bytes. What was on the machine that made them is left out.

    Parameters
    ----------
    folder : Path
        Folder of results.
    path : Path
        Path of the zip file: tables up to MAX_BYTES, shortened manifests, and NOT_STORED.
    """
    all_names = sorted(answer_tables(folder))
    names = [name for name in all_names if (folder / name).stat().st_size <= MAX_BYTES]
    manifests = {near for name in names for near in (folder / name).parent.glob(f"*{MANIFEST_SUFFIX}")}
    texts = {name: (folder / name).read_text(encoding="utf-8") for name in names}
    texts |= {manifest.relative_to(folder).as_posix(): _short(manifest) for manifest in manifests}
    texts[NOT_STORED] = json.dumps({"tables": [name for name in all_names if name not in names]})
    with atomic_path(path) as temporary, zipfile.ZipFile(temporary, "w") as archive:
        for name, text in sorted(texts.items()):
            archive.writestr(zipfile.ZipInfo(name, SAME_DATE), text, zipfile.ZIP_DEFLATED)


@contextmanager
def open_answer(name: str) -> Iterator[Path]:
    """Unpack a stored answer while it is used; a folder is used as it is.

    Parameters
    ----------
    name : str
        Name `version/machine` of a stored answer, or path of a folder.

    Yields
    ------
    Path
        Folder of the answer. Raises FacegearError for a name that is neither.
    """
    if Path(name).is_dir():
        yield Path(name)
        return
    version, _, machine = require_choice(
        name, answer_names(), "results (a folder, or a stored answer)"
    ).partition("/")
    source = files("facegear.report.compare").joinpath("stored", version, f"{machine}.zip")
    with TemporaryDirectory() as folder, source.open("rb") as stream, zipfile.ZipFile(stream) as archive:
        archive.extractall(folder)
        yield Path(folder)


def _short(manifest: Path) -> str:
    """Return a manifest's keys on how its table was made (rule, versions, params, code, rebuild,
    inputs, files) as JSON text; time, machine and summary are left out.
    """
    record = documents.read(manifest)
    keys = ("rule", "versions", "params", "code", "rebuild", "inputs", "files")
    return json.dumps({key: record[key] for key in keys if key in record}, sort_keys=True)


if __name__ == "__main__":
    import sys

    for case in sys.argv[2:]:
        store(Path(case), Path(__file__).parent / "stored" / sys.argv[1] / f"{Path(case).name}.zip")
