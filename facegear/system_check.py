"""Check that gmsh's system libraries and the compiled kernels load, and print what mends it if not."""

import ctypes.util
import sys

PACKAGES = {
    "GLU": "libglu1-mesa",
    "GL": "libgl1",
    "Xrender": "libxrender1",
    "Xcursor": "libxcursor1",
    "Xfixes": "libxfixes3",
    "Xext": "libxext6",
    "Xft": "libxft2",
    "fontconfig": "libfontconfig1",
    "Xinerama": "libxinerama1",
    "X11": "libx11-6",
    "gomp": "libgomp1",
}
"""Shared libraries the gmsh wheel needs, and the Debian packages that hold them."""


def missing_packages() -> list[str]:
    """Return the Debian packages of PACKAGES whose shared library does not load on this machine.

    Returns
    -------
    list of str
        Names of the packages, empty if all libraries load.
    """
    return [package for library, package in PACKAGES.items() if not _loads(library)]


def kernels_origin() -> str:
    """Return one or two sentences on which compiler built the compiled kernels.

    Returns
    -------
    str
        Compiler and level of processor instructions that are used here; if zig built the kernels, which
        compilers build them faster.
    """
    from facegear import _kernels  # where they do not load, `main` says so in one line

    sentence = f"The kernels were compiled by {_kernels.COMPILER}; those for {_kernels.LEVEL} run here."
    if _kernels.COMPILER.startswith("zig"):
        sentence += " They build sooner with g++ (apt-get install -y g++) or clang++."
    return sentence


def main() -> int:
    """Print which compiler built the kernels, or what is missing in one line.

    Returns
    -------
    int
        Exit code: 0 if gmsh and the kernels load, else 1.
    """
    try:
        import gmsh  # noqa: F401 - what is checked here

        print(kernels_origin())
    except ImportError as error:
        return _complain(str(error))
    except OSError as error:
        packages = missing_packages()
        if not packages:
            return _complain(f"gmsh does not load: {error}")
        return _complain(
            "gmsh needs system libraries that are missing here; install them with: "
            f"apt-get install -y {' '.join(packages)}"
        )
    return 0


def _complain(line: str) -> int:
    """Print a line to standard error and return exit code 1."""
    print(line, file=sys.stderr)
    return 1


def _loads(library: str) -> bool:
    """Return whether a shared library is found and can be loaded, by its name without `lib` and ending."""
    name = ctypes.util.find_library(library)
    if name is None:
        return False
    try:
        ctypes.CDLL(name)
    except OSError:
        return False
    return True


if __name__ == "__main__":
    sys.exit(main())
