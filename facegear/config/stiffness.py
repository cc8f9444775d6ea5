"""Config section `mesh_stiffness`: where the lumped model's k(t) comes from."""

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field, model_validator

from facegear.config.base import Section, refuse
from facegear.config.csv_file import CsvFault, CsvRow, read_numbers
from facegear.harmonics.fit import fit_harmonics
from facegear.harmonics.series import Harmonics
from facegear.stiffness.request import StiffnessRequest

MAX_ORDER = 512
SOFTEST = 1e5
"""Mean stiffness (N/m) below which no pair of gears is: a pinion of 1 mm in plastic has ten times as much."""
SAME_MEAN = 1e-6
"""Relative difference up to which two given means count as one."""

Amplitude = Annotated[float, Field(ge=-1e12, le=1e12)]


class HarmonicSection(Section):
    """One order of k(t) = sum a sin(order w t) + b cos(order w t); order 0 is the mean, its a is 0."""

    order: int = Field(ge=0, le=MAX_ORDER)
    a_n_per_m: Amplitude = 0.0
    b_n_per_m: Amplitude = 0.0


COLUMNS = tuple(HarmonicSection.model_fields)
CURVE = ("pinion_angle_deg", "k_n_per_m")
"""Columns of a csv that holds k over the pinion's angle instead, as `StiffnessResult.over_angle` gives it."""
EVEN = 1e-6
"""Part of a step by which the angles of a curve may differ from even ones."""


class MeshStiffness(Section):
    """Source of the mesh stiffness, its mean, and what is kept of its shape."""

    source: Literal["fem", "fem_scaled", "harmonics"] = Field(
        default="fem",
        description="fem: as computed at torque_n_m; fem_scaled: that shape with the mean given here; "
        "harmonics: given below",
    )
    mean_n_per_m: float | None = Field(
        default=None,
        gt=0,
        le=1e12,
        description="fem_scaled: required; harmonics: required unless order 0 gives it; fem: for the modes "
        "only, which take the computed mean without it",
    )
    torque_n_m: float | None = Field(
        default=None,
        gt=0,
        le=1e7,
        description="load on the pinion per mesh at which k is taken, within contact.torques_n_m; null: the "
        "largest of them",
    )
    mesh_law: Literal["constant_load", "load_dependent"] = Field(
        default="constant_load",
        description="constant_load: force is k(t) times the deflection, whatever the load; load_dependent: "
        "as contact gives it at every deflection, up to the largest of contact.torques_n_m, and fem_scaled "
        "scales all of it",
    )
    definition: Literal["average", "local"] = Field(
        default="average", description="F / deflection, or its slope dF / d deflection at that load"
    )
    harmonics_kept: int = Field(default=8, ge=0, le=MAX_ORDER)
    variation: float = Field(
        default=1.0, ge=0, le=100, description="factor on k(t) about its mean; 1: as computed or given"
    )
    table: tuple[HarmonicSection, ...] = Field(
        default=(), max_length=MAX_ORDER + 1, description="for source harmonics: orders rising"
    )
    csv: str | None = Field(
        default=None,
        min_length=1,
        description="for source harmonics, instead of table: a file with the columns order, a_n_per_m, "
        "b_n_per_m, or pinion_angle_deg, k_n_per_m over one pitch of the pinion; its path counts from this "
        "file's folder",
    )
    csv_pitch_deg: float | None = Field(
        default=None,
        gt=0,
        exclude=True,
        description="left out: the pitch that the angles of a csv cover, which must be that of the pinion",
    )

    @model_validator(mode="before")
    @classmethod
    def _read(cls, values: Any) -> Any:
        """A csv is read here, so that a fault in it is reported with all others before any work."""
        if not isinstance(values, Mapping):
            return values
        if isinstance(values.get("table"), list):
            values = {**values, "table": tuple(values["table"])}
        if not isinstance(name := values.get("csv"), str):
            return values
        if values.get("table"):
            refuse("csv", name, "either csv or table, not both")
        if values.get("source") != "harmonics":
            refuse("csv", name, "left out unless source is harmonics")
        try:
            table, pitch = _given(name)
        except CsvFault as fault:
            refuse("csv", name, f"a csv of numbers; {fault}")
        return {**values, "csv": None, "table": table, "csv_pitch_deg": pitch}

    @model_validator(mode="after")
    def _complete(self) -> "MeshStiffness":
        if self.source != "harmonics" and self.table:
            refuse("source", self.source, "harmonics, as a table is given")
        if self.source == "fem_scaled" and self.mean_n_per_m is None:
            refuse("mean_n_per_m", None, "given, as source fem_scaled scales the curve to it")
        if self.mesh_law == "load_dependent":
            _check_law(self)
        if self.source != "harmonics":
            return self
        if not self.table:
            refuse("table", [], "given, here or in csv, where source is harmonics")
        for number, (terms, following) in enumerate(pairwise(self.table)):
            if following.order <= terms.order:
                refuse(f"table[{number + 1}].order", following.order, "above the order before it")
        _check_mean(self.mean_n_per_m, self.table[0])
        if (mean := self.mean) is not None and mean < SOFTEST:
            allowed = f"at least {SOFTEST:g} N/m; values in N/um are a million times too small"
            refuse("csv or table" if self.mean_n_per_m is None else "mean_n_per_m", mean, allowed)
        minimum = given_series(self).kept(self.harmonics_kept).varied(self.variation).minimum
        if minimum <= 0.0:
            condition = "harmonics so small beside the mean that k(t) stays positive"
            refuse("table", f"k(t) falls to {minimum:.4g} N/m", condition)
        return self

    @property
    def mean(self) -> float | None:
        """The mean that is given, N/m: by its key, or by order 0 of the harmonics."""
        zeroth = self.table[0].b_n_per_m if self.table and self.table[0].order == 0 else None
        return self.mean_n_per_m if zeroth is None else zeroth


def given_series(section: MeshStiffness) -> Harmonics:
    """The series written in the config (N/m), its mean included."""
    order = max((row.order for row in section.table), default=0)
    a, b = np.zeros(order + 1), np.zeros(order + 1)
    for row in section.table:
        a[row.order], b[row.order] = row.a_n_per_m, row.b_n_per_m
    b[0] = section.mean or 0.0
    return Harmonics(a, b)


def stiffness_request(section: MeshStiffness) -> StiffnessRequest:
    """What is asked of the stiffness stage, with the series written in the config if there is one."""
    return StiffnessRequest(
        source=section.source,
        mean=section.mean,
        torque=section.torque_n_m,
        definition=section.definition,
        kept=section.harmonics_kept,
        variation=section.variation,
        given=given_series(section),
    )


def _check_law(section: MeshStiffness) -> None:
    """Only contact knows the load, and its law has no variation to be changed by itself."""
    if section.source == "harmonics":
        refuse("mesh_law", "load_dependent", "constant_load, where source is harmonics")
    if section.variation != 1.0:
        refuse("variation", section.variation, "1, where mesh_law is load_dependent")


def _check_mean(mean: float | None, first: HarmonicSection) -> None:
    """The mean comes from the key or from order 0 of the harmonics; where both stand, they agree."""
    if first.order > 0:
        if mean is None:
            refuse("mean_n_per_m", None, "given, as the harmonics have no order 0, which is the mean")
        return
    if first.a_n_per_m != 0.0 or first.b_n_per_m <= 0.0:
        given = [first.a_n_per_m, first.b_n_per_m]
        refuse("table", given, "0 for a_n_per_m of order 0, and the mean, above 0, for its b_n_per_m")
    if mean is not None and abs(mean / first.b_n_per_m - 1.0) > SAME_MEAN:
        condition = f"the same as order 0 of the harmonics, {first.b_n_per_m:.10g}, or left out"
        refuse("mean_n_per_m", mean, condition)


def _given(name: str) -> tuple[tuple[dict[str, Any], ...], float | None]:
    """Rows of `table` from a csv of orders, or from one over the pinion's angle with the pitch it covers."""
    try:
        return _harmonics(read_numbers(name, COLUMNS)), None
    except CsvFault as fault:
        try:
            return _of_curve(read_numbers(name, CURVE))
        except CsvFault as other:
            raise fault if f"column {CURVE[0]} must" in str(other) else other from None


def _of_curve(curve: Sequence[CsvRow]) -> tuple[tuple[dict[str, Any], ...], float]:
    """The same from rows over the angle, and the pitch (deg) that they cover."""
    angle, stiffness = (np.array([row.values[column] for row in curve]) for column in CURVE)
    if not 4 <= len(curve) <= 2 * MAX_ORDER:
        raise CsvFault(f"it must have from 4 to {2 * MAX_ORDER} rows over the pitch, not {len(curve)}")
    step = (angle[-1] - angle[0]) / (len(curve) - 1)
    uneven = np.abs(angle - step * np.arange(len(curve))) > EVEN * abs(step)
    if step <= 0.0 or uneven.any():
        line = curve[int(np.argmax(uneven))].line
        raise CsvFault(
            f"line {line}: {CURVE[0]} must rise in even steps from 0, the end of the pitch left out"
        )
    if np.abs(stiffness).max() > 1e12:
        raise CsvFault(f"line {curve[int(np.argmax(np.abs(stiffness)))].line}: {CURVE[1]} is beyond 1e12")
    series = fit_harmonics(stiffness).series
    terms = zip(range(series.order + 1), series.a.tolist(), series.b.tolist(), strict=True)
    return tuple(dict(zip(COLUMNS, row, strict=True)) for row in terms), float(step * len(curve))


def _harmonics(rows: Sequence[CsvRow]) -> tuple[dict[str, Any], ...]:
    """Rows of `table` from those of a csv, in any order there."""
    lines: dict[int, int] = {}
    table = []
    for row in rows:
        table.append(_harmonic(row))
        order = table[-1]["order"]
        if order in lines:
            raise CsvFault(f"line {row.line}: order {order} already stands in line {lines[order]}")
        lines[order] = row.line
    return tuple(sorted(table, key=lambda harmonic: harmonic["order"]))


def _harmonic(row: CsvRow) -> dict[str, Any]:
    order = row.values["order"]
    if order != round(order) or not 0 <= order <= MAX_ORDER:
        raise CsvFault(f"line {row.line}: order = {order:.10g} is not a whole number from 0 to {MAX_ORDER}")
    for name in COLUMNS[1:]:
        if abs(row.values[name]) > 1e12:
            raise CsvFault(f"line {row.line}: {name} = {row.values[name]:g} is beyond 1e12")
    return {**row.values, "order": int(order)}
