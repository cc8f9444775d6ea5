"""One run at a time in a folder, on disks with and without kernel locks."""

import errno
import os
import socket
import subprocess
import sys

import pytest

from facegear.io import run_lock

HOLDER = """
import sys, time
from facegear.io.run_lock import hold

held = hold(sys.argv[1])
print("held" if held else "refused", flush=True)
time.sleep(60)
"""


def test_a_held_folder_is_refused_to_another_process_until_its_holder_dies(tmp_path):
    path = tmp_path / "state" / "run.lock"
    command = [sys.executable, "-c", HOLDER, str(path)]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "held\n"
    assert run_lock.hold(path) is None
    process.kill()
    process.wait()
    with run_lock.hold(path) as stream:
        assert not stream.closed


@pytest.fixture(params=[errno.ENOSYS, errno.ENOLCK, errno.EOPNOTSUPP])
def without_locks(request, monkeypatch):
    def refuse(*_):
        raise OSError(request.param, os.strerror(request.param))

    monkeypatch.setattr(run_lock.fcntl, "flock", refuse)


def test_a_disk_without_locks_is_no_other_run(without_locks, tmp_path):
    with run_lock.hold(tmp_path / "run.lock") as stream:
        assert not stream.closed


def test_a_disk_without_locks_still_holds_off_a_second_run_on_this_machine(without_locks, tmp_path):
    path = tmp_path / "run.lock"
    process = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(60)"])
    path.write_text(f"{process.pid} {socket.gethostname()}\n")
    assert run_lock.hold(path) is None
    process.kill()
    process.wait()
    with run_lock.hold(path) as stream:
        assert not stream.closed


def test_a_broken_disk_is_not_reported_as_another_run(monkeypatch, tmp_path):
    def broken(*_):
        raise OSError(errno.EIO, os.strerror(errno.EIO))

    monkeypatch.setattr(run_lock.fcntl, "flock", broken)
    with pytest.raises(OSError, match=os.strerror(errno.EIO)):
        run_lock.hold(tmp_path / "run.lock")
