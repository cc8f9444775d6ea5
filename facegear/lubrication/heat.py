"""Friction, heat and film at every place of the loaded contact, and the bulk temperature they bring about."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from facegear.errors import FacegearError, NotConverged
from facegear.lubrication.film import elliptic_film, line_film, shear_heating
from facegear.lubrication.flash import Heated, flash_at_any_speed
from facegear.lubrication.friction import FrictionModel, Rubbing
from facegear.lubrication.loss import HatSlip
from facegear.lubrication.micropitting import local_film, sliding_factor
from facegear.lubrication.oil import Oil
from facegear.lubrication.places import Places, at_hats

Array = NDArray[np.float64]

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


@dataclass(frozen=True)
class GivenBulk:
    """Bulk temperature (C) of both flanks, whatever the loss."""

    temperature: float


@dataclass(frozen=True)
class Cooling:
    """Heat (W/K) that pinion and face gear give off to the oil; bulk temperatures follow from the loss."""

    pinion: float
    face_gear: float


@dataclass(frozen=True, eq=False)
class Lubrication:
    """What the flanks run with.

    `oil_temperature` (C) as supplied; `ra` and `rq` (m) of pinion and gear; `reduced_modulus` E_r = 2 E*
    (Pa); `pitch_radius` (m) of the pinion.
    """

    oil: Oil
    oil_temperature: float
    friction: FrictionModel
    ra: tuple[float, float]
    rq: tuple[float, float]
    bulk: GivenBulk | Cooling
    flanks: tuple[Heated, Heated]
    reduced_modulus: float
    pitch_radius: float

    @property
    def mean_ra(self) -> float:
        """Mean of both flanks' Ra, m."""
        return 0.5 * sum(self.ra)

    @property
    def composite_rq(self) -> float:
        """Root of the sum of the squares of Rq, m."""
        return float(np.hypot(*self.rq))


@dataclass(frozen=True, eq=False)
class Running:
    """The flanks at one torque and speed: m places, h hats.

    `friction` mu, `flash` (K) with the pinion's `share` of the heat, smallest `film` (m) of the line with
    shear heating, its factor `sheared`, the film of the elliptic form `short_film` (m), `film_ratio` lambda
    and `micropitting` lambda_GF, all (m,). `bulk` temperatures (C) of pinion and gear; `loss` (W) and the
    `heat` (W) that goes to each. `hat_loss` (h,) W: of each hat at its position.
    """

    friction: Array
    flash: Array
    share: Array
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


def running(found: Places, hats: HatSlip, speed: float, known: Lubrication) -> Running:
    """Of the places and hats of a single torque at the pinion's speed (rad/s); one mesh, bodies of its own.

    With cooling given, bulk temperatures and loss are iterated. Raises TooHot where a body passes the oil's
    flash point, NotConverged where they do not settle.
    """
    positions = np.unique(hats.position).size
    bulk = _start(known)
    for _ in range(STEPS):
        state = _at_bulk(found, hats, speed, known, bulk, positions)
        after = bulk_temperatures(state.heat, known)
        if max(abs(new - old) for new, old in zip(after, bulk, strict=True)) < SETTLED:
            return state
        if max(after) > known.oil.flash_point:
            raise TooHot(float(found.torque[0]), speed, max(after), known.oil.flash_point)
        bulk = after
    where = f"torque {found.torque[0]:g} N m, {speed:g} rad/s"
    raise NotConverged("bulk temperature", where, f"{STEPS} steps of loss and bulk temperature")


def bulk_temperatures(heat: tuple[float, float], known: Lubrication) -> tuple[float, float]:
    """Of pinion and gear (C) that take up `heat` (W): what the oil has plus heat over what is given off."""
    if isinstance(known.bulk, GivenBulk):
        return known.bulk.temperature, known.bulk.temperature
    return (
        known.oil_temperature + heat[0] / known.bulk.pinion,
        known.oil_temperature + heat[1] / known.bulk.face_gear,
    )


def _start(known: Lubrication) -> tuple[float, float]:
    if isinstance(known.bulk, GivenBulk):
        return known.bulk.temperature, known.bulk.temperature
    return known.oil_temperature, known.oil_temperature


def _at_bulk(
    found: Places, hats: HatSlip, speed: float, known: Lubrication, bulk: tuple[float, float], positions: int
) -> Running:
    warm, oil = 0.5 * sum(bulk), known.oil
    viscosity, coefficient = float(oil.viscosity(warm)), float(oil.pressure_coefficient_at(warm))
    u1, u2, sliding = speed * found.u1, speed * found.u2, speed * found.sliding
    entrained = 0.5 * (u1 + u2)
    wet = viscosity, coefficient, known.reduced_modulus
    sheared = shear_heating(
        found.pressure,
        u1,
        u2,
        viscosity,
        oil.thinning(warm),
        oil.conductivity_of(warm),
        known.reduced_modulus,
    )
    film = sheared * line_film(found.radius, entrained, found.line_load, *wet)
    _, short = elliptic_film(
        found.radius, entrained, found.ellipse_force, found.half_length / found.half_width, *wet
    )
    rubbing = Rubbing(
        line_load=found.line_load,
        radius=found.radius,
        pressure=found.pressure,
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
    rise, share = flash_at_any_speed(
        friction, found.line_load, sliding, (u1, u2), found.half_width, known.flanks
    )
    thin = _products(oil, warm + rise)
    slid = sliding_factor(thin, (viscosity, coefficient))
    micro = local_film(
        found.radius, u1 + u2, found.pressure, viscosity, coefficient, slid, known.reduced_modulus
    )
    rubbed, parted = (at_hats(found, hats, values) for values in (friction, share))
    hat_loss = rubbed * hats.force * speed * hats.sliding
    loss, warmed = float(hat_loss.sum()) / positions, float((parted * hat_loss).sum()) / positions
    return Running(
        friction=friction,
        flash=rise,
        share=share,
        film=film,
        sheared=sheared,
        short_film=sheared * short,
        film_ratio=rubbing.film_ratio,
        micropitting=micro / known.mean_ra,
        bulk=bulk,
        loss=loss,
        heat=(warmed, loss - warmed),
        hat_loss=hat_loss,
        rubbing=rubbing,
    )


def _products(oil: Oil, temperature: Array) -> tuple[Array, Array]:
    return oil.viscosity(temperature), oil.pressure_coefficient_at(temperature)
