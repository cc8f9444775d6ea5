"""Files appear whole or not at all."""

import errno
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from facegear.errors import FacegearError

NO_SPACE = (errno.ENOSPC, errno.EDQUOT)
NO_SPACE_HINT = "no space left on the disk; free some and run again"


@contextmanager
def atomic_path(path: str | Path) -> Iterator[Path]:
    """Yield a temporary path in the folder of `path` (same suffix) and rename it at the end.

    Raises FacegearError with one line if the disk is full; the temporary file is removed on any error.
    """
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f".{os.getpid()}.{path.name}")
    try:
        yield temporary
        with open(temporary, "rb") as stream:
            os.fsync(stream.fileno())
        os.replace(temporary, path)
    except OSError as error:
        if error.errno in NO_SPACE:
            raise FacegearError(f"{path}: {NO_SPACE_HINT}") from None
        raise
    finally:
        temporary.unlink(missing_ok=True)
