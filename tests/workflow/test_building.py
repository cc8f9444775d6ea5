"""How the package and its kernels are built; what needs a compiler runs in `make ci`."""

import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
BUILDING = ROOT / "building"
KERNELS = ROOT / "facegear" / "_kernels"


def run_hook(code, **environment):
    """Run code in the backend's folder, as pip runs a hook; return what it printed."""
    script = f"import sys; sys.path.insert(0, {str(BUILDING)!r}); {code}"
    return subprocess.run(
        [sys.executable, "-c", script],
        cwd=ROOT,
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        check=True,
    ).stdout


@pytest.mark.parametrize("compiler", ["g++", "clang++", "c++"])
def test_the_build_asks_for_zig_only_where_a_machine_has_no_compiler(compiler, tmp_path):
    asked = "import backend; print(backend.get_requires_for_build_wheel())"
    empty = {"PATH": str(tmp_path), "CXX": ""}
    assert "ziglang" in run_hook(asked, **empty)
    assert "ziglang" not in run_hook(asked, **{**empty, "CXX": "my-compiler"})
    (tmp_path / compiler).touch(mode=0o755)
    assert "ziglang" not in run_hook(asked, **empty)


def test_zig_compiles_for_any_processor_and_an_old_glibc(tmp_path):
    """Unless told otherwise, it compiles for the processor and the library of this machine."""
    (tmp_path / "ziglang.py").touch()
    write = f"import kernels, pathlib; print(kernels.write_zig_scripts(pathlib.Path({str(tmp_path)!r})))"
    script = Path(run_hook(write, PYTHONPATH=str(tmp_path)).strip())
    assert os.access(script, os.X_OK) and {"ar", "ranlib"} < {*os.listdir(tmp_path)}
    assert "-mcpu=baseline" in script.read_text()
    if sys.platform == "linux":
        assert "-linux-gnu.2.28" in script.read_text() or "-linux-musl" in script.read_text()


def build_wheel(folder, kind):
    """Build a wheel without its kernels, and return what it holds by name."""
    hook = f"kernels.build_in_place = lambda: None; backend.build_{kind}({str(folder)!r}, options)"
    options = "{'wheel.cmake': 'false', 'wheel.py-api': 'py3'}"
    run_hook(f"import backend, kernels; options = {options}; {hook}")
    (wheel,) = folder.glob("*.whl")
    with zipfile.ZipFile(wheel) as opened:
        return {name: opened.read(name) for name in opened.namelist()}


def test_the_wheel_holds_the_tracked_files_of_the_package_and_no_others(tmp_path):
    listing = ["git", "ls-files", "facegear", "snakemake_logger_plugin_facegear"]
    tracked = subprocess.run(listing, cwd=ROOT, capture_output=True, text=True, check=True).stdout.split()
    inside = {name for name in build_wheel(tmp_path, "wheel") if ".dist-info/" not in name}
    assert inside == set(tracked)


def test_an_editable_install_is_a_path_in_which_the_plugin_is_found(tmp_path):
    """Snakemake lists the modules on the path; a finder that maps names to files would hide its plugin."""
    for name, content in build_wheel(tmp_path, "editable").items():
        if "/" not in name:
            (tmp_path / name).write_bytes(content)
    listed = f"import site, pkgutil; site.addsitedir({str(tmp_path)!r}); print(*pkgutil.iter_modules())"
    found = subprocess.run(
        [sys.executable, "-I", "-c", listed], cwd=tmp_path, capture_output=True, text=True, check=True
    )
    assert "name='snakemake_logger_plugin_facegear'" in found.stdout


@pytest.fixture
def copied(tmp_path):
    """Return a copy of the kernels in a checkout that holds nothing else, and how to import them."""
    copy = tmp_path / "facegear" / "_kernels"
    shutil.copytree(KERNELS, copy, ignore=shutil.ignore_patterns("__pycache__"))
    (tmp_path / "facegear" / "__init__.py").touch()
    (tmp_path / "CMakeLists.txt").touch()

    def load():
        return subprocess.run(
            [sys.executable, "-c", "import facegear._kernels"],
            env={**os.environ, "PYTHONPATH": str(tmp_path)},
            cwd=tmp_path,
            capture_output=True,
            text=True,
            check=False,
        ).stderr

    return copy, load


@pytest.mark.parametrize("change", ["edit", "add", "remove"])
def test_kernels_older_than_their_sources_are_refused_with_what_rebuilds_them(change, copied):
    copy, load = copied
    assert load() == ""
    source = copy / "src" / "simd.hpp"
    if change == "edit":
        source.write_text(source.read_text() + "\n")
    elif change == "add":
        (copy / "src" / "more.hpp").touch()
    else:
        source.unlink()
    line = load().splitlines()[-1]
    assert "older than their sources" in line and "make kernels" in line and "pip install -e ." in line


def test_kernels_that_were_never_built_say_how_to_build_them(copied):
    copy, load = copied
    for module in (*copy.glob("*.so"), *copy.glob("*.pyd")):
        module.unlink()
    line = load().splitlines()[-1]
    assert "cannot be loaded" in line and "make kernels" in line


def test_types_of_the_kernels_are_those_of_the_bindings():
    """The build writes them; `make lint` and users' type checkers read them (facegear/py.typed)."""
    from facegear._kernels import arithmetic

    stub = (KERNELS / "arithmetic.pyi").read_text()
    assert arithmetic.__name__.endswith(".arithmetic")
    for name in vars(arithmetic):
        assert name.startswith("__") or f"def {name}(" in stub
