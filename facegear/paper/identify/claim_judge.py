"""Which dynamic claims hold with other inputs than the config's."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Any

import pandas as pd

from facegear.paper.identify.perturbed import perturbed
from facegear.paper.identify.sets import set_cases
from facegear.paper.scorecard.claims import Claim
from facegear.paper.scorecard.criteria import reads_sweep
from facegear.paper.scorecard.rows import outcome_table
from facegear.paper.scorecard.set_tables import set_tables

ONE_MOTION: Mapping[str, Any] = MappingProxyType({"load_sharing.starts": 1})
"""Config keys of a run that is judged by its own motion alone, beside runs from other starts."""
QUICK: Mapping[str, Any] = MappingProxyType(
    {
        "dynamics.accuracy": {
            "tolerance": 1e-3,
            "refine": False,
            "extensions": 0,
            "longest_period": 8,
            "dwell_periods": 64,
            "settle_periods": 128,
            "window_periods": 64,
            "periodic_residual": 1e-4,
        },
        "dynamics.sweep.points": 200,
        "dynamics.sweep.jump_resolution_rpm": 25,
        "dynamics.sweep.accuracy": {
            "tolerance": 1e-3,
            "refine": False,
            "extensions": 0,
            "longest_period": 8,
            "dwell_periods": 32,
            "settle_periods": 48,
            "window_periods": 16,
            "periodic_residual": 1e-3,
            "samples_per_period": 32,
        },
        "load_sharing.cycles": 64,
        "load_sharing.samples_per_cycle": 128,
        **ONE_MOTION,
    }
)
"""Config keys of a quick run, four CPU seconds instead of fifty."""
GEOMETRIC: Mapping[str, Any] = MappingProxyType(
    {"transmission.mesh_kinematics": "geometric", "transmission.face_gear.mesh_radius_mm": None}
)
"""Config keys of the kinematics that gears have, for a config that has the printed ones."""

VALUE, SPREAD = "value", "spread"


@dataclass(frozen=True, eq=False)
class ClaimJudge:
    """Judges dynamic claims with other inputs of a config; `ltca` is its contact table, `settings` are config
    keys that are the same for all of them.
    """

    values: Mapping[str, Any]
    ltca: pd.DataFrame
    claims: Sequence[Claim]
    settings: Mapping[str, Any] = field(default_factory=dict)

    @property
    def names(self) -> list[str]:
        """Ids of the claims."""
        return [claim.id for claim in self.claims]

    def outcomes(self, row: Mapping[str, Any] | None, run: int = 0, start: int = 0) -> pd.DataFrame:
        """What the criteria find with the inputs of a row of a sets file, or with the config's own for None.

        Runs above 0 are perturbed by rounding, starts above 0 from rest at random. Raises FacegearError where
        the inputs have no result.
        """
        base, points = set_cases(self._needed, row, self.settings)
        moved = {key: perturbed(point, run) for key, point in points.items()}
        swept = any(reads_sweep(claim.criterion) for claim in self.claims)
        tables = set_tables(perturbed(base, run), moved, self.ltca, swept, start)
        return outcome_table(self.claims, tables)

    @property
    def _needed(self) -> dict[str, Any]:
        """The config's values with the studies that the claims are about."""
        named = {claim.args.get("study") for claim in self.claims}
        return {**self.values, "studies": [one for one in self.values["studies"] if one["name"] in named]}

    @property
    def deciding(self) -> list[Any]:
        """Plain values of all that decides what it finds; a change of one makes old findings worthless."""
        claims = [claim.model_dump(mode="json") for claim in self.claims]
        return [dict(self.values), dict(self.settings), claims, self.ltca.to_csv()]

    @property
    def columns(self) -> list[str]:
        """Columns of `found`."""
        numbers = [claim.id for claim in self.claims if claim.paper is not None]
        return [*self.names, *(f"{name} {what}" for name in numbers for what in (VALUE, SPREAD))]

    @property
    def without_sweep(self) -> "ClaimJudge":
        """The same for the claims that need no speed sweep."""
        return replace(self, claims=[one for one in self.claims if not reads_sweep(one.criterion)])

    def found(self, row: Mapping[str, Any], run: int = 0, start: int = 0) -> dict[str, float]:
        """For the inputs of a row: 1 for each claim that holds and 0 for each that does not, by its id; of a
        number also its value, and half its range over windows of the motion.

        A speed sweep begins at rest: what is read from it is NaN for other starts.
        """
        judge = self if start == 0 else self.without_sweep
        outcomes = judge.outcomes(row, run, start).set_index("id")
        found = dict(outcomes["holds"].astype(float))
        for what in (VALUE, SPREAD):
            found |= {f"{name} {what}": value for name, value in outcomes[what].astype(float).items()}
        return {name: found.get(name, float("nan")) for name in self.columns}
