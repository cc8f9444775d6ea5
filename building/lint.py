"""Check format (clang-format) and faults (clang-tidy) of the C++ sources: `python building/lint.py`."""

import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import kernels

SOURCES = kernels.ROOT / "facegear" / "_kernels" / "src"


def main() -> int:
    """Print what the two programs find; 0 if that is nothing."""
    files = sorted([*SOURCES.rglob("*.cpp"), *SOURCES.rglob("*.hpp")])
    commands = [["clang-format", "--dry-run", "--Werror", "--ferror-limit=1", *files]]
    if kernels.compiler_is_installed():
        # Headers are checked with the files that include them.
        tidy = ["clang-tidy", "--quiet", "-p", kernels.build_folder()]
        commands += [[*tidy, file] for file in files if file.suffix == ".cpp"]
    else:
        print("clang-tidy is left out: it needs the standard library of g++ or clang++")
    with ThreadPoolExecutor(2) as threads:
        return max(threads.map(report, commands))


def report(command: list[object]) -> int:
    """Run a command, print what it finds, and return its exit code."""
    program = kernels.find_program(str(command[0])) or str(command[0])
    done = subprocess.run([program, *map(str, command[1:])], capture_output=True, text=True, check=False)
    if done.returncode:
        print(done.stdout, done.stderr, sep="", flush=True)
    return done.returncode


if __name__ == "__main__":
    sys.exit(main())
