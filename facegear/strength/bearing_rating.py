"""Loads, stiffness and life of the rolling bearings of a machine, bin by bin of its duty cycle."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

from facegear.bearings.life import BASIS, DutyLife, Lubrication, life_together, rate_duty
from facegear.bearings.response import element_loads
from facegear.machine.placed_bearings import PlacedBearing
from facegear.machine.statics import Equilibria

MOTION_NAMES = ("x", "y", "z", "tilt_x", "tilt_y")
"""Names of the five motions of an inner ring."""


MEAN, WHOLE = "mean", "all"
"""Label of the load under the machine's own torques, and of the whole duty cycle, in column `bin`."""


ALL_BEARINGS = "all bearings"
"""Name in column `pinion` of the rows on the life of all bearings together."""


LOAD_COLUMNS = (
    *("pinion", "bearing", "bin", "torque_n_m"),
    *("x_n", "y_n", "z_n", "tilt_x_n_m", "tilt_y_n_m", "radial_n"),
    *("x_um", "y_um", "z_um", "tilt_x_urad", "tilt_y_urad"),
    *("hardest_element_n", "loaded_elements", "zone_deg"),
    *("inner_pressure_mpa", "outer_pressure_mpa", "least_angle_deg", "largest_angle_deg", "static_safety"),
)
"""Columns of loads: of the shaft on the bearing, motion of its inner ring, and its hardest element."""


LOAD_FINITE = ("torque_n_m", "x_n", "radial_n", "x_um", "tilt_y_urad", "zone_deg", "inner_pressure_mpa")
"""Columns of loads that are finite and not empty."""


STIFFNESS_COLUMNS = ("pinion", "bearing", "bin", "torque_n_m", "motion", *MOTION_NAMES, "change")
"""Columns of stiffness, N/m, N/rad and N m/rad; `change` is the diagonal entry over that under the mean
load, less 1."""


LIFE_COLUMNS = (
    *("pinion", "bearing", "bin", "torque_n_m", "speed_rpm", "hours", "load_rating_n"),
    *("equivalent_load_n", "reference_load_n", "l10_million", "l10r_million", "modified_million"),
    *("l10_hours", "l10r_hours", "modified_hours", "damage_share", "required_hours", "is_enough", "basis"),
    "remark",
)
"""Columns of lives; rows of the whole duty cycle have hours alone. `remark` is NO_LIFE_LIMIT or PRESSED_IN
where a life is infinite."""


NO_LIFE_LIMIT = "carries nothing: its life has no limit"
"""Remark on a bearing whose elements carry nothing."""


PRESSED_IN = "carries no load of the shaft, so that L10 has no limit; L10r counts the pressed-in elements"
"""Remark on a bearing whose elements are pressed in and balance each other."""


CURVE_COLUMNS = (
    *("pinion", "bearing", "load_fraction", "torque_n_m"),
    *("radial_n", "radial_stiffness_n_per_m", "axial_stiffness_n_per_m", "zone_deg", "largest_pressure_mpa"),
)
"""Columns of a bearing over the machine's torque; the radial stiffness is that along the radial load."""


CURVE_FINITE = ("load_fraction", "radial_n", "radial_stiffness_n_per_m", "zone_deg")
"""Columns of a bearing over torque that are finite and not empty."""


@dataclass(frozen=True, eq=False)
class RatedLoad:
    """A machine at rest in one bin of its duty cycle, or under its own mean torques.

    Attributes
    ----------
    label
        Number of the bin from 1, or MEAN.
    torque
        On an input pinion by each of its meshes, N m.
    speed_rpm, hours
        Speed of the pinions, and time in the bin (h).
    at_rest
        Its equilibrium.
    """

    label: str
    torque: float
    speed_rpm: float
    hours: float
    at_rest: Equilibria


def load_table(bearings: Sequence[PlacedBearing], loads: Sequence[RatedLoad]) -> pd.DataFrame:
    """Tabulate loads, ring motions and hardest elements of every bearing under every load.

    Parameters
    ----------
    bearings : sequence of PlacedBearing
        The bearings.
    loads : sequence of RatedLoad
        The loads.

    Returns
    -------
    pd.DataFrame
        LOAD_COLUMNS; static safety is infinite without load.
    """
    rows = []
    for bearing in bearings:
        for load in loads:
            state = bearing.state(load.at_rest)
            inner, outer = 1e-6 * state.pressures
            angles = np.degrees(state.contact_angles)
            rows.append(
                (
                    *(bearing.name, bearing.letter, load.label, load.torque),
                    *(*state.force, np.hypot(*state.force[:2]), *(1e6 * state.motion)),
                    *(state.hardest_load, state.loaded_elements, np.degrees(state.zone)),
                    *(inner, outer, *angles, state.static_safety),
                )
            )
    return pd.DataFrame(rows, columns=list(LOAD_COLUMNS))


def stiffness_table(bearings: Sequence[PlacedBearing], loads: Sequence[RatedLoad]) -> pd.DataFrame:
    """Tabulate the 5 x 5 stiffness of every bearing under the first load and at both ends of the others.

    Parameters
    ----------
    bearings : sequence of PlacedBearing
        The bearings.
    loads : sequence of RatedLoad
        The mean load first.

    Returns
    -------
    pd.DataFrame
        STIFFNESS_COLUMNS; five rows a bearing and load.
    """
    mean, *bins = loads
    ends = sorted(bins, key=lambda load: load.torque)
    rows = []
    for bearing in bearings:
        at_mean = np.diagonal(bearing.state(mean.at_rest).stiffness)
        for load in (mean, *ends[:1], *ends[1:][-1:]):
            stiffness = bearing.state(load.at_rest).stiffness
            for motion, row, diagonal, first in zip(
                MOTION_NAMES, stiffness, np.diagonal(stiffness), at_mean, strict=True
            ):
                change = diagonal / first - 1.0 if first > 0.0 else np.nan
                rows.append((bearing.name, bearing.letter, load.label, load.torque, motion, *row, change))
    return pd.DataFrame(rows, columns=list(STIFFNESS_COLUMNS))


def life_table(
    bearings: Sequence[PlacedBearing],
    bins: Sequence[RatedLoad],
    lubrication: Lubrication | None = None,
    required_hours: float | None = None,
) -> pd.DataFrame:
    """Tabulate the lives of every bearing by bin and over the whole cycle, and of all bearings together.

    Parameters
    ----------
    bearings : sequence of PlacedBearing
        The bearings.
    bins : sequence of RatedLoad
        Bins of the duty cycle.
    lubrication : Lubrication or None
        Conditions of the modified life, for bearings whose fatigue load limit is given; that of each bearing
        takes the place of its own.
    required_hours : float or None
        Life that is asked for, h.

    Returns
    -------
    pd.DataFrame
        LIFE_COLUMNS; infinite without load, not a number where a life is not asked for or not known.
        `is_enough` judges the modified life where there is one, else L10r.
    """
    rows: list[tuple[object, ...]] = []
    lives = []
    for bearing in bearings:
        life = _rate(bearing, bins, lubrication)
        lives.append(life)
        rows += _bin_rows(bearing, bins, life)
        hours = (life.basic_hours, life.reference_hours, life.modified_hours)
        rows.append(_whole_row(bearing.name, bearing.letter, life.rating, bins, hours, required_hours))
    kinds = [bearing.bearing for bearing in bearings]
    together = tuple(
        life_together(kinds, [getattr(life, name) for life in lives])
        for name in ("basic_hours", "reference_hours", "modified_hours")
    )
    rows.append(_whole_row(ALL_BEARINGS, "", np.nan, bins, together, required_hours))
    return pd.DataFrame(rows, columns=list(LIFE_COLUMNS))


def _rate(bearing: PlacedBearing, bins: Sequence[RatedLoad], lubrication: Lubrication | None) -> DutyLife:
    """Return the lives of a bearing over the bins."""
    states = [bearing.state(load.at_rest) for load in bins]
    rings, forces = np.array([[state.motion, state.force] for state in states]).transpose(1, 0, 2)
    conditions = None
    if lubrication is not None and bearing.fatigue_load_limit is not None:
        conditions = replace(lubrication, fatigue_load_limit=bearing.fatigue_load_limit)
    return rate_duty(
        bearing.bearing,
        forces,
        element_loads(bearing.bearing, rings),
        60.0 * np.array([load.speed_rpm for load in bins]),
        np.array([load.hours for load in bins]),
        bearing.load_rating,
        conditions,
    )


def _bin_rows(
    bearing: PlacedBearing, bins: Sequence[RatedLoad], life: DutyLife
) -> Iterator[tuple[object, ...]]:
    """Yield a row of LIFE_COLUMNS for each bin of a bearing."""
    turns = 60e-6 * np.array([load.speed_rpm for load in bins])
    hours = np.stack([life.basic, life.reference, life.modified_reference]) / turns
    damages = np.array([load.hours for load in bins]) / hours[1]
    shares = damages / damages.sum() if damages.sum() > 0.0 else damages
    for number, load in enumerate(bins):
        yield (
            *(bearing.name, bearing.letter, load.label, load.torque, load.speed_rpm, load.hours, life.rating),
            *(life.equivalent_load[number], life.reference_load[number]),
            *(life.basic[number], life.reference[number], life.modified_reference[number]),
            *hours[:, number],
            *(shares[number], np.nan, "", basis_of(not np.isnan(hours[2, number]))),
            _remark(hours[0, number], hours[1, number]),
        )


def _whole_row(
    name: str,
    letter: str,
    rating: float,
    bins: Sequence[RatedLoad],
    hours: tuple[float, ...],
    required_hours: float | None,
) -> tuple[object, ...]:
    """Return the row of LIFE_COLUMNS of a bearing, or of all, over the whole duty cycle."""
    basic, reference, modified_life = hours
    judged_life = reference if np.isnan(modified_life) else modified_life
    verdict = "" if required_hours is None else ("yes" if judged_life >= required_hours else "no")
    return (
        *(name, letter, WHOLE, np.nan, np.nan, sum(load.hours for load in bins), rating),
        *5 * (np.nan,),
        *hours,
        *(float(np.isfinite(reference)), np.nan if required_hours is None else required_hours, verdict),
        *(basis_of(not np.isnan(modified_life)), _remark(basic, reference)),
    )


def _remark(basic: float, reference: float) -> str:
    """Return why lives by ISO 281 and by ISO/TS 16281, h, are infinite; empty where the first is not."""
    if not np.isinf(basic):
        return ""
    return NO_LIFE_LIMIT if np.isinf(reference) else PRESSED_IN


def basis_of(has_modified: bool) -> str:
    """Return on which standards a row of lives rests, and which of them were not at hand.

    Parameters
    ----------
    has_modified : bool
        Whether the row has a modified life.

    Returns
    -------
    str
        Texts of `facegear.bearings.life.BASIS`.
    """
    names = ("basic", "reference", "modified") if has_modified else ("basic", "reference")
    return "; ".join(BASIS[name] for name in names)


def curve_rows(
    bearings: Sequence[PlacedBearing], fraction: float, torque: float, at_rest: Equilibria
) -> Iterator[tuple[object, ...]]:
    """Yield a row of CURVE_COLUMNS for each bearing.

    Parameters
    ----------
    bearings : sequence of PlacedBearing
        The bearings.
    fraction : float
        Torques over those of the machine, dimensionless.
    torque : float
        On an input pinion by each of its meshes, N m.
    at_rest : Equilibria
        Equilibrium under these torques.

    Yields
    ------
    tuple
        Values of the columns.
    """
    for bearing in bearings:
        state = bearing.state(at_rest)
        radial = float(np.hypot(*state.force[:2]))
        along = state.force[:2] / radial if radial > 0.0 else np.array([1.0, 0.0])
        yield (
            *(bearing.name, bearing.letter, fraction, torque, radial),
            *(float(along @ state.stiffness[:2, :2] @ along), float(state.stiffness[2, 2])),
            *(float(np.degrees(state.zone)), float(1e-6 * state.pressures.max())),
        )
