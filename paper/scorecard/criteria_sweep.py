"""Criteria on the speed sweep; tables `sweep` and `jumps` as the dynamics writes them.

The level of several meshes or bodies is the mean of their RMS about the mean, each divided by its largest,
so that none of them dominates. It is judged on the upward sweep unless said otherwise.
"""

import numpy as np

from facegear.arrays import Array, Integers, Mask
from facegear.motion.between_samples import local_maxima
from facegear.number_format import count_noun
from paper.scorecard.outcome import ClaimOutcome, Tables, nearest, number, statement

PROMINENCE = 0.1
"""A peak stands out by this share of the sweep's largest level."""
JUMP_SIZE = 0.25
"""At a jump the RMS changes by at least this share of the larger one."""
IRREGULAR = ("chaotic", "not settled", "undecided")
APART = 0.1
TRANSLATIONS = ("x_ac_rms_um", "y_ac_rms_um", "z_ac_rms_um")
DEFLECTION = ("deflection_ac_rms_um",)


def peak_speed(tables: Tables, parts: list[str], near: float) -> ClaimOutcome:
    """Speed of the translations' peak nearest to the paper's; a peak stands out by 10 % of the largest level,
    and the motion there or at the next speed is regular.

    Parameters
    ----------
    tables : Tables
        Stored results by name.
    parts : list[str]
        Names of the bodies.
    near : float
        Speed that the paper states, rpm.

    Returns
    -------
    ClaimOutcome
        The number, in the unit of the claim.
    """
    speeds, level = _level(tables, TRANSLATIONS, parts, "up")
    regular = _regular(tables, speeds, "up")
    peaks = [i for i in _peaks(level) if regular[i - 1 : i + 2].any()]
    return nearest(speeds[peaks], near, (float(speeds[0]), float(speeds[-1])), "peak")


def dominant_peak(tables: Tables, parts: list[str], near: float, within: float) -> ClaimOutcome:
    """The largest translation over all speeds is a peak within the stated relative distance of the speed, and
    not an end of the sweep.

    Parameters
    ----------
    tables : Tables
        Stored results by name.
    parts : list[str]
        Names of the bodies.
    near : float
        Speed that the paper states, rpm.
    within : float
        Largest distance from the speed, relative.

    Returns
    -------
    ClaimOutcome
        Whether the statement holds, with the evidence.
    """
    speeds, level = _level(tables, TRANSLATIONS, parts, "up")
    top = int(level.argmax())
    if top in (0, level.size - 1):
        return statement(False, f"largest at the end of the sweep, {speeds[top]:.0f} rpm")
    return statement(abs(speeds[top] / near - 1.0) <= within, f"largest at {speeds[top]:.0f} rpm")


def not_dominant_peak(tables: Tables, parts: list[str], near: float, within: float) -> ClaimOutcome:
    """The largest translation over all speeds lies outside the stated relative distance of the speed.

    Parameters
    ----------
    tables : Tables
        Stored results by name.
    parts : list[str]
        Names of the bodies.
    near : float
        Speed that the paper states, rpm.
    within : float
        Largest distance from the speed, relative.

    Returns
    -------
    ClaimOutcome
        Whether the statement holds, with the evidence.
    """
    dominant = dominant_peak(tables, parts, near, within)
    return statement(not dominant.holds, dominant.text)


def jump_speed(tables: Tables, near: float) -> ClaimOutcome:
    """Speed of the jump, in either direction, nearest to the paper's; at a jump the RMS of a mesh changes by
    a quarter of the larger value or more, and the motion is regular on one side.

    Parameters
    ----------
    tables : Tables
        Stored results by name.
    near : float
        Speed that the paper states, rpm.

    Returns
    -------
    ClaimOutcome
        The number, in the unit of the claim.
    """
    jumps, speeds = tables["jumps"], tables["sweep"]["speed_rpm"]
    levels = jumps[["deflection_ac_rms_before_um", "deflection_ac_rms_after_um"]].to_numpy(float)
    size = np.abs(np.diff(levels, axis=1)[:, 0]) / levels.max(axis=1)
    regular = ~(jumps["class_before"].isin(IRREGULAR) & jumps["class_after"].isin(IRREGULAR)).to_numpy(bool)
    middle = 0.5 * (jumps["speed_before_rpm"] + jumps["speed_after_rpm"]).to_numpy(float)
    span = (float(speeds.min()), float(speeds.max()))
    return nearest(middle[(size >= JUMP_SIZE) & regular], near, span, "jump")


def jump_leans(tables: Tables, near: float, within: float, lean: str) -> ClaimOutcome:
    """The upward level is the higher one at most (hardening) or the lower one at most (softening) of the
    speeds within the stated distance at which the mean mesh levels of the up and down sweeps differ by 10
    %.

    Parameters
    ----------
    tables : Tables
        Stored results by name.
    near : float
        Speed that the paper states, rpm.
    within : float
        Largest distance from the speed, relative.
    lean : str
        `hardening` or `softening`.

    Returns
    -------
    ClaimOutcome
        Whether the statement holds, with the evidence.
    """
    speeds, higher_sweep = _bistable(tables, list(_meshes(tables)))
    close = np.abs(speeds / near - 1.0) <= within
    return _leaning(higher_sweep[close], lean)


def jump_in_mesh(tables: Tables, pinion: str, near: float, within: float, lean: str) -> ClaimOutcome:
    """The upward level of the meshes of one pinion is the higher one at most (hardening) or the lower one at
    most (softening) of the speeds within the stated distance at which the levels of the up and down sweeps
    differ by 10 %.

    Parameters
    ----------
    tables : Tables
        Stored results by name.
    pinion : str
        Name of the pinion.
    near : float
        Speed that the paper states, rpm.
    within : float
        Largest distance from the speed, relative.
    lean : str
        `hardening` or `softening`.

    Returns
    -------
    ClaimOutcome
        Whether the statement holds, with the evidence.
    """
    speeds, higher_sweep = _bistable(
        tables, [mesh for mesh in _meshes(tables) if mesh.startswith(f"{pinion}/")]
    )
    close = np.abs(speeds / near - 1.0) <= within
    return _leaning(higher_sweep[close], lean)


def wider_region(tables: Tables, broad: float, narrow: float, within: float) -> ClaimOutcome:
    """More speeds around the first than around the second have different levels in the up and down sweeps.

    Parameters
    ----------
    tables : Tables
        Stored results by name.
    broad : float
        Speed of the wider region, rpm.
    narrow : float
        Speed of the narrower region, rpm.
    within : float
        Largest distance from the speed, relative.

    Returns
    -------
    ClaimOutcome
        Whether the statement holds, with the evidence.
    """
    speeds, higher_sweep = _bistable(tables, list(_meshes(tables)))
    width = [
        float(np.abs(higher_sweep[np.abs(speeds / near - 1.0) <= within]).sum() * (speeds[1] - speeds[0]))
        for near in (broad, narrow)
    ]
    return statement(width[0] > width[1], f"{width[0]:.0f} rpm against {width[1]:.0f} rpm")


def mode_speed(tables: Tables, order: int, multiple: float, pinion_teeth: int = 23) -> ClaimOutcome:
    """Speed at which the mesh frequency meets the frequency of the mode, times the multiple.

    Parameters
    ----------
    tables : Tables
        Stored results by name.
    order : int
        Order of the mode, from 1.
    multiple : float
        Multiple of the mode frequency, dimensionless.
    pinion_teeth : int
        Number of teeth of the pinion.

    Returns
    -------
    ClaimOutcome
        The number, in the unit of the claim.
    """
    values = tables["frequencies"].set_index("order")["frequency_hz"]
    return number(60.0 * multiple * values[order] / pinion_teeth)


def _leaning(higher_sweep: Integers, lean: str) -> ClaimOutcome:
    if not higher_sweep.any():
        return statement(False, "up and down sweeps agree")
    lean_of_sweep = (
        "hardening" if higher_sweep.sum() > 0 else "softening" if higher_sweep.sum() < 0 else "neither"
    )
    upward = count_noun(int((higher_sweep > 0).sum()), "speed")
    counts = f"{upward} higher upward, {(higher_sweep < 0).sum()} higher downward"
    return statement(lean_of_sweep == lean, f"{lean_of_sweep} ({counts})")


def _meshes(tables: Tables) -> list[str]:
    frame = tables["sweep"]
    rows = frame[frame["quantity"] == DEFLECTION[0]]
    return list(dict.fromkeys(rows["body_or_mesh"]))


def _level(
    tables: Tables, quantities: tuple[str, ...], parts: list[str], direction: str
) -> tuple[Array, Array]:
    """Speeds (P,) rising, and mean level (P,) relative to each curve's largest value over both directions."""
    frame = tables["sweep"]
    rows = frame[frame["quantity"].isin(quantities) & frame["body_or_mesh"].isin(parts)]
    if rows.empty:
        raise KeyError(f"no sweep of {', '.join(parts)}")
    largest = rows.groupby(["quantity", "body_or_mesh"])["value"].transform("max")
    relative_rows = rows.assign(value=rows["value"] / largest)
    curve = (
        relative_rows[relative_rows["direction"] == direction]
        .groupby("speed_rpm")["value"]
        .mean()
        .sort_index()
    )
    return curve.index.to_numpy(float), curve.to_numpy(float)


def _bistable(tables: Tables, meshes: list[str]) -> tuple[Array, Integers]:
    """Speeds (P,), and +1, -1 or 0 where the upward level is higher, lower, or the same within 10 %."""
    speeds, up = _level(tables, DEFLECTION, meshes, "up")
    _, down = _level(tables, DEFLECTION, meshes, "down")
    difference = (up - down) / np.maximum(up, down)
    return speeds, np.sign(np.where(np.abs(difference) > APART, difference, 0.0)).astype(int)


def _regular(tables: Tables, speeds: Array, direction: str) -> Mask:
    """Whether the motion at each speed (P,) of a sweep is periodic or quasi-periodic."""
    frame = tables["sweep"]
    rows = frame[frame["direction"] == direction].drop_duplicates("speed_rpm").set_index("speed_rpm")
    return ~rows.loc[speeds, "class"].isin(IRREGULAR).to_numpy(bool)


def _peaks(level: Array) -> Integers:
    """Local maxima that stand PROMINENCE of the largest level above the higher of the valleys beside them."""
    positions, prominences = local_maxima(level)
    return positions[prominences >= PROMINENCE * level.max()]
