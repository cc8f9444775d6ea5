"""Errors a user may meet. Each one's text is one clear line."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path


class FacegearError(Exception):
    """Base of all errors whose text is meant for the user."""


class ConfigError(FacegearError):
    """A config value that cannot be used.

    Attributes
    ----------
    key : str
        Dotted key of the config.
    value : object
        The value.
    requirement : str
        What the value must be, in words that follow "must be".
    """

    def __init__(self, key: str, value: object, requirement: str) -> None:
        super().__init__(f"{key} = {value!r}: must be {requirement}")
        self.key, self.value, self.requirement = key, value, requirement


class ConfigErrors(FacegearError):
    """All mistakes of one config file, one line each.

    Attributes
    ----------
    lines : tuple of str
        The mistakes, without the file's name.
    """

    def __init__(self, source: str, lines: Sequence[str]) -> None:
        super().__init__("\n".join(f"{source}: {line}" for line in lines))
        self.lines = tuple(lines)


class InvalidInput(FacegearError):
    """A quantity with which nothing can be computed.

    Where the inputs come from a config, the user reads the keys instead: `facegear.schema.base`.

    Attributes
    ----------
    quantity : str
        Name of the quantity in words.
    value : object
        The value.
    requirement : str
        What the value must be, in words that follow "must be". It may name other quantities in backticks.
    """

    def __init__(self, quantity: str, value: object, requirement: str) -> None:
        super().__init__(f"{quantity} = {value!r}: must be {requirement.replace('`', '')}")
        self.quantity, self.value, self.requirement = quantity, value, requirement


class GeometryError(InvalidInput):
    """A tooth design that cannot exist: the dimension of a part, its value and the limit that it breaks."""


class NotConverged(FacegearError):
    """A solver that did not reach its tolerance.

    Attributes
    ----------
    stage : str
        Name of the stage or solver.
    location : str
        Operating point at which it failed, such as a speed.
    attempts : str
        What was tried.
    """

    def __init__(self, stage: str, location: str, attempts: str) -> None:
        super().__init__(f"{stage} did not converge at {location}: {attempts}")
        self.stage, self.location, self.attempts = stage, location, attempts


class CorruptFile(FacegearError):
    """A stored file that is truncated, altered or not what its reader expects.

    Attributes
    ----------
    path : Path
        The file.
    problem : str
        What is wrong with it.

    Notes
    -----
    The text ends with the command `rebuild` that makes the file again, a forced run of Snakemake if None.
    """

    def __init__(self, path: str | Path, problem: str, rebuild: str | None = None) -> None:
        rebuild = rebuild or f"snakemake --cores 2 --force {path}"
        super().__init__(f"{path}: {problem}; rebuild it with: {rebuild}")
        self.path, self.problem = Path(path), problem


class MissingExtra(FacegearError):
    """A library that is installed only with an extra of the package.

    Attributes
    ----------
    library : str
        Name of the module.
    extra : str
        Name of the extra in `pyproject.toml`.
    """

    def __init__(self, library: str, extra: str) -> None:
        folder_text = "in the folder of facegear's sources"
        super().__init__(f'{library} is not installed; get it with: pip install ".[{extra}]" ({folder_text})')
        self.library, self.extra = library, extra


EXTRAS = {
    "skfem": "fe",
    "gmsh": "fe",
    "meshio": "fe",
    "jinja2": "workflow",
    "snakemake": "workflow",
    "pyarrow": "workflow",
    "pymoo": "search",
    "openpyxl": "excel",
    "trimesh": "exchange",
}
"""Modules that the core does without, and the extra that holds each."""


@contextmanager
def extras_named() -> Iterator[None]:
    """Raise MissingExtra in place of the import error of a library that an extra of the package brings.

    Yields
    ------
    None
        Once, to the block that imports the library.

    Raises
    ------
    MissingExtra
        If a library of EXTRAS is not installed.
    """
    try:
        yield
    except ModuleNotFoundError as error:
        library = (error.name or "").split(".")[0]
        if library not in EXTRAS:
            raise
        raise MissingExtra(library, EXTRAS[library]) from error


def plain_reason(error: Exception) -> str:
    """Return why a file cannot be read, without the system's number and the path.

    Parameters
    ----------
    error : Exception
        Error of the system or of a reader.

    Returns
    -------
    str
        The system's words in small letters, such as `no such file or directory`; the text of any other
        error.
    """
    return error.strerror.lower() if isinstance(error, OSError) and error.strerror else str(error)


def file_path(value: object, argument: str = "path") -> Path:
    """Return a path from the argument of a user.

    Parameters
    ----------
    value : object
        The argument, text or a path; the file need not exist.
    argument : str
        Name of the argument.

    Returns
    -------
    Path
        The path.

    Raises
    ------
    FacegearError
        For anything but text or a path, and for an empty text.
    """
    if not isinstance(value, str | Path) or not str(value):
        raise FacegearError(f"{argument} = {value!r}: must be the name of a file or folder")
    return Path(value)


def require_choice(name: str, choices: Sequence[str], quantity: str) -> str:
    """Return a name, or refuse it if it is not one of the choices.

    Parameters
    ----------
    name : str
        The name.
    choices : Sequence[str]
        Names that are allowed.
    quantity : str
        Meaning of the name, for the message.

    Returns
    -------
    str
        The name.

    Raises
    ------
    FacegearError
        For any other name, in one line with all choices.
    """
    if name not in choices:
        raise FacegearError(f"{quantity} = {name!r}: must be one of {', '.join(choices)}")
    return name
