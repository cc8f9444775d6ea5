"""Build the compiled kernels beside their sources: `python building/kernels.py`.

Where a machine has no C++ compiler, the kernels are compiled by zig, which the package index has (`ziglang`).
"""

import importlib.util
import os
import platform
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
COMPILERS = ("c++", "g++", "clang++")
"""Names under which CMake finds a compiler; Visual Studio and `CXX` it finds without a name."""
GLIBC = "2.28"
"""Oldest glibc for which zig compiles: that of the wheels of numpy and scipy."""
ADVICE = "`apt-get install g++`, or a compiler named by CXX, builds them sooner"


def compiler_is_installed() -> bool:
    """Return whether CMake finds a C++ compiler on this machine."""
    return bool(os.environ.get("CXX")) or os.name == "nt" or any(map(shutil.which, COMPILERS))


def write_zig_scripts(folder: Path) -> Path:
    """Write scripts that call zig as compiler and archiver into a folder, and return the compiler's.

    CMake looks for the archiver beside the compiler. Unless told otherwise, zig compiles for the processor of
    this machine, and its own C++ library for each level of optimisation anew.
    """
    if importlib.util.find_spec("ziglang") is None:
        raise SystemExit("There is no C++ compiler: install g++ or clang++, or `pip install ziglang`")
    compile_for = "-O3 -s -Qunused-arguments -mcpu=baseline"
    if sys.platform == "linux":
        library = "musl" if "musl" in sysconfig.get_config_var("SOABI") else f"gnu.{GLIBC}"
        compile_for += f" -target {platform.machine()}-linux-{library}"
    commands = {"zig-c++": f"c++ {compile_for}", "ar": "ar", "ranlib": "ranlib"}
    folder.mkdir(parents=True, exist_ok=True)
    for name, command in commands.items():
        script = folder / name
        script.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m ziglang {command} "$@"\n')
        script.chmod(0o755)
    return folder / "zig-c++"


def choose_compiler(folder: Path) -> None:
    """Set CXX to zig's script in a folder, where this machine has no compiler."""
    if not compiler_is_installed():
        os.environ["CXX"] = str(write_zig_scripts(folder))
        os.environ.setdefault("ZIG_GLOBAL_CACHE_DIR", str(folder / "cache"))


def build_folder() -> Path:
    """Return the folder in which the kernels are compiled for this Python, by a compiler or by zig."""
    return ROOT / "build" / f"{sys.implementation.cache_tag}-{'cxx' if compiler_is_installed() else 'zig'}"


def build_in_place() -> None:
    """Compile what has changed, and put the modules and their types beside their sources."""
    folder = build_folder()
    if not folder.exists() and not compiler_is_installed():
        print(f"There is no g++ or clang++: the kernels are compiled by zig ({ADVICE}).", flush=True)
    choose_compiler(ROOT / "build" / "zig")
    build(folder, ROOT)


def build(folder: Path, prefix: Path, *definitions: str) -> None:
    """Compile what has changed since the last build in a folder, and install it below a prefix."""
    cmake, ninja = find_program("cmake"), find_program("ninja")
    if cmake is None:
        raise SystemExit("The kernels need CMake: `make kernels` installs it, and `pip install -e .`")
    options = [f"-DPython_EXECUTABLE={sys.executable}", "-DCMAKE_BUILD_TYPE=Release", *definitions]
    if ninja:
        options += ["-G", "Ninja", f"-DCMAKE_MAKE_PROGRAM={ninja}"]
    run(cmake, "-S", ROOT, "-B", folder, *options)
    run(cmake, "--build", folder, "--config", "Release", "--parallel", os.cpu_count() or 1)
    run(cmake, "--install", folder, "--config", "Release", "--prefix", prefix)


def find_program(name: str) -> str | None:
    """Return the path of a program of this environment, or else of the machine."""
    return shutil.which(name, path=os.path.dirname(sys.executable)) or shutil.which(name)


def run(*command: object) -> None:
    """Run a command, and show what it printed if it fails."""
    done = subprocess.run([*map(str, command)], capture_output=True, text=True, check=False)
    if done.returncode:
        raise SystemExit(f"{done.stdout}{done.stderr}The kernels could not be built: {command[0]} failed.")


if __name__ == "__main__":
    if sys.argv[1:] == ["--has-compiler"]:
        sys.exit(not compiler_is_installed())
    if sys.argv[1:2] == ["--zig"]:  # for wheels that run on older systems than this one
        print(write_zig_scripts(Path(sys.argv[2]).resolve()))
    else:
        build_in_place()
