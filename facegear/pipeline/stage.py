"""Types of a row of the table of stages."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from importlib import import_module
from pathlib import Path, PurePosixPath
from types import MappingProxyType
from typing import Any, Literal

from facegear.io.atomic import MANIFEST_SUFFIX

Values = Mapping[str, Any]
"""Plain values of a whole config."""
Wildcards = Mapping[str, str]
NO_WILDCARDS: Mapping[str, Any] = MappingProxyType({})
"""Wildcards of a file that has none."""
READABLE = {".csv", ".npz", ".parquet", ".json"}
"""Endings of files that stages can read again."""
FIGURES = "_figures"
"""Ending of the name of a rule that draws the figures of a chapter."""
NUMBER = r"\d+"
"""A wildcard that stands for a number is handed to the stage as one."""


MACHINE_INPUTS = "facegear.build.machine:MachineInputs"
"""Class that holds everything that decides what a machine is."""


@dataclass(frozen=True)
class Case:
    """A case, which is one machine of a config: the config's own or a point of one of its studies.

    - values: plain values of its whole config
    - cases: values of all cases of the config by case id
    - source: function of stage name and case id that returns the id of the case whose files of the
      stage that case shares
    """

    values: Values
    cases: Mapping[str, Values] = field(default_factory=dict)
    source: Callable[[str, str], str] = lambda stage, case: case


@dataclass(frozen=True)
class ComputedValue:
    """A need whose value follows from some sections of the config by a function of the case; it depends
    on nothing else.
    """

    function: Callable[[Case], Any]
    sections: tuple[str, ...]


Need = str | tuple[str, ...] | ComputedValue
"""A dotted key of the config, several of them as a section of their own, or what follows from sections."""
Needs = Mapping[str, Need]
"""Arguments from the config by name."""


def load(reference: str) -> Any:
    """Import the object that `module:name` names.

    An object named this way does not count as an import of the module that names it.

    Parameters
    ----------
    reference : str
        `module:name`.

    Returns
    -------
    Any
        The object.
    """
    module, _, name = reference.partition(":")
    return getattr(import_module(module), name)


@dataclass(frozen=True)
class File:
    """One file of a stage below a case's folder.

    - path: may hold wildcards of the stage, in braces
    - holds: columns of a table, shapes of arrays or keys of a record that its reader asks for, or the
      `module:name` that holds them; numbers of such columns are finite
    - text: columns that stay text
    - view, of: `module:function` that makes the file's content from the part `of`, for other programs
    - each_text: where the stage writes several such files, the text that stands for `{each}` in each path
    """

    path: str
    holds: Mapping[str, tuple[int | None, ...]] | Sequence[str] | str = ()
    may_be_empty: bool = False
    text: Sequence[str] = ()
    view: str = ""
    of: str = ""
    each_text: Callable[[Case], Sequence[str]] | None = None

    @property
    def readable(self) -> bool:
        """Whether stages read it again: its ending is in READABLE and it is a single file."""
        return PurePosixPath(self.path).suffix in READABLE and self.each_text is None

    def at(self, wildcards: Wildcards = NO_WILDCARDS) -> str:
        """Return the path with wildcards filled in.

        Parameters
        ----------
        wildcards : Wildcards
            Text of each wildcard by name.

        Returns
        -------
        str
            Path below the case's folder, such as `dynamics/chunks/up_0.npz`.
        """
        return self.path.format(**wildcards)

    def read(self, path: Path) -> Any:
        """Read the stored content, after a check of its checksum, columns, shapes and finite values.

        Parameters
        ----------
        path : Path
            Path of the file.

        Returns
        -------
        Any
            A table, arrays or a record.

        Raises
        ------
        CorruptFile
            If the file is missing, altered or lacks something.
        """
        from facegear.io.files import read_part  # pandas: the table of stages is read without it

        holds = load(self.holds) if isinstance(self.holds, str) else self.holds
        return read_part(path, holds, self.may_be_empty, self.text)


@dataclass(frozen=True)
class From:
    """Source of an argument: a file of an earlier stage.

    - wildcards: values of that stage's wildcards
    - each_wildcards: instead, several of them; the argument is then a list. A wildcard `case` names
      another case
    - when: whether the argument is given at all
    """

    stage: str
    file: str
    wildcards: Wildcards = field(default_factory=dict)
    each_wildcards: Callable[[Case], Sequence[Wildcards]] | None = None
    when: Callable[[Case], bool] | None = None

    def is_needed(self, case: Case) -> bool:
        """Whether the argument is given in a case; otherwise the stage's function takes its default.

        Parameters
        ----------
        case : Case
            The case.

        Returns
        -------
        bool
            True if so.
        """
        return self.when is None or self.when(case)

    def file_wildcards(self, case: Case) -> Sequence[Wildcards]:
        """Return the wildcards of each file that is read.

        Parameters
        ----------
        case : Case
            The case.

        Returns
        -------
        Sequence[Wildcards]
            Wildcards of each file that is read; one entry unless `each_wildcards` lists several.
        """
        return [self.wildcards] if self.each_wildcards is None else self.each_wildcards(case)


def from_stage(stage: str, *files: str) -> dict[str, From]:
    """Return arguments that are files of an earlier stage, under the names that these have there.

    Parameters
    ----------
    stage : str
        Name of the earlier stage.
    *files : str
        Names of its files.

    Returns
    -------
    dict[str, From]
        Source of each argument by name, which is the name of the file.
    """
    return {file: From(stage, file) for file in files}


@dataclass(frozen=True, kw_only=True)
class Figures:
    """Figures drawn from stored files alone.

    - draw: `module:function` giving as many figures as there are `names`
    - chapter: of the report, and caption in workflow/report
    """

    draw: str
    names: Sequence[str] | Callable[[Case], Sequence[str]]
    chapter: str
    upstream: Mapping[str, From]
    needs: Needs = field(default_factory=dict)
    memory_mb: int | None = None

    def figure_names(self, case: Case) -> Sequence[str]:
        """Return the names of all figures that are drawn.

        Parameters
        ----------
        case : Case
            The case.

        Returns
        -------
        Sequence[str]
            The names, also file names without ending; fixed or a function of the case.
        """
        return self.names(case) if callable(self.names) else self.names


@dataclass(frozen=True, kw_only=True)
class Stage:
    """One stage: function `facegear.pipeline.stages.<module>.<name>`, what it takes and what it writes.

    - module: where the function is, that of its own name where left out
    - needs: its arguments from the config; nothing else of it decides a result
    - upstream: its arguments from earlier stages
    - wildcards: of its files beside the case, as regular expressions; they are arguments, too
    - condition: whether a plain run of a case makes it; one without is made where another stage takes from
      it, or where its file is asked for by name
    - section: optional section of the config without which there is nothing to do
    - resumable: file beside which finished parts are kept, so that a killed job goes on after the last
    - machine: "machine" where the stage takes the machine in motion or at rest, built of its inputs; "inputs"
      where it builds machines itself; the arguments that are fields of MACHINE_INPUTS go into them
    - together: cases of studies that one job makes, where a case takes about a second
    - local: short enough for the computer that submits jobs to a cluster
    - priority: long jobs, and those that long ones wait for, start first; figures (0) wait for all of them
    """

    name: str
    title: str
    module: str = ""
    needs: Needs = field(default_factory=dict)
    upstream: Mapping[str, From] = field(default_factory=dict)
    files: Mapping[str, File] = field(default_factory=dict)
    figures: Figures | None = None
    wildcards: Mapping[str, str] = field(default_factory=dict)
    condition: Callable[[Case], bool] | None = None
    section: str = ""
    resumable: str = ""
    machine: Literal["", "machine", "inputs"] = ""
    folder: str = ""
    memory_mb: int | None = None
    minutes: int | None = None
    together: int = 1
    local: bool = False
    priority: int = 10

    @property
    def function(self) -> str:
        """Location of the stage's function, as ``module:function``."""
        return f"facegear.pipeline.stages.{self.module or self.name}:{self.name}"

    @property
    def functions(self) -> tuple[str, ...]:
        """Functions and classes whose code decides its files, as ``module:name``: its own, views of
        files, the machine's.
        """
        views = [file.view for file in self.files.values() if file.view]
        return (self.function, *views, *([MACHINE_INPUTS] if self.machine else []))

    @property
    def manifest(self) -> str:
        """Path of the record beside its files below a case's folder, with wildcards in braces."""
        paths = [PurePosixPath(file.path) for file in self.files.values()]
        name = "_".join([self.name, *(f"{{{wildcard}}}" for wildcard in self.wildcards)])
        return f"{paths[0].parent if paths else self.folder}/{name}{MANIFEST_SUFFIX}"

    @property
    def readable(self) -> dict[str, File]:
        """Files that stages read again, by name."""
        return {name: file for name, file in self.files.items() if file.readable}

    def typed_wildcards(self, wildcards: Wildcards) -> dict[str, Any]:
        """Convert wildcards to arguments of the stage's function.

        Parameters
        ----------
        wildcards : Wildcards
            Text of each wildcard by name.

        Returns
        -------
        dict[str, Any]
            Integers for wildcards that stand for a number, text for the others.
        """
        types = self.wildcards
        return {name: int(text) if types[name] == NUMBER else text for name, text in wildcards.items()}
