"""One run at a time in a directory, by a lock the kernel gives back when its holder dies."""

import os
from pathlib import Path
from typing import TextIO

try:
    import fcntl
except ImportError:  # Windows: no advisory locks; snakemake's own lock still stands
    fcntl = None  # type: ignore[assignment]


def hold(path: str | Path) -> TextIO | None:
    """Take the lock for as long as the returned stream lives; None if another live process holds it."""
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    stream = open(path, "a+", encoding="utf-8")  # noqa: SIM115 - open as long as the lock is held
    if fcntl is not None:
        try:
            fcntl.flock(stream, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            stream.close()
            return None
    stream.truncate(0)
    stream.write(f"{os.getpid()}\n")
    stream.flush()
    return stream
