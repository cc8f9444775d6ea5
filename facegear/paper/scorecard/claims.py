"""What the paper claims: one record a number or statement, read from a data file."""

from pathlib import Path
from typing import Any

from pydantic import Field, model_validator

from facegear.config.base import Section, parse, refuse
from facegear.config.yaml_file import read_yaml

TORQUE, GEAR_DATA = "torque per engine", "gear data"


class Claim(Section):
    """One row of the scorecard.

    A claim with `paper` is a number that holds within `tolerance`; one without is a statement, which the
    criterion decides. `undisclosed` names inputs the paper leaves out that the row hangs on, `fitted` marks
    rows that the identification used, `reason` says why ours may differ.
    """

    id: str = Field(pattern=r"^[a-z0-9_]+$")
    where: str
    claim: str
    criterion: str
    args: dict[str, Any] = Field(default_factory=dict)
    paper: float | None = None
    unit: str = ""
    tolerance: float | None = Field(None, ge=0)
    fitted: bool = False
    undisclosed: tuple[str, ...] = ()
    reason: str = ""

    @model_validator(mode="after")
    def _number_has_tolerance(self) -> "Claim":
        if (self.paper is None) != (self.tolerance is None):
            refuse("tolerance", self.tolerance, "stands beside a paper value, and only there")
        return self

    @property
    def dynamic(self) -> bool:
        """Whether the row hangs on inputs of the dynamics that the paper leaves out."""
        return TORQUE in self.undisclosed and GEAR_DATA not in self.undisclosed


class Claims(Section):
    """All claims of one publication."""

    source: str
    claims: tuple[Claim, ...] = Field(min_length=1)

    @model_validator(mode="after")
    def _distinct(self) -> "Claims":
        names = [claim.id for claim in self.claims]
        double = sorted({name for name in names if names.count(name) > 1})
        if double:
            refuse("claims", double, "each claim needs an id of its own")
        return self


def read_claims(path: str | Path) -> Claims:
    """Read a claims file. Raises ConfigErrors with one line for every mistake."""
    return parse(Claims, read_yaml(path), source=str(path))
