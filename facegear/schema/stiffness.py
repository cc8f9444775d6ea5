"""Config section `mesh_stiffness`: where the lumped model's k(t) comes from."""

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field, model_validator

from facegear.harmonics import Harmonics, fit_harmonics
from facegear.schema.base import Section, refuse
from facegear.schema.csv_file import CsvFault, CsvRow, column_names, read_numbers

MAX_ORDER = 512
"""Largest order of the mesh frequency in the series of k(t)."""
SOFTEST = 1e5
"""Mean stiffness (N/m) below which no pair of gears is: a pinion of 1 mm in plastic has ten times as much."""
SAME_MEAN = 1e-6
"""Relative difference up to which two given means count as one."""

Amplitude = Annotated[float, Field(ge=-1e12, le=1e12)]


class HarmonicSection(Section):
    """One order of k(t) = mean + sum of sin_n_per_m sin(order w t) + cos_n_per_m cos(order w t), w the mesh
    frequency.
    """

    order: int = Field(ge=0, le=MAX_ORDER, description="multiple of the mesh frequency; 0: the mean")
    sin_n_per_m: Amplitude = Field(
        default=0.0,
        description="factor of sin(order w t), the a of Dong et al.'s equation (8), which most texts call b; "
        "0 for order 0",
    )
    cos_n_per_m: Amplitude = Field(
        default=0.0,
        description="factor of cos(order w t), the b of Dong et al.'s equation (8), which most texts call a; "
        "the mean for order 0",
    )


COLUMNS = tuple(HarmonicSection.model_fields)
"""Columns of a csv of harmonics."""
UNREAD = (
    *("amplitude_n_per_m", "truncation_error_n_per_m", "sampling_error_n_per_m"),
    *("e_sin_um", "e_cos_um", "e_peak_to_peak_um", "e_truncation_error_um"),
    *("mean_average_n_per_m", "mean_local_n_per_m"),
    *(
        f"{gear}_{flank}_{part}_n_per_m"
        for gear in ("lower", "upper")
        for flank in ("drive", "back")
        for part in ("sin", "cos")
    ),
)
"""Further columns of the table `stiffness/harmonics.csv`, which is read back as it was written."""
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
        ge=1,
        le=1e12,
        description="fem_scaled: required; harmonics: required unless order 0 gives it; fem: for the modes "
        "only, which take the computed mean without it",
    )
    torque_n_m: float | None = Field(
        default=None,
        ge=1e-6,
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
    harmonics_kept: int = Field(
        default=8, ge=0, le=MAX_ORDER, description="largest order of k(t) that is kept"
    )
    variation: float = Field(
        default=1.0, ge=0, le=100, description="factor on k(t) about its mean; 1: as computed or given"
    )
    table: tuple[HarmonicSection, ...] = Field(
        default=(), max_length=MAX_ORDER + 1, description="for source harmonics: orders rising"
    )
    coast: tuple[HarmonicSection, ...] = Field(
        default=(),
        max_length=MAX_ORDER + 1,
        description="for source harmonics: orders rising from 0 of the coast flanks, over the cycle of the "
        "mirrored pair, in which they drive; none: as the drive flanks",
    )
    csv: str | None = Field(
        default=None,
        min_length=1,
        description="for source harmonics, instead of table: a file with the columns order, sin_n_per_m, "
        "cos_n_per_m, or pinion_angle_deg, k_n_per_m over one pitch of the pinion; its path counts from this "
        "file's folder",
    )
    csv_pitch_deg: float | None = Field(
        default=None,
        gt=0,
        le=1e6,
        exclude=True,
        description="left out: the pitch that the angles of a csv cover, which must be that of the pinion",
    )

    @model_validator(mode="before")
    @classmethod
    def _read(cls, values: Any) -> Any:
        """Replace the file `csv` by the table of harmonics read from it, so that faults are reported
        before any work.

        A curve over the pinion's angle also sets the pitch that it covers, deg.
        """
        if not isinstance(values, Mapping):
            return values
        for key in ("table", "coast"):
            if isinstance(values.get(key), list):
                values = {**values, key: tuple(values[key])}
        if not isinstance(name := values.get("csv"), str):
            return values
        if values.get("table"):
            refuse("csv", name, "either csv or table, not both")
        if values.get("source") != "harmonics":
            refuse("csv", name, "left out unless source is harmonics")
        try:
            table, pitch = _read_csv(name)
        except CsvFault as fault:
            refuse("csv", name, f"a csv of numbers; {fault}")
        return {**values, "csv": None, "table": table, "csv_pitch_deg": pitch}

    @model_validator(mode="after")
    def _complete(self) -> "MeshStiffness":
        """Refuse keys that the source of the stiffness lacks or does not use."""
        for key in ("table", "coast"):
            if self.source != "harmonics" and getattr(self, key):
                refuse("source", self.source, f"harmonics, as a {key} is given")
        if self.source == "fem_scaled" and self.mean_n_per_m is None:
            refuse("mean_n_per_m", None, "given, as source fem_scaled scales the curve to it")
        if self.mesh_law == "load_dependent":
            _check_law(self)
        if self.source != "harmonics":
            return self
        if not self.table:
            refuse("table", [], "given, here or in csv, where source is harmonics")
        for key in ("table", "coast"):
            for number, (terms, next_terms) in enumerate(pairwise(getattr(self, key))):
                if next_terms.order <= terms.order:
                    refuse(f"{key}[{number + 1}].order", next_terms.order, "above the order before it")
        _check_mean(self.mean_n_per_m, self.table[0])
        if (mean := self.mean) is not None and mean < SOFTEST:
            requirement = f"at least {SOFTEST:g} N/m; values in N/um are a million times too small"
            refuse("csv or table" if self.mean_n_per_m is None else "mean_n_per_m", mean, requirement)
        minimum = given_series(self).truncate(self.harmonics_kept).scale_variation(self.variation).minimum
        if minimum <= 0.0:
            condition = "harmonics so small beside the mean that k(t) stays positive"
            refuse("table", f"k(t) falls to {minimum:.4g} N/m", condition)
        if self.coast:
            _check_coast(self)
        return self

    @property
    def mean(self) -> float | None:
        """Mean stiffness that is given, N/m: order 0 of the harmonics, else the key; None without both."""
        zeroth = self.table[0].cos_n_per_m if self.table and self.table[0].order == 0 else None
        return self.mean_n_per_m if zeroth is None else zeroth


def given_series(section: MeshStiffness) -> Harmonics:
    """Return the Fourier series of the mesh stiffness written in the config, its mean included.

    Parameters
    ----------
    section : MeshStiffness
        Section `mesh_stiffness` of the config.

    Returns
    -------
    Harmonics
        Mesh stiffness over a mesh period, N/m.
    """
    return _series(section.table, section.mean or 0.0)


def coast_series(section: MeshStiffness) -> Harmonics | None:
    """Return the Fourier series of the stiffness of coast flanks written in the config.

    Parameters
    ----------
    section : MeshStiffness
        Section `mesh_stiffness` of the config.

    Returns
    -------
    Harmonics or None
        Stiffness over a mesh period of the mirrored pair, N/m; None where they are as the drive flanks.
    """
    return _series(section.coast, section.coast[0].cos_n_per_m) if section.coast else None


def _series(rows: Sequence[HarmonicSection], mean: float) -> Harmonics:
    """Return the Fourier series with these orders and mean, N/m; orders left out are zero."""
    order = max((row.order for row in rows), default=0)
    sine, cosine = np.zeros(order + 1), np.zeros(order + 1)
    for row in rows:
        sine[row.order], cosine[row.order] = row.sin_n_per_m, row.cos_n_per_m
    cosine[0] = mean
    return Harmonics(sine, cosine)


def _check_coast(section: MeshStiffness) -> None:
    """Refuse orders of coast flanks without their mean, and a stiffness of theirs that is not positive."""
    first = section.coast[0]
    if first.order > 0 or first.sin_n_per_m != 0.0 or first.cos_n_per_m < SOFTEST:
        requirement = f"order 0 with sin_n_per_m 0 and the mean, at least {SOFTEST:g}, for its cos_n_per_m"
        refuse("coast[0]", first.model_dump(), requirement)
    series = (
        _series(section.coast, first.cos_n_per_m)
        .truncate(section.harmonics_kept)
        .scale_variation(section.variation)
    )
    if series.minimum <= 0.0:
        condition = "harmonics so small beside the mean that k(t) stays positive"
        refuse("coast", f"k(t) falls to {series.minimum:.4g} N/m", condition)


def _check_law(section: MeshStiffness) -> None:
    """Refuse a load-dependent law without contact, and a factor on its variation."""
    if section.source == "harmonics":
        refuse("mesh_law", "load_dependent", "constant_load, where source is harmonics")
    if section.variation != 1.0:
        refuse("variation", section.variation, "1, where mesh_law is load_dependent")


def _check_mean(mean: float | None, first: HarmonicSection) -> None:
    """Refuse a mean that is given by key and by order 0 of the harmonics with different values, or by
    neither.
    """
    if first.order > 0:
        if mean is None:
            refuse("mean_n_per_m", None, "given, as the harmonics have no order 0, which is the mean")
        return
    if first.sin_n_per_m != 0.0 or first.cos_n_per_m <= 0.0:
        order_0_terms = [first.sin_n_per_m, first.cos_n_per_m]
        refuse(
            "table", order_0_terms, "0 for sin_n_per_m of order 0, and the mean, above 0, for its cos_n_per_m"
        )
    if mean is not None and abs(mean / first.cos_n_per_m - 1.0) > SAME_MEAN:
        condition = f"the same as order 0 of the harmonics, {first.cos_n_per_m:.10g}, or left out"
        refuse("mean_n_per_m", mean, condition)


def _read_csv(name: str) -> tuple[tuple[dict[str, Any], ...], float | None]:
    """Read rows of `table` from a csv file of harmonics, or from a curve over the pinion's angle.

    Returns the rows and, for a curve, the pitch (deg) that it covers, else None.
    """
    if CURVE[0] in column_names(name):
        return _of_curve(read_numbers(name, CURVE))
    return _harmonics(read_numbers(name, COLUMNS, UNREAD)), None


def _of_curve(curve: Sequence[CsvRow]) -> tuple[tuple[dict[str, Any], ...], float]:
    """Return rows of `table` from a stiffness curve over the pinion's angle, and the pitch (deg) that it
    covers.

    The curve has even steps from 0, without the end of the pitch. Its Fourier series is exact at the
    points.
    """
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
    for row, value in zip(curve, stiffness.tolist(), strict=True):
        if not 0.0 < value <= 1e12:
            raise CsvFault(f"line {row.line}: {CURVE[1]} = {value:g} must be above 0, at most 1e12")
    series = fit_harmonics(stiffness).series
    terms = zip(range(series.order + 1), series.sine.tolist(), series.cosine.tolist(), strict=True)
    return tuple(dict(zip(COLUMNS, row, strict=True)) for row in terms), float(step * len(curve))


def _harmonics(rows: Sequence[CsvRow]) -> tuple[dict[str, Any], ...]:
    """Return rows of `table` (order, sine and cosine in N/m), sorted by order, from the rows of a csv
    file.
    """
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
    """Return the harmonic of a line of a csv file; refuse an invalid order."""
    order = row.values["order"]
    if order != round(order) or not 0 <= order <= MAX_ORDER:
        raise CsvFault(f"line {row.line}: order = {order:.10g} is not a whole number from 0 to {MAX_ORDER}")
    for name in COLUMNS[1:]:
        if abs(row.values[name]) > 1e12:
            raise CsvFault(f"line {row.line}: {name} = {row.values[name]:g} is beyond 1e12")
    return {**row.values, "order": int(order)}
