"""Tables of loss, heat, film and scuffing of the pair, and its friction as a disturbance of motion.

Friction of a mesh as a disturbance of the motion: its force and moments over the force of the mesh. At every
loaded hat friction acts on the pinion against the sliding velocity. The sums over the contact at each
position of a pitch keep the sign that sliding has there: it turns at the pitch line. Spur teeth at right
angles know forces at the pitch point alone, all others the whole wrench on the pinion.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi

import numpy as np
import pandas as pd

from facegear.arrays import AnyArray, Array, Integers, Mask
from facegear.contact.summary import join_flanks
from facegear.lubrication.columns import (
    BY_TORQUE_COLUMNS,
    EXCITATION_COLUMNS,
    EXCITATION_TILTS,
    LIMIT_COLUMNS,
    MAP_COLUMNS,
    POSITION_COLUMNS,
)
from facegear.lubrication.contact_points import ContactPoints, LoadedContact
from facegear.lubrication.film import integral_temperature, temperature_safety
from facegear.lubrication.friction import LIMIT_SOURCES
from facegear.lubrication.heat import Running, TooHot, mean_flash, running
from facegear.lubrication.kinematics import spins
from facegear.lubrication.loss import HatSlip, loss_factors
from facegear.lubrication.pairs import LoadedPair
from facegear.lubrication.request import Limits, Lubrication
from facegear.teeth.design import PairDesign


def friction_ratios(design: PairDesign, hats: HatSlip, friction: Array) -> Array:
    """Compute force and moments of friction over the mesh force at each position of a pitch.

    At each hat friction acts on the pinion against its sliding velocity over the gear, with the
    coefficient times the normal force; the gear gets the opposite force. The mesh force is torque over
    `normal_arm`, the force along the line of action that carries the torque.

    Parameters
    ----------
    design : PairDesign
        Geometry of the pair.
    hats : HatSlip
        Loaded hats of one torque.
    friction : (h,) array
        Friction coefficient of each hat, dimensionless.

    Returns
    -------
    (p, 5) or (p, 7) array
        For each position, rising: force on the pinion along x of the mesh frame, along the pinion's axis and
        along -z (tangential, along the pinion's axis, along the gear's axis), dimensionless; moment on the
        pinion about its axis and on the face gear about its own, each over the mesh force, m. For teeth other
        than spur ones follow the moments on the pinion, m, about the middle of its face, along x and along
        the direction square to x and the pinion's axis, towards the gear.
    """
    positions, row = np.unique(hats.position, return_inverse=True)
    sliding = hats.sliding
    against = np.where(sliding > 0.0, -friction * hats.force / np.where(sliding > 0.0, sliding, 1.0), 0.0)
    force = against[:, None] * hats.velocity
    pinion, gear = spins(design)
    on_pinion, on_gear = (
        np.cross(hats.point - body.through, sign * force) @ body.axis
        for body, sign in ((pinion, 1.0), (gear, -1.0))
    )
    across, axis, up = design.family.motion.basis
    columns = [force[:, 0], force @ axis, -force[:, 2], on_pinion, on_gear]
    if not design.is_spur:
        middle = pinion.through - design.middle * pinion.axis
        moment = np.cross(hats.point - middle, force)
        columns += [moment @ across, -moment @ up]
    parts = np.stack(columns, axis=1)
    sums = np.zeros((positions.size, len(columns)))
    np.add.at(sums, row, parts)
    return sums * design.normal_arm / float(hats.torque[0])


@dataclass(frozen=True, eq=False)
class RubbingContact:
    """One contact of a pair's flanks as friction sees it.

    `design` is the pair whose drive flank it is, `pair` its loaded contacts by torque, `states` the state of
    the flanks at each torque, with the friction coefficients.
    """

    design: PairDesign
    pair: LoadedPair
    states: Sequence[Running]

    def excitation_table(self) -> pd.DataFrame:
        """Tabulate force and moments of friction over the mesh force.

        Returns
        -------
        pd.DataFrame
            One row for each torque and position, columns EXCITATION_COLUMNS: torque (N m), position in
            pitches, and the five ratios of `friction_ratios`, with the moments in mm; EXCITATION_TILTS behind
            for teeth other than spur ones.
        """
        names = (
            EXCITATION_COLUMNS[2:] if self.design.is_spur else (*EXCITATION_COLUMNS[2:], *EXCITATION_TILTS)
        )
        frames = []
        for contact, state in zip(self.pair.contacts, self.states, strict=True):
            hats = contact.hats
            ratios = friction_ratios(self.design, hats, contact.at_hats(state.friction))
            ratios[:, 3:] *= 1e3
            frame = pd.DataFrame(ratios, columns=list(names))
            frame.insert(0, "torque_n_m", contact.torque)
            frame.insert(1, "position", np.unique(hats.position))
            frames.append(frame)
        return pd.concat(frames, ignore_index=True)


def excitation_table(contacts: Sequence[RubbingContact], numbers: Integers) -> pd.DataFrame:
    """Tabulate force and moments of friction over the mesh force, by which friction disturbs the motion.

    Parameters
    ----------
    contacts : Sequence[RubbingContact]
        Contacts of the flanks, that of the upper gear's drive flank first.
    numbers : (2, 2) array of int
        Number of the contact of each gear (upper, lower) and flank (drive, back).

    Returns
    -------
    pd.DataFrame
        Table of the only contact for spur teeth. Otherwise the tables of all flanks, each with columns gear
        and flank in front; a back flank's table is that of the mirrored pair, in which it drives.
    """
    tables = [contact.excitation_table() for contact in contacts]
    if contacts[0].design.is_spur:
        return tables[0]
    return join_flanks(tables, numbers)


RPM = pi / 30
"""Angular speed of one revolution a minute, rad/s."""


def by_torque_table(
    pair: LoadedPair, states: Sequence[Running], speed: float, limits: Limits
) -> pd.DataFrame:
    """Tabulate loss, heat, film, scuffing and micropitting of the pair by torque.

    Parameters
    ----------
    pair : LoadedPair
        The lubricated pair.
    states : Sequence[Running]
        State of the flanks at each torque of the pair, at `speed`.
    speed : float
        Pinion speed, rad/s.
    limits : Limits
        Limits of temperatures and films; safeties are nan where one is unknown.

    Returns
    -------
    pd.DataFrame
        One row for each torque, columns BY_TORQUE_COLUMNS, units in the names. Flash and films are the
        extremes away from edges, with the place of the largest flash.
    """
    rows = [
        _torque_row(pair.lubrication, contact, state, speed, limits)
        for contact, state in zip(pair.contacts, states, strict=True)
    ]
    return pd.DataFrame(rows, columns=list(BY_TORQUE_COLUMNS))


def _torque_row(
    lubrication: Lubrication, contact: LoadedContact, state: Running, speed: float, limits: Limits
) -> dict[str, object]:
    """Return one row of `by_torque_table`, keyed by BY_TORQUE_COLUMNS, for the contact and state of one
    torque.

    `speed` is the pinion's, rad/s. Films and the place of the largest flash are nan where all load is
    near edges.
    """
    torque, points, hats = contact.torque, contact.points, contact.hats
    on, factor, power = points.inside, loss_factors(hats), torque * speed
    rise = np.where(on, state.flash, -1.0)
    hottest, largest, mean = (
        int(rise.argmax()),
        state.flash[on].max(initial=0.0),
        mean_flash(points, state.flash),
    )
    temperatures, integral = state.mean_bulk + largest, float(integral_temperature(state.mean_bulk, mean))
    allowed_contact = limits.allowed_contact(lubrication.oil, lubrication.oil_temperature)
    allowed_integral = limits.allowed_integral(lubrication.oil)
    ratio = _min_of(state.micropitting, on)
    return {
        "torque_n_m": torque,
        "speed_rpm": speed / RPM,
        "friction_model": lubrication.friction.name,
        "loss_factor": factor.mean[0],
        "loss_factor_min": factor.at.min(),
        "loss_factor_max": factor.at.max(),
        "mean_friction": state.loss / (factor.mean[0] * power),
        "loss_w": state.loss,
        "efficiency": 1 - state.loss / power,
        "pinion_heat_w": state.heat[0],
        "face_gear_heat_w": state.heat[1],
        "pinion_bulk_c": state.bulk[0],
        "face_gear_bulk_c": state.bulk[1],
        "largest_sliding_m_per_s": speed * hats.sliding.max(),
        "largest_flash_k": largest,
        "flash_position": points.position[hottest] if on.any() else np.nan,
        "flash_pair": points.tooth[hottest] if on.any() else np.nan,
        "flash_axial_mm": 1e3 * points.y[hottest] if on.any() else np.nan,
        "contact_temperature_c": temperatures,
        "allowed_contact_temperature_c": allowed_contact,
        "allowed_contact_temperature_source": limits.contact_temperature_source,
        "scuffing_safety": float(
            temperature_safety(allowed_contact, lubrication.oil_temperature, temperatures)
        ),
        "scuffing_margin_k": allowed_contact - temperatures,
        "mean_flash_k": mean,
        "integral_temperature_c": integral,
        "allowed_integral_temperature_c": allowed_integral,
        "integral_safety": float(temperature_safety(allowed_integral, lubrication.oil_temperature, integral)),
        "smallest_film_um": 1e6 * _min_of(state.film, on),
        "smallest_short_film_um": 1e6 * _min_of(state.short_film, on),
        "smallest_film_ratio": _min_of(state.film_ratio, on),
        "smallest_micropitting_film_ratio": ratio,
        "micropitting_safety": limits.micropitting_safety(ratio),
    }


def position_table(pair: LoadedPair, states: Sequence[Running]) -> pd.DataFrame:
    """Tabulate loss, flash temperature and film of the pair by torque and position.

    Parameters
    ----------
    pair : LoadedPair
        The lubricated pair.
    states : Sequence[Running]
        State of the flanks at each torque of the pair.

    Returns
    -------
    pd.DataFrame
        One row for each torque and position, columns POSITION_COLUMNS. Films are nan where edges carry
        all load, and flash is 0 there.
    """
    frames = [_positions(contact, state) for contact, state in zip(pair.contacts, states, strict=True)]
    return pd.concat(frames, ignore_index=True)


def _positions(contact: LoadedContact, state: Running) -> pd.DataFrame:
    """Return the rows of `position_table` of one torque: columns POSITION_COLUMNS, one row a position of
    the pitch.
    """
    torque, points, hats = contact.torque, contact.points, contact.hats
    factor = loss_factors(hats)
    rows = np.searchsorted(factor.positions, hats.position)
    loss = np.bincount(rows, weights=state.hat_loss, minlength=factor.positions.size)
    column, on = np.searchsorted(factor.positions, points.position), points.inside
    rise = np.zeros(factor.positions.size)
    np.maximum.at(rise, column[on], state.flash[on])
    films = []
    for values in (1e6 * state.film, state.film_ratio):
        min_factor = np.full(factor.positions.size, np.inf)
        np.minimum.at(min_factor, column[on], values[on])
        films.append(np.where(np.isfinite(min_factor), min_factor, np.nan))
    columns = (torque, factor.positions, factor.at[0], loss, rise, *films)
    return pd.DataFrame(dict(zip(POSITION_COLUMNS, columns, strict=True)))


def limit_table(pair: LoadedPair, states: Sequence[Running]) -> pd.DataFrame:
    """Tabulate which part of the loss is at points outside each limit of the friction model.

    Parameters
    ----------
    pair : LoadedPair
        The lubricated pair.
    states : Sequence[Running]
        State of the flanks at each torque of the pair.

    Returns
    -------
    pd.DataFrame
        One row a torque and limit, columns LIMIT_COLUMNS: model, limit in words, its source, torque (N m)
        and part of the loss outside it (%). No rows for a model without limits.
    """
    model, rows = pair.lubrication.friction, []
    for contact, state in zip(pair.contacts, states, strict=True):
        points = contact.points
        heat = state.friction * points.line_load * points.length * points.sliding
        for limit, within in model.within(state.rubbing).items():
            outside = 100 * heat[~within].sum() / heat.sum() if heat.sum() > 0 else 0.0
            rows.append((model.name, limit, LIMIT_SOURCES[model.name, limit], contact.torque, outside))
    return pd.DataFrame(rows, columns=list(LIMIT_COLUMNS))


def map_table(pair: LoadedPair, speeds: Sequence[float]) -> pd.DataFrame:
    """Tabulate loss, efficiency, temperature and film at every torque and speed.

    Parameters
    ----------
    pair : LoadedPair
        The lubricated pair.
    speeds : Sequence[float]
        Pinion speeds, rpm.

    Returns
    -------
    pd.DataFrame
        One row a torque and speed, columns MAP_COLUMNS; all but torque and speed are nan where a body
        would pass the flash point of the oil.

    Raises
    ------
    NotConverged
        If bulk temperatures do not settle.
    """
    rows = [_map_row(contact, speed, pair.lubrication) for contact in pair.contacts for speed in speeds]
    return pd.DataFrame(rows, columns=list(MAP_COLUMNS))


def _map_row(contact: LoadedContact, speed: float, lubrication: Lubrication) -> tuple[float, ...]:
    """Return one row of `map_table`, in the order of MAP_COLUMNS, at one torque and a pinion speed in rpm.

    All but torque and speed are nan where a body passes the oil's flash point.
    """
    key = contact.torque, speed
    try:
        state = running(contact, speed * RPM, lubrication)
    except TooHot:
        return (*key, *(len(MAP_COLUMNS) - len(key)) * (np.nan,))
    on, power = contact.points.inside, contact.torque * speed * RPM
    rise = float(state.flash[on].max(initial=0.0))
    values = state.loss, 1 - state.loss / power, rise, state.mean_bulk + rise
    return (*key, *values, _min_of(state.film_ratio, on))


def local_arrays(pair: LoadedPair, states: Sequence[Running], speed: float) -> dict[str, AnyArray]:
    """Return load, velocities, friction, flash and film at every contact point of all torques, to be
    stored.

    Parameters
    ----------
    pair : LoadedPair
        The lubricated pair.
    states : Sequence[Running]
        State of the flanks at each torque of the pair, at `speed`.
    speed : float
        Pinion speed, rad/s.

    Returns
    -------
    dict of (m,) arrays
        Arrays LOCAL_ARRAYS, torque by torque, each in the unit that its name says, and the speed (1,).
    """
    rows = [
        _local(contact.points, state, speed) for contact, state in zip(pair.contacts, states, strict=True)
    ]
    arrays = {name: np.concatenate([row[name] for row in rows]) for name in rows[0]}
    return {**arrays, "speed_rad_per_s": np.array([speed])}


def _local(points: ContactPoints, state: Running, speed: float) -> dict[str, AnyArray]:
    """Return the arrays LOCAL_ARRAYS but the speed, for the m points of one torque; `speed` is the
    pinion's, rad/s.
    """
    return {
        "torque_n_m": points.torque,
        "position": points.position,
        "tooth": points.tooth,
        "plane": points.plane,
        "inside": points.inside.astype(np.int64),
        "axial_m": points.y,
        "roll_rad": points.roll,
        "line_load_n_per_m": points.line_load,
        "radius_m": points.radius,
        "u1_m_per_s": speed * points.u1,
        "u2_m_per_s": speed * points.u2,
        "sliding_m_per_s": speed * points.sliding,
        "sliding_across_m_per_s": speed * points.across,
        "sliding_along_m_per_s": speed * points.along,
        "entrained_along_m_per_s": speed * points.line_entrainment,
        "friction": state.friction,
        "loss_w_per_m": state.friction * points.line_load * speed * points.sliding,
        "flash_k": state.flash,
        "pinion_heat_fraction": state.heat_fraction,
        "film_m": state.film,
        "shear_factor": state.sheared,
        "film_ratio": state.film_ratio,
        "micropitting_film_ratio": state.micropitting,
    }


def _min_of(values: Array, on: Mask) -> float:
    """Return the smallest of values (m,) where the booleans `on` (m,) are True, nan if none is."""
    return float(values[on].min()) if on.any() else np.nan
