"""Friction, heat and film at every place of the loaded contact, and the bulk temperature they bring about."""

from dataclasses import dataclass, fields

import numpy as np

from facegear.arrays import Array
from facegear.contact.pattern import passage
from facegear.errors import FacegearError, NotConverged
from facegear.lubrication.film import elliptic_film, line_film, shear_heating
from facegear.lubrication.flash import flash_at_any_speed
from facegear.lubrication.friction import Rubbing
from facegear.lubrication.micropitting import local_film, sliding_factor
from facegear.lubrication.oil import Oil
from facegear.lubrication.places import LoadedContact, Places
from facegear.lubrication.request import BorrowedBulk, Cooling, GivenBulk, Lubrication

STEPS = 60
SETTLED = 1e-6
"""Change (K) of the bulk temperatures at which they have settled."""


class TooHot(FacegearError):
    """The cooling that is given lets a body pass the flash point of the oil."""

    def __init__(self, torque: float, speed: float, reached: float, allowed: float) -> None:
        at = f"{torque:g} N m and {speed * 30 / np.pi:.0f} rpm"
        super().__init__(
            f"lubrication.bulk: a body reaches {reached:.0f} C at {at}, above the oil's flash point of "
            f"{allowed:g} C"
        )


@dataclass(frozen=True, eq=False)
class Local:
    """What holds at m places, all (m,), or (..., m) for as many bulk temperatures.

    `friction` mu, `flash` (K) with the pinion's `heat_fraction` of the heat, smallest `film` (m) of the line
    with shear heating, its factor `sheared`, the film of the elliptic form `short_film` (m), `film_ratio`
    lambda and `micropitting` lambda_GF.
    """

    friction: Array
    flash: Array
    heat_fraction: Array
    film: Array
    sheared: Array
    short_film: Array
    film_ratio: Array
    micropitting: Array
    rubbing: Rubbing


@dataclass(frozen=True, eq=False)
class Running(Local):
    """The flanks at one torque and speed: m places, h hats.

    `bulk` temperatures (C) of pinion and gear; `loss` (W) and the `heat` (W) that goes to each. `hat_loss`
    (h,) W: of each hat at its position.
    """

    bulk: tuple[float, float]
    loss: float
    heat: tuple[float, float]
    hat_loss: Array

    @property
    def mean_bulk(self) -> float:
        """Bulk temperature (C) that the film and the contact see: the mean of both flanks."""
        return 0.5 * sum(self.bulk)


def running(contact: LoadedContact, speed: float, known: Lubrication) -> Running:
    """At the pinion's speed (rad/s); one mesh, bodies of its own.

    Where bulk temperatures follow from the loss both are iterated. Raises TooHot where a body passes the
    oil's flash point, NotConverged where they do not settle.
    """
    bulk = starting_bulk(known)
    for _ in range(STEPS):
        state = running_at(contact, speed, known, bulk)
        after = _bulk_after(state, contact.places, known)
        if settled(after, bulk):
            return state
        require_cool(after, known, contact.torque, speed)
        bulk = after
    where = f"torque {contact.torque:g} N m, {speed:g} rad/s"
    raise NotConverged("bulk temperature", where, f"{STEPS} steps of loss and bulk temperature")


def starting_bulk(known: Lubrication) -> tuple[float, float]:
    """Bulk temperatures (C) of pinion and gear to start from: those given, or the oil's."""
    if isinstance(known.bulk, GivenBulk):
        return known.bulk.temperature, known.bulk.temperature
    return known.oil_temperature, known.oil_temperature


def settled(after: tuple[float, float], before: tuple[float, float]) -> bool:
    """Whether two bulk temperatures have changed by no more than SETTLED."""
    return max(abs(new - old) for new, old in zip(after, before, strict=True)) < SETTLED


def require_cool(bulk: tuple[float, float], known: Lubrication, torque: float, speed: float) -> None:
    """Raise TooHot for bulk temperatures (C) above the oil's flash point."""
    if max(bulk) > known.oil.flash_point:
        raise TooHot(torque, speed, max(bulk), known.oil.flash_point)


def mean_flash(contact_places: Places, rise: Array) -> float:
    """Mean along the path of contact of the largest flash at each place of it (K), away from edges.

    found: places of one torque. The path runs through all positions of all pairs; 0 without any.
    """
    stage = passage(contact_places.position, contact_places.tooth)[contact_places.inside]
    if stage.size == 0:
        return 0.0
    _, row = np.unique(stage, return_inverse=True)
    largest = np.zeros(row.max() + 1)
    np.maximum.at(largest, row, rise[contact_places.inside])
    return float(largest.mean())


def warmed(heat: tuple[float, float], cooling: Cooling, oil_temperature: float) -> tuple[float, float]:
    """Bulk temperatures (C) of pinion and gear that take up `heat` (W)."""
    return (
        oil_temperature + heat[0] / cooling.pinion,
        oil_temperature + heat[1] / cooling.face_gear,
    )


def _bulk_after(state: "Running", contact_places: Places, known: Lubrication) -> tuple[float, float]:
    if isinstance(known.bulk, Cooling):
        return warmed(state.heat, known.bulk, known.oil_temperature)
    if isinstance(known.bulk, BorrowedBulk):
        rise = 0.47 * known.bulk.supply_factor * mean_flash(contact_places, state.flash)
        return known.oil_temperature + rise, known.oil_temperature + rise
    return state.bulk


def running_at(
    contact: LoadedContact, speed: float, known: Lubrication, bulk: tuple[float, float]
) -> Running:
    """The same with bulk temperatures (C) of pinion and gear as they are given."""
    hats = contact.hats
    local = local_state(contact.places, speed, known, 0.5 * sum(bulk))
    lost = hats.force * speed * hats.sliding
    hat_loss = contact.at_hats(local.friction) * lost
    to_pinion = contact.at_hats(local.friction * local.heat_fraction) * lost
    loss, heat = (float(part.sum()) / contact.positions for part in (hat_loss, to_pinion))
    return Running(
        **{field.name: getattr(local, field.name) for field in fields(local)},
        bulk=bulk,
        loss=loss,
        heat=(heat, loss - heat),
        hat_loss=hat_loss,
    )


def local_state(spots: Places, speed: float, known: Lubrication, warm: float | Array) -> Local:
    """At the pinion's speed (rad/s) and bulk temperatures (C), a number or an array (..., 1) or (..., m)."""
    oil = known.oil
    viscosity, coefficient = oil.viscosity(warm), oil.pressure_coefficient_at(warm)
    film, sheared = _line_film(spots, speed, known, warm)
    rubbing = _rubbing(spots, speed, known, viscosity, film / known.composite_rq)
    friction = known.friction.coefficient(rubbing)
    rise, fraction = _heated(spots, rubbing, friction, known)
    short = elliptic_film(
        spots.radius,
        0.5 * rubbing.rolled,
        spots.ellipse_force,
        spots.half_length / spots.half_width,
        viscosity,
        coefficient,
        known.reduced_modulus,
    )
    thin = _products(oil, warm + rise)
    micro = local_film(
        spots.radius,
        rubbing.rolled,
        spots.pressure,
        viscosity,
        coefficient,
        sliding_factor(thin, (viscosity, coefficient)),
        known.reduced_modulus,
    )
    return Local(
        friction=friction,
        flash=rise,
        heat_fraction=fraction,
        film=film,
        sheared=sheared,
        short_film=sheared * short,
        film_ratio=rubbing.film_ratio,
        micropitting=micro / known.mean_ra,
        rubbing=rubbing,
    )


def rubbed(spots: Places, speed: float, known: Lubrication, warm: float | Array) -> tuple[Array, Array]:
    """Friction coefficient and the pinion's part of the heat alone, as `local_state` has them."""
    ratio = np.full(spots.radius.shape, np.nan)
    if known.friction.by_film:
        ratio = _line_film(spots, speed, known, warm)[0] / known.composite_rq
    rubbing = _rubbing(spots, speed, known, known.oil.viscosity(warm), ratio)
    friction = known.friction.coefficient(rubbing)
    return friction, _heated(spots, rubbing, friction, known)[1]


def _line_film(spots: Places, speed: float, known: Lubrication, warm: float | Array) -> tuple[Array, Array]:
    """Smallest film (m) of the line with shear heating, and the factor that it brings."""
    oil, viscosity = known.oil, known.oil.viscosity(warm)
    u1, u2 = speed * spots.u1, speed * spots.u2
    sheared = shear_heating(
        spots.pressure,
        u1,
        u2,
        viscosity,
        oil.thinning(warm),
        oil.conductivity_of(warm),
        known.reduced_modulus,
    )
    coefficient = oil.pressure_coefficient_at(warm)
    entrained = 0.5 * (u1 + u2)
    wet = viscosity, coefficient, known.reduced_modulus
    return sheared * line_film(spots.radius, entrained, spots.line_load, *wet), sheared


def _rubbing(spots: Places, speed: float, known: Lubrication, viscosity: Array, film_ratio: Array) -> Rubbing:
    return Rubbing(
        line_load=spots.carried,
        radius=spots.radius,
        pressure=spots.pressure,
        u1=speed * spots.u1,
        u2=speed * spots.u2,
        sliding=speed * spots.sliding,
        pitch_speed=speed * known.pitch_radius,
        oil_viscosity=float(known.oil.viscosity(known.oil_temperature)),
        bulk_viscosity=viscosity,
        film_ratio=film_ratio,
        ra=known.mean_ra,
        rq=known.composite_rq,
    )


def _heated(spots: Places, rubbing: Rubbing, friction: Array, known: Lubrication) -> tuple[Array, Array]:
    """Flash temperature (K) and the pinion's part of the heat."""
    return flash_at_any_speed(
        friction,
        spots.line_load,
        rubbing.sliding,
        (rubbing.u1, rubbing.u2),
        spots.half_width,
        known.flanks,
    )


def _products(oil: Oil, temperature: Array) -> tuple[Array, Array]:
    return oil.viscosity(temperature), oil.pressure_coefficient_at(temperature)
