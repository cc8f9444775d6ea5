"""A machine without gmsh's libraries or without kernels is told the exact line that mends it."""

import ctypes
import sys

import pytest

from facegear import system_check


def test_this_machine_has_what_gmsh_needs():
    assert system_check.main() == 0


def test_missing_libraries_end_in_one_apt_line(monkeypatch, capsys):
    class Refuses:
        def find_spec(self, name, path=None, target=None):
            if name == "gmsh":
                raise OSError("libGLU.so.1: cannot open shared object file")

    def load(name, *args, **kwargs):
        if "GLU" in name or "Xft" in name:
            raise OSError(name)

    monkeypatch.delitem(sys.modules, "gmsh", raising=False)
    monkeypatch.setattr(sys, "meta_path", [Refuses(), *sys.meta_path])
    monkeypatch.setattr(ctypes, "CDLL", load)
    monkeypatch.setattr(ctypes.util, "find_library", lambda name: f"lib{name}.so")
    assert system_check.main() == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert line.endswith("apt-get install -y libglu1-mesa libxft2")


@pytest.mark.parametrize(("compiler", "advised"), [("GNU 12.2.0", False), ("zig (Clang 22.1.8)", True)])
def test_the_check_names_the_compiler_and_advises_a_faster_one(compiler, advised, monkeypatch, capsys):
    monkeypatch.setattr("facegear._kernels.COMPILER", compiler)
    assert system_check.main() == 0
    printed = capsys.readouterr().out
    assert compiler in printed and ("apt-get install -y g++" in printed) == advised


def test_kernels_that_do_not_load_end_in_one_line(monkeypatch, capsys):
    monkeypatch.delitem(sys.modules, "facegear._kernels")
    monkeypatch.delattr("facegear._kernels")
    monkeypatch.setitem(sys.modules, "facegear._kernels._baseline", None)
    assert system_check.main() == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert "kernels" in line and "make kernels" in line


@pytest.mark.parametrize("library", sorted(system_check.PACKAGES))
def test_every_library_names_its_debian_package(library):
    assert system_check.PACKAGES[library].startswith("lib")
