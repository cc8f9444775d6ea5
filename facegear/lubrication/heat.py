"""Friction, heat and film at every place of the loaded contact, and the bulk temperature they bring about."""

from dataclasses import dataclass

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
class Running:
    """The flanks at one torque and speed: m places, h hats.

    `friction` mu, `flash` (K) with the pinion's `heat_fraction` of the heat, smallest `film` (m) of the line
    with shear heating, its factor `sheared`, the film of the elliptic form `short_film` (m), `film_ratio`
    lambda and `micropitting` lambda_GF, all (m,). `bulk` temperatures (C) of pinion and gear; `loss` (W) and
    the `heat` (W) that goes to each. `hat_loss` (h,) W: of each hat at its position.
    """

    friction: Array
    flash: Array
    heat_fraction: Array
    film: Array
    sheared: Array
    short_film: Array
    film_ratio: Array
    micropitting: Array
    bulk: tuple[float, float]
    loss: float
    heat: tuple[float, float]
    hat_loss: Array
    rubbing: Rubbing

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
    spots, hats = contact.places, contact.hats
    warm, oil = 0.5 * sum(bulk), known.oil
    viscosity, coefficient = float(oil.viscosity(warm)), float(oil.pressure_coefficient_at(warm))
    u1, u2, sliding = speed * spots.u1, speed * spots.u2, speed * spots.sliding
    entrained = 0.5 * (u1 + u2)
    wet = viscosity, coefficient, known.reduced_modulus
    sheared = shear_heating(
        spots.pressure,
        u1,
        u2,
        viscosity,
        oil.thinning(warm),
        oil.conductivity_of(warm),
        known.reduced_modulus,
    )
    film = sheared * line_film(spots.radius, entrained, spots.line_load, *wet)
    short = elliptic_film(
        spots.radius, entrained, spots.ellipse_force, spots.half_length / spots.half_width, *wet
    )
    rubbing = Rubbing(
        line_load=spots.line_load,
        radius=spots.radius,
        pressure=spots.pressure,
        u1=u1,
        u2=u2,
        sliding=sliding,
        pitch_speed=speed * known.pitch_radius,
        oil_viscosity=float(oil.viscosity(known.oil_temperature)),
        bulk_viscosity=viscosity,
        film_ratio=film / known.composite_rq,
        ra=known.mean_ra,
        rq=known.composite_rq,
    )
    friction = known.friction.coefficient(rubbing)
    rise, fraction = flash_at_any_speed(
        friction, spots.line_load, sliding, (u1, u2), spots.half_width, known.flanks
    )
    thin = _products(oil, warm + rise)
    slid = sliding_factor(thin, (viscosity, coefficient))
    micro = local_film(
        spots.radius, u1 + u2, spots.pressure, viscosity, coefficient, slid, known.reduced_modulus
    )
    rubbed, parted = (contact.at_hats(values) for values in (friction, fraction))
    hat_loss = rubbed * hats.force * speed * hats.sliding
    loss, to_pinion = (float(part.sum()) / contact.positions for part in (hat_loss, parted * hat_loss))
    return Running(
        friction=friction,
        flash=rise,
        heat_fraction=fraction,
        film=film,
        sheared=sheared,
        short_film=sheared * short,
        film_ratio=rubbing.film_ratio,
        micropitting=micro / known.mean_ra,
        bulk=bulk,
        loss=loss,
        heat=(to_pinion, loss - to_pinion),
        hat_loss=hat_loss,
        rubbing=rubbing,
    )


def _products(oil: Oil, temperature: Array) -> tuple[Array, Array]:
    return oil.viscosity(temperature), oil.pressure_coefficient_at(temperature)
