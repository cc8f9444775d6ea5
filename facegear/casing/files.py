"""Matrices of a casing from the files of finite-element programs, told apart by their names and first
lines.
"""

from collections.abc import Mapping, Sequence
from hashlib import sha256
from pathlib import Path
from typing import NoReturn

from facegear.arrays import Array, Integers
from facegear.casing.whole import WholeCasing, whole_casing
from facegear.errors import InvalidInput
from facegear.io.matrices import abaqus, calculix, nastran, native
from facegear.io.matrices.labelled_matrix import LabelledMatrix, MatrixFault, read_lines

QUANTITIES = ("stiffness", "mass", "damping")
"""Matrices of a casing."""
MATRIX_MARKET = "%%MatrixMarket"
"""First letters of a Matrix Market file, which shares its ending with those of Abaqus."""
OWN_NODES = (".npz",)
"""Endings of files that may hold the list of nodes."""
ENDINGS = (".csv", ".npz", ".pch", ".dmig", ".mtx", ".sti", ".mas")
"""Endings of files that hold a matrix."""
NUMBERS_ALONE = (".csv", ".mtx")
"""Endings of files that may hold numbers alone, whose rows a list of dofs names."""


def read_casing(files: Mapping[str, str | None], units: str) -> WholeCasing:
    """Read a casing from its files.

    Parameters
    ----------
    files : mapping of str to str or None
        Names of files by `stiffness`, `mass`, `damping`, `nodes` and `dofs`. Mass and damping of None are
        taken from the file of the stiffness where it holds them, those of CalculiX from the file `.mas`
        beside it.
    units : str
        `mm_t_s` or `si`: of the matrices. Nodes are in mm.

    Returns
    -------
    WholeCasing
        SI units, in the file's axes.

    Raises
    ------
    InvalidInput
        For the first file that cannot be used, with the reason.
    """
    stiffness_name = files["stiffness"]
    assert stiffness_name is not None
    dofs = _read_dofs(files.get("dofs"))
    matrices: dict[str, LabelledMatrix | None] = {}
    for quantity in QUANTITIES:
        name = files.get(quantity) or _beside(stiffness_name, quantity)
        matrices[quantity] = None if name is None else _read_matrix(name, quantity, dofs)
        if matrices[quantity] is None and files.get(quantity):
            _refuse(quantity, name or "", f"it holds no {quantity}")
    stiffness = matrices["stiffness"]
    if stiffness is None:
        _refuse("stiffness", stiffness_name, "it holds no stiffness")
    nodes = _read_nodes(files.get("nodes"), stiffness_name)
    return whole_casing(stiffness, matrices["mass"], matrices["damping"], nodes, units)


def content_of(names: Sequence[str]) -> str:
    """Return a digest of the content of files, by which results are found again.

    Parameters
    ----------
    names : sequence of str
        Names of files.

    Returns
    -------
    str
        64 hexadecimal digits.

    Raises
    ------
    OSError
        For a file that cannot be read.
    """
    digest = sha256()
    for name in names:
        with open(name, "rb") as stream:
            while block := stream.read(1 << 20):
                digest.update(block)
        digest.update(b"\0")
    return digest.hexdigest()


def files_of(files: Mapping[str, str | None]) -> list[str]:
    """Return the names of all files that `read_casing` reads.

    Parameters
    ----------
    files : mapping of str to str or None
        As in `read_casing`.

    Returns
    -------
    list of str
        Each once, in a fixed order.
    """
    names = [name for name in files.values() if name]
    stiffness = files["stiffness"] or ""
    names += [name for quantity in QUANTITIES if (name := _beside(stiffness, quantity))]
    if stiffness.endswith((".sti", ".mas")):
        names.append(str(Path(stiffness).with_suffix(".dof")))
    return list(dict.fromkeys(names))


def _beside(stiffness: str, quantity: str) -> str | None:
    """Return the file in which a quantity stands that has no file of its own; None where it cannot stand."""
    path = Path(stiffness)
    if quantity == "stiffness":
        return stiffness
    if path.suffix == ".sti":
        stored_file = path.with_suffix(calculix.ENDINGS.get(quantity, ".none"))
        return str(stored_file) if stored_file.is_file() else None
    if path.suffix in (".npz", ".pch", ".dmig") or (path.suffix == ".mtx" and _is_substructure(path)):
        return stiffness
    return None


def _is_substructure(path: Path) -> bool:
    """Return whether a file .mtx is a substructure of Abaqus or CalculiX, which holds several matrices."""
    try:
        with open(path, encoding="ascii", errors="replace") as stream:
            return any(
                line.upper().startswith("*USER ELEMENT") for _, line in zip(range(50), stream, strict=False)
            )
    except OSError:
        return False


def _read_matrix(name: str, quantity: str, dofs: tuple[Integers, Integers] | None) -> LabelledMatrix | None:
    """Return a matrix of a file, None where it holds none of that quantity; refuse a file that is not
    valid.
    """
    path = Path(name)
    try:
        match path.suffix.lower():
            case ".pch" | ".dmig":
                return nastran.read_dmig(path, quantity)
            case ".sti" | ".mas":
                return calculix.read_stored(path)
            case ".npz":
                return native.npz_matrix(path, quantity, dofs)
            case ".csv":
                return native.read_csv(path, _require_dofs(dofs))
            case ".mtx":
                return _read_mtx(path, quantity, dofs)
            case ".op4":
                raise MatrixFault("op4 does not name its rows; write DMIG (.pch), or csv with a list of dofs")
            case _:
                raise MatrixFault(f"its ending must be one of {', '.join(ENDINGS)}")
    except MatrixFault as fault:
        _refuse(quantity, name, str(fault))


def _read_mtx(path: Path, quantity: str, dofs: tuple[Integers, Integers] | None) -> LabelledMatrix | None:
    """Return a matrix of a file .mtx: Matrix Market, a substructure, or entries by node and dof."""
    first = next(line for line in read_lines(path) if line.strip())
    if first.startswith(MATRIX_MARKET):
        return native.read_matrix_market(path, _require_dofs(dofs))
    if _is_substructure(path):
        return abaqus.read_substructure(path, quantity)
    return abaqus.read_coordinates(path)


def _require_dofs(dofs: tuple[Integers, Integers] | None) -> tuple[Integers, Integers]:
    """Return the list of dofs; refuse a matrix of numbers alone without it."""
    if dofs is None:
        raise MatrixFault("it holds numbers alone; `dofs` must name node and dof of each row")
    return dofs


def _read_dofs(name: str | None) -> tuple[Integers, Integers] | None:
    """Return the list of dofs from a csv file or a file `.dof` of CalculiX; None for no file."""
    if name is None:
        return None
    try:
        path = Path(name)
        return calculix.read_dofs(path) if path.suffix == ".dof" else native.read_dofs(path)
    except MatrixFault as fault:
        _refuse("dofs", name, str(fault))


def _read_nodes(name: str | None, stiffness: str) -> tuple[Integers, Array, list[str]]:
    """Return the list of nodes: of its own file, else of the file of the stiffness."""
    if name is None and not stiffness.endswith(OWN_NODES):
        _refuse("nodes", None, "given: a csv file with the columns node, x_mm, y_mm, z_mm")
    name = name or stiffness
    try:
        return native.read_nodes(Path(name))
    except MatrixFault as fault:
        _refuse("nodes", name, str(fault))


def _refuse(quantity: str, name: str | None, reason: str) -> NoReturn:
    """Refuse the file of a quantity."""
    requirement = reason if name is None else f"a file that can be used: {reason}"
    raise InvalidInput(f"{quantity} of the casing", name, requirement)
