"""Claims of the paper: one record a number or statement, read from a data file."""

from pathlib import Path
from typing import Any, Literal

from pydantic import Field, model_validator

from facegear.schema.base import Section, parse, refuse
from facegear.schema.yaml_file import read_yaml

TORQUE, GEAR_DATA = "torque per engine", "gear data"
"""Names of undisclosed inputs: of the dynamics, and of the teeth."""


class Claim(Section):
    """One row of the scorecard.

    A claim with `paper` is a number that holds within `tolerance`; one without is a statement, which the
    criterion decides. `location` names the figure, table or text of the paper. `undisclosed_inputs` names the
    inputs that the paper leaves out and that the row depends on, `is_fitted` marks rows that the
    identification used, `reason` says why our value may differ. `same_as` names a row that gives the same
    number once more: totals count it once. `about: other studies` marks a remark on models that are not this
    one; it is judged, but apart from all totals.
    """

    id: str = Field(pattern=r"^[a-z0-9_]+$")
    location: str
    claim: str
    criterion: str
    args: dict[str, Any] = Field(default_factory=dict)
    paper: float | None = None
    unit: str = ""
    tolerance: float | None = Field(None, ge=0)
    is_fitted: bool = False
    same_as: str | None = None
    about: Literal["this model", "other studies"] = "this model"
    undisclosed_inputs: tuple[str, ...] = ()
    reason: str = ""

    @model_validator(mode="after")
    def _number_has_tolerance(self) -> "Claim":
        if (self.paper is None) != (self.tolerance is None):
            refuse("tolerance", self.tolerance, "given beside a paper value, and only there")
        return self

    @property
    def counts(self) -> bool:
        """Whether totals count the row: it is about this model and repeats no other."""
        return self.same_as is None and self.about == "this model"

    @property
    def dynamic(self) -> bool:
        """Whether the row is about this model and hangs on undisclosed inputs of its dynamics."""
        hangs = TORQUE in self.undisclosed_inputs and GEAR_DATA not in self.undisclosed_inputs
        return hangs and self.about == "this model"


class Claims(Section):
    """All claims of one publication."""

    source: str
    claims: tuple[Claim, ...] = Field(min_length=1)

    @model_validator(mode="after")
    def _distinct(self) -> "Claims":
        names = [claim.id for claim in self.claims]
        double = sorted({name for name in names if names.count(name) > 1})
        if double:
            refuse("claims", double, "ids that differ from claim to claim")
        unknown_ids = sorted({claim.same_as for claim in self.claims if claim.same_as} - set(names))
        if unknown_ids:
            refuse("claims", unknown_ids, "ids of other claims, as same_as names them")
        return self


def read_claims(path: str | Path) -> Claims:
    """Read a claims file.

    Parameters
    ----------
    path : str or Path
        Path of the file.

    Returns
    -------
    Claims
        All claims of the publication.

    Raises
    ------
    ConfigErrors
        With one line for every mistake.
    """
    return parse(Claims, read_yaml(path), source=str(path))
