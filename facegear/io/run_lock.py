"""One run at a time in a directory, by a lock the kernel gives back when its holder dies."""

import errno
import os
import socket
import sys
from contextlib import suppress
from pathlib import Path
from typing import TextIO

if sys.platform != "win32":  # which has no advisory locks: there every run may go ahead
    import fcntl

NO_LOCKS_HERE = (errno.ENOSYS, errno.ENOLCK, errno.EOPNOTSUPP)
"""What the kernel answers where the file system knows no locks, as on some network disks."""


def hold(path: str | Path) -> TextIO | None:
    """Take the lock for as long as the returned stream lives; None if another live process holds it.

    Where there are no kernel locks, the process that the file names counts as the holder while it lives on
    this machine. Raises OSError if the lock cannot be asked for at all.
    """
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    stream = open(path, "a+", encoding="utf-8")  # noqa: SIM115 - open as long as the lock is held
    if not _taken(stream):
        stream.close()
        return None
    stream.truncate(0)
    stream.write(f"{os.getpid()} {socket.gethostname()}\n")
    stream.flush()
    return stream


def _taken(stream: TextIO) -> bool:
    if sys.platform == "win32":
        return True
    try:
        fcntl.flock(stream, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError as error:
        if error.errno not in NO_LOCKS_HERE:
            raise
        return not _holder_lives(stream)
    return True


def _holder_lives(stream: TextIO) -> bool:
    """Whether the process that the lock file names is another one, alive on this machine."""
    stream.seek(0)
    pid, _, host = stream.read().strip().partition(" ")
    if not pid.isdecimal() or host != socket.gethostname() or int(pid) == os.getpid():
        return False
    with suppress(PermissionError):  # alive, and not ours
        try:
            os.kill(int(pid), 0)
        except ProcessLookupError:
            return False
    return True
