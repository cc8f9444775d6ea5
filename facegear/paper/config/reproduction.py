"""The file that a config's key `reproduction` names: claims of a publication, and what it leaves out."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pydantic import Field

from facegear.config.base import Section, parse
from facegear.config.cases import changed_values, folder_name
from facegear.config.load import located
from facegear.config.yaml_file import read_yaml
from facegear.paper.config.sections import Identify


class Reproduction(Section):
    """What the results of a case are held against, and the search for what the publication leaves out."""

    claims: str = Field(min_length=1, description="its claims (yaml)")
    sets: str | None = Field(None, min_length=1, description="sets of undisclosed inputs that fit (csv)")
    runs: str | None = Field(None, min_length=1, description="runs of those sets and of the config (csv)")
    random: str | None = Field(None, min_length=1, description="claims held by random inputs (csv)")
    identify: Identify | None = None


def read_reproduction(path: str | Path) -> Reproduction:
    """Read and validate the file; the files it names are found from the working directory afterwards.

    Raises ConfigErrors with one line for every mistake.
    """
    read, folder = parse(Reproduction, read_yaml(path), str(path)), Path(path).parent
    return read.model_copy(
        update={
            "claims": located(read.claims, folder),
            **{
                key: None if (file := getattr(read, key)) is None else located(file, folder)
                for key in ("sets", "runs", "random")
            },
        }
    )


def design_points(identify: Identify | None) -> dict[str, dict[str, Any]]:
    """Folder name -> the keys it sets, for the other gear designs of the search."""
    designs = identify.designs if identify else ()
    return {folder_name(design.label): dict(design.set) for design in designs}


def design_cases(values: Mapping[str, Any], identify: Identify | None) -> dict[str, dict[str, Any]]:
    """Case id -> plain config values of each design, `<case>/designs/<name>`.

    Raises ConfigErrors naming the design.
    """
    cases = {}
    for name, changes in design_points(identify).items():
        case = f"{values['case']}/designs/{name}"
        cases[case] = {**changed_values(values, changes, f"identify.designs.{name}"), "case": case}
    return cases
