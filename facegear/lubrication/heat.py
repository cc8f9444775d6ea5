"""Friction, heat and film at every point of the loaded contact, and the bulk temperature they bring about."""

from dataclasses import dataclass, fields

import numpy as np

from facegear.arrays import Array
from facegear.contact.pattern import passage
from facegear.errors import FacegearError, NotConverged
from facegear.lubrication.contact_points import ContactPoints, LoadedContact
from facegear.lubrication.film import elliptic_film, line_film, local_film, shear_heating, sliding_factor
from facegear.lubrication.flash import flash_at_any_speed
from facegear.lubrication.friction_formulas import Rubbing
from facegear.lubrication.oil import Oil
from facegear.lubrication.request import BorrowedBulk, Cooling, GivenBulk, Lubrication

STEPS = 60
"""Largest number of steps of the iteration of loss and bulk temperature."""
BULK_TOLERANCE = 1e-6
"""Change (K) of the bulk temperatures at which they have settled."""


class TooHot(FacegearError):
    """The cooling that is given lets a body pass the flash point of the oil."""

    def __init__(self, torque: float, speed: float, temperature: float, flash_point: float) -> None:
        at = f"{torque:g} N m and {speed * 30 / np.pi:.0f} rpm"
        super().__init__(
            f"lubrication.bulk: a body reaches {temperature:.0f} C at {at}, above the oil's flash point of "
            f"{flash_point:g} C"
        )


@dataclass(frozen=True, eq=False)
class Local:
    """Local state at m points, all (m,), or (..., m) for as many bulk temperatures.

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
    """State of the flanks at one torque and speed, with m points and h hats.

    `bulk` temperatures (C) of pinion and gear; `loss` (W) and the `heat` (W) that goes to each. `hat_loss`
    (h,) W: of each hat at its position.
    """

    bulk: tuple[float, float]
    loss: float
    heat: tuple[float, float]
    hat_loss: Array

    @property
    def mean_bulk(self) -> float:
        """Mean of both flanks' bulk temperatures, C, at which film and contact are evaluated."""
        return 0.5 * sum(self.bulk)


def running(contact: LoadedContact, speed: float, lubrication: Lubrication) -> Running:
    """Compute friction, heat and film of one mesh alone at one torque, with its bulk temperatures.

    A given bulk temperature is taken as it is. Otherwise loss and bulk temperature are iterated (plain
    fixed-point steps from the oil's temperature): the bodies take up the heat of this mesh only.

    Parameters
    ----------
    contact : LoadedContact
        Contact at one torque.
    speed : float
        Pinion speed, rad/s.
    lubrication : Lubrication
        Oil, roughness, friction model and the rule of the bulk temperature (`lubrication.bulk`).

    Returns
    -------
    Running
        State at the m points and h hats, with bulk temperatures (C), loss and heat (W).

    Raises
    ------
    TooHot
        If a body passes the oil's flash point.
    NotConverged
        If loss and bulk temperature do not settle within STEPS steps.
    """
    bulk = starting_bulk(lubrication)
    for _ in range(STEPS):
        state = running_at(contact, speed, lubrication, bulk)
        after = _bulk_after(state, contact.points, lubrication)
        if has_settled(after, bulk):
            return state
        require_cool(after, lubrication, contact.torque, speed)
        bulk = after
    load_point = f"torque {contact.torque:g} N m, {speed:g} rad/s"
    raise NotConverged("bulk temperature", load_point, f"{STEPS} steps of loss and bulk temperature")


def starting_bulk(lubrication: Lubrication) -> tuple[float, float]:
    """Return the bulk temperatures to start an iteration from: the given one, else the oil's as supplied.

    Parameters
    ----------
    lubrication : Lubrication
        `bulk` is used if it is a GivenBulk, else `oil_temperature`.

    Returns
    -------
    tuple[float, float]
        Temperatures of pinion and gear, C, which are equal.
    """
    if isinstance(lubrication.bulk, GivenBulk):
        return lubrication.bulk.temperature, lubrication.bulk.temperature
    return lubrication.oil_temperature, lubrication.oil_temperature


def has_settled(after: tuple[float, float], before: tuple[float, float]) -> bool:
    """Whether two bulk temperatures have changed by less than BULK_TOLERANCE.

    Parameters
    ----------
    after : tuple[float, float]
        Temperatures of pinion and gear after a step, C.
    before : tuple[float, float]
        Temperatures before it, C.

    Returns
    -------
    bool
        True if they have settled.
    """
    return max(abs(new - old) for new, old in zip(after, before, strict=True)) < BULK_TOLERANCE


def require_cool(bulk: tuple[float, float], lubrication: Lubrication, torque: float, speed: float) -> None:
    """Require that bulk temperatures do not exceed the oil's flash point.

    Parameters
    ----------
    bulk : tuple[float, float]
        Temperatures of pinion and gear, C.
    lubrication : Lubrication
        How the flanks are lubricated.
    torque : float
        Torque on the pinion, N m, for the message.
    speed : float
        Pinion speed, rad/s, for the message.

    Raises
    ------
    TooHot
        If one does.
    """
    if max(bulk) > lubrication.oil.flash_point:
        raise TooHot(torque, speed, max(bulk), lubrication.oil.flash_point)


def mean_flash(contact_places: ContactPoints, rise: Array) -> float:
    """Average the flash temperature along the path of contact, for ISO's integral and bulk temperatures.

    A stage of the path is one position of one tooth pair. At each stage the largest flash of the contact
    line counts, and points near edges are left out. All stages weigh the same.

    Parameters
    ----------
    contact_places : ContactPoints
        Contact points (m,) of one torque.
    rise : (m,) array
        Flash temperature at each point, K.

    Returns
    -------
    float
        Mean flash temperature, K; 0 without any point away from edges.
    """
    stage = passage(contact_places.position, contact_places.tooth)[contact_places.inside]
    if stage.size == 0:
        return 0.0
    _, row = np.unique(stage, return_inverse=True)
    largest = np.zeros(row.max() + 1)
    np.maximum.at(largest, row, rise[contact_places.inside])
    return float(largest.mean())


def warmed(heat: tuple[float, float], cooling: Cooling, oil_temperature: float) -> tuple[float, float]:
    """Compute the bulk temperatures of bodies that take up heat: the oil's plus heat / cooling.

    Parameters
    ----------
    heat : tuple[float, float]
        Heat that goes to pinion and gear, W.
    cooling : Cooling
        Heat that pinion and face gear give off to the oil per degree above it, W/K.
    oil_temperature : float
        Temperature of the oil as supplied, C.

    Returns
    -------
    tuple[float, float]
        Temperatures of pinion and gear, C.
    """
    return (
        oil_temperature + heat[0] / cooling.pinion,
        oil_temperature + heat[1] / cooling.face_gear,
    )


def _bulk_after(
    state: "Running", contact_places: ContactPoints, lubrication: Lubrication
) -> tuple[float, float]:
    """Return the bulk temperatures of pinion and gear, C, that follow from a state, by the rule
    `lubrication.bulk`.

    With Cooling from the heat of each body, with BorrowedBulk from the mean flash; with GivenBulk
    unchanged.
    """
    if isinstance(lubrication.bulk, Cooling):
        return warmed(state.heat, lubrication.bulk, lubrication.oil_temperature)
    if isinstance(lubrication.bulk, BorrowedBulk):
        rise = 0.47 * lubrication.bulk.supply_factor * mean_flash(contact_places, state.flash)
        return lubrication.oil_temperature + rise, lubrication.oil_temperature + rise
    return state.bulk


def running_at(
    contact: LoadedContact, speed: float, lubrication: Lubrication, bulk: tuple[float, float]
) -> Running:
    """Compute friction, heat and film of one mesh at one torque and at given bulk temperatures.

    Loss is the mean over the pitch of friction times normal force times sliding velocity, summed over the
    hats.

    Parameters
    ----------
    contact : LoadedContact
        Contact at one torque.
    speed : float
        Pinion speed, rad/s.
    lubrication : Lubrication
        Oil, roughness and friction model; `lubrication.bulk` is not used.
    bulk : tuple[float, float]
        Bulk temperatures of pinion and gear, C.

    Returns
    -------
    Running
        State at the m points and h hats, with loss (W) and the heat (W) to pinion and gear.
    """
    hats = contact.hats
    local = local_state(contact.points, speed, lubrication, 0.5 * sum(bulk))
    sliding_power = hats.force * speed * hats.sliding
    hat_loss = contact.at_hats(local.friction) * sliding_power
    to_pinion = contact.at_hats(local.friction * local.heat_fraction) * sliding_power
    loss, heat = (float(part.sum()) / contact.positions for part in (hat_loss, to_pinion))
    return Running(
        **{field.name: getattr(local, field.name) for field in fields(local)},
        bulk=bulk,
        loss=loss,
        heat=(heat, loss - heat),
        hat_loss=hat_loss,
    )


def local_state(spots: ContactPoints, speed: float, lubrication: Lubrication, warm: float | Array) -> Local:
    """Compute friction coefficient, flash temperature and film thickness at contact points.

    The line film is Dowson and Higginson's with shear heating, the short film Hamrock and Dowson's with
    the same factor, and the micropitting film that of ISO/TS 6336-22. Everything is evaluated at the bulk
    temperature, but the sliding factor of the micropitting film at bulk plus flash.

    Parameters
    ----------
    spots : ContactPoints
        Contact points (m,).
    speed : float
        Pinion speed, rad/s.
    lubrication : Lubrication
        Oil, roughness, friction model and flank materials.
    warm : float or Array
        Mean bulk temperature of both flanks, C, a number or an array (..., 1) or (..., m).

    Returns
    -------
    Local
        Local state, each field (m,) or (..., m).
    """
    oil = lubrication.oil
    viscosity, coefficient = oil.viscosity(warm), oil.pressure_coefficient_at(warm)
    film, sheared = _line_film(spots, speed, lubrication, warm)
    rubbing = _rubbing(spots, speed, lubrication, viscosity, film / lubrication.composite_rq)
    friction = lubrication.friction.coefficient(rubbing)
    rise, fraction = _flash_temperature(spots, rubbing, friction, lubrication)
    short = elliptic_film(
        spots.radius,
        0.5 * rubbing.sum_velocity,
        spots.ellipse_force,
        spots.half_length / spots.half_width,
        viscosity,
        coefficient,
        lubrication.reduced_modulus,
    )
    thin = _products(oil, warm + rise)
    micro = local_film(
        spots.radius,
        rubbing.sum_velocity,
        spots.pressure,
        viscosity,
        coefficient,
        sliding_factor(thin, (viscosity, coefficient)),
        lubrication.reduced_modulus,
    )
    return Local(
        friction=friction,
        flash=rise,
        heat_fraction=fraction,
        film=film,
        sheared=sheared,
        short_film=sheared * short,
        film_ratio=rubbing.film_ratio,
        micropitting=micro / lubrication.mean_ra,
        rubbing=rubbing,
    )


def friction_and_heat_fraction(
    spots: ContactPoints, speed: float, lubrication: Lubrication, warm: float | Array
) -> tuple[Array, Array]:
    """Compute only the friction coefficient and the pinion's fraction of the heat, as `local_state` does.

    It saves the films: the line film is computed only if the friction model depends on it.

    Parameters
    ----------
    spots : ContactPoints
        Contact points (m,).
    speed : float
        Pinion speed, rad/s.
    lubrication : Lubrication
        Oil, roughness, friction model and flank materials.
    warm : float or Array
        Mean bulk temperature of both flanks, C, a number or an array (..., 1) or (..., m).

    Returns
    -------
    two (m,) or (..., m) arrays
        Friction coefficient and the pinion's fraction of the heat, dimensionless.
    """
    ratio = np.full(spots.radius.shape, np.nan)
    if lubrication.friction.by_film:
        ratio = _line_film(spots, speed, lubrication, warm)[0] / lubrication.composite_rq
    rubbing = _rubbing(spots, speed, lubrication, lubrication.oil.viscosity(warm), ratio)
    friction = lubrication.friction.coefficient(rubbing)
    return friction, _flash_temperature(spots, rubbing, friction, lubrication)[1]


def _line_film(
    spots: ContactPoints, speed: float, lubrication: Lubrication, warm: float | Array
) -> tuple[Array, Array]:
    """Return the smallest film (m) of the line contact at each point, reduced by inlet shear heating, and
    the reduction factor, both (m,) or (..., m); `warm` is the mean bulk temperature, C.
    """
    oil, viscosity = lubrication.oil, lubrication.oil.viscosity(warm)
    u1, u2 = speed * spots.u1, speed * spots.u2
    sheared = shear_heating(
        spots.pressure,
        u1,
        u2,
        viscosity,
        oil.thinning(warm),
        oil.conductivity_of(warm),
        lubrication.reduced_modulus,
    )
    coefficient = oil.pressure_coefficient_at(warm)
    entrainment_speed = 0.5 * np.abs(u1 + u2)
    wet = viscosity, coefficient, lubrication.reduced_modulus
    return sheared * line_film(spots.radius, entrainment_speed, spots.line_load, *wet), sheared


def _rubbing(
    spots: ContactPoints, speed: float, lubrication: Lubrication, viscosity: Array, film_ratio: Array
) -> Rubbing:
    """Return loads, radii, speeds and oil data of contact points for the friction formulas.

    `speed` is the pinion's, rad/s; `viscosity` (Pa s) is at the bulk temperature; `film_ratio` is the
    film over the composite Rq. The line load is `scaled_load`, in which a line carries the whole force of
    its hats.
    """
    return Rubbing(
        line_load=spots.scaled_load,
        radius=spots.radius,
        pressure=spots.pressure,
        u1=speed * spots.u1,
        u2=speed * spots.u2,
        sliding=speed * spots.sliding,
        pitch_speed=speed * lubrication.pitch_radius,
        oil_viscosity=float(lubrication.oil.viscosity(lubrication.oil_temperature)),
        bulk_viscosity=viscosity,
        film_ratio=film_ratio,
        ra=lubrication.mean_ra,
        rq=lubrication.composite_rq,
    )


def _flash_temperature(
    spots: ContactPoints, rubbing: Rubbing, friction: Array, lubrication: Lubrication
) -> tuple[Array, Array]:
    """Return the flash temperature (K) at each point and the pinion's fraction of the heat, both (...,
    m).
    """
    return flash_at_any_speed(
        friction,
        spots.line_load,
        rubbing.sliding,
        (rubbing.u1, rubbing.u2),
        spots.half_width,
        lubrication.flanks,
    )


def _products(oil: Oil, temperature: Array) -> tuple[Array, Array]:
    """Return the two factors of an oil's alpha eta at temperatures (C): viscosity, Pa s, and pressure
    coefficient, 1/Pa, in the shape of the temperatures.
    """
    return oil.viscosity(temperature), oil.pressure_coefficient_at(temperature)
