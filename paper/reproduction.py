"""The file that a config's key `reproduction` names: claims of a publication, and stored results."""

from pathlib import Path

from pydantic import Field

from facegear.build.load import relative_to_cwd
from facegear.schema.base import Section, parse
from facegear.schema.yaml_file import read_yaml


class InputSet(Section):
    """Inputs for what the publication leaves out, in a config of their own."""

    label: str = Field(min_length=1, description="what they are called on the page of the figures")
    case: str = Field(min_length=1, description="case of that config, the folder of its results")
    config: str = Field(min_length=1, description="name of the config from the folder of the Snakefile")
    note: str = Field("", description="what its page says of them: whether they were fitted, what they hold")


class Reproduction(Section):
    """Claims of a publication and stored results, with which the results of a case are compared."""

    claims: str = Field(min_length=1, description="its claims (yaml)")
    sets: str | None = Field(None, min_length=1, description="sets of undisclosed inputs that fit (csv)")
    runs: str | None = Field(None, min_length=1, description="runs of those sets and of the config (csv)")
    inputs: tuple[InputSet, ...] = Field((), description="whose figures one may switch between")
    random: str | None = Field(None, min_length=1, description="claims held by random inputs (csv)")


def read_reproduction(path: str | Path) -> Reproduction:
    """Read and validate the file.

    Paths of the files that it names are returned as they are found from the working directory.

    Parameters
    ----------
    path : str or Path
        Path of the file.

    Returns
    -------
    Reproduction
        Its content.

    Raises
    ------
    ConfigErrors
        With one line for every mistake.
    """
    read, folder = parse(Reproduction, read_yaml(path), str(path)), Path(path).parent
    files = {key: file for key, file in read.model_dump(exclude={"inputs"}).items() if file is not None}
    return read.model_copy(update={key: relative_to_cwd(file, folder) for key, file in files.items()})
