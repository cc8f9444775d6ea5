"""Machine code is kept where that is possible; where it is not, the computation goes on."""

import os
from pathlib import Path

import pytest
from strangers import done_by_stranger

from facegear.machine_code import kept
from facegear.machine_code.stored import _wait


def work_without_keeping():
    """Ask for all that a compiled function asks of the folder."""
    assert kept.read("some-function") is None
    kept.write("some-function", b"code")
    assert kept.read("some-function") is None
    kept.trim(0)
    assert _wait("some-function") is None


@pytest.fixture
def forbidden(tmp_path):
    """A home that only root may enter, or nobody where the tests' own user is not root."""
    home = tmp_path / "home"
    (home / ".cache" / "facegear" / "machine_code").mkdir(parents=True)
    home.chmod(0o700 if os.getuid() == 0 else 0o000)
    yield home
    home.chmod(0o700)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="users of POSIX systems only")
def test_a_home_that_may_not_be_entered_keeps_nothing_and_ends_nothing(forbidden, monkeypatch):
    """Every computation ended with PermissionError as soon as something was compiled."""
    monkeypatch.delenv(kept.VARIABLE, raising=False)
    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    monkeypatch.setenv("HOME", str(forbidden))
    assert done_by_stranger(work_without_keeping)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="users of POSIX systems only")
def test_a_cache_folder_that_may_not_be_entered_keeps_nothing(forbidden, monkeypatch):
    monkeypatch.setenv(kept.VARIABLE, str(forbidden / ".cache"))
    assert done_by_stranger(work_without_keeping)


def test_a_user_without_a_home_keeps_nothing(monkeypatch, tmp_path):
    """In a container with a user id of its own: platformdirs has no folder to name."""

    def unknown(_):
        raise RuntimeError("could not determine the home directory")

    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv(kept.VARIABLE, raising=False)
    monkeypatch.setattr(kept.platformdirs, "user_cache_path", unknown)
    work_without_keeping()
    assert list(tmp_path.iterdir()) == []


def test_a_file_in_place_of_the_cache_folder_keeps_nothing(monkeypatch, tmp_path):
    (tmp_path / "cache").write_text("a file")
    monkeypatch.setenv(kept.VARIABLE, str(tmp_path / "cache"))
    work_without_keeping()
    assert Path(tmp_path / "cache").read_text() == "a file"
