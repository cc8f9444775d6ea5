"""Check that gmsh's system libraries load, and print the apt line that mends it if not."""

import ctypes
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
    """Debian packages whose library does not load on this machine."""
    return [package for library, package in PACKAGES.items() if not _loads(library)]


def main() -> int:
    """Print what is missing in one line; 0 if gmsh imports."""
    try:
        import gmsh  # noqa: F401
    except OSError as error:
        packages = missing_packages()
        if not packages:
            print(f"gmsh does not load: {error}", file=sys.stderr)
            return 1
        print(
            "gmsh needs system libraries that are missing here; install them with: "
            f"apt-get install -y {' '.join(packages)}",
            file=sys.stderr,
        )
        return 1
    return 0


def _loads(library: str) -> bool:
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
