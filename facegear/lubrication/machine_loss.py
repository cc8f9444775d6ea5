"""Loss and heat of a machine: those of every mesh by the power it carries, summed over its bodies.

Power that passes several meshes in turn is lost in each of them, and power that circulates in a loop as well:
loss is taken of what a mesh carries, never of what the machine is given. To first order in friction the
forces are those without it.
"""

from collections.abc import Callable
from dataclasses import dataclass, fields

import numpy as np
from scipy.optimize import NoConvergence, anderson

from facegear.arrays import Array, Integers, Mask
from facegear.errors import NotConverged
from facegear.lubrication.heat import BULK_TOLERANCE, STEPS, require_cool, starting_bulk
from facegear.lubrication.loss import OverTorque
from facegear.lubrication.pairs import LossCurves, MeshCurves, Pair
from facegear.lubrication.request import Cooling, Lubrication


@dataclass(frozen=True, eq=False)
class MeshLoads:
    """Loads of n flanks of meshes.

    `pinion` and `gear` are the numbers of their bodies. `torque` is the mean torque (N m) on the pinion,
    positive on either flank, and `peak` the largest, for heat and film. There are `bodies` bodies in all, the
    first `pinions` of them pinions.
    """

    pinion: Integers
    gear: Integers
    torque: Array
    peak: Array
    pinions: int
    bodies: int


@dataclass(frozen=True, eq=False)
class MachineLoss:
    """Loss and heat of a machine with n loaded flanks.

    `loss` (n,) W and `pinion_heat`, its part (n,) W that heats the pinion; `bulk` temperatures of the bodies
    (n, 2) C; the largest `flash` (n,) K under the peak torque with `film_ratio` and `micropitting` ratio;
    `within`: whether mean and peak lie within the torques of the contact analysis. `heat` (bodies,) W.
    """

    loss: Array
    pinion_heat: Array
    bulk: Array
    flash: Array
    film_ratio: Array
    micropitting: Array
    within: Mask
    heat: Array

    @property
    def contact_temperature(self) -> Array:
        """Largest contact temperature (n,) C of each loaded flank: mean bulk temperature plus flash."""
        return self.bulk.mean(axis=1) + self.flash

    @property
    def total(self) -> float:
        """Friction loss of all loaded flanks, W."""
        return float(self.loss.sum())


def machine_loss(pair: Pair, loads: MeshLoads, speed: float) -> MachineLoss:
    """Compute loss, heat, temperature and film of a machine from the torque that each mesh carries.

    With cooling given, a body's bulk temperature follows from the heat of all its meshes, and loss and
    temperature are iterated. Otherwise every mesh has the bulk temperatures of a single mesh at its mean
    torque. Losses use the mean torque; flash and films use the peak torque.

    Parameters
    ----------
    pair : Pair
        Lubricated tooth pair, with all contact points (LoadedPair) or few of them (ReducedPair); PairByMesh
        where the loaded flanks have contacts of their own.
    loads : MeshLoads
        Bodies, mean and peak torques (N m) of the n loaded flanks.
    speed : float
        Speed of the pinions, rad/s.

    Returns
    -------
    MachineLoss
        Loss, heat, temperature and film of every loaded flank (n,), and the heat of every body.

    Raises
    ------
    TooHot
        If a body passes the oil's flash point.
    NotConverged
        If bulk temperatures do not settle.
    """
    lubrication, count = pair.lubrication, loads.torque.size
    if not isinstance(lubrication.bulk, Cooling):
        single, single_bulk = pair.single_mesh_curves(speed)
        shape = count, pair.torques.size
        curves = MeshCurves(
            pair.torques,
            *(np.broadcast_to(getattr(single, field.name), shape) for field in fields(single)[1:]),
        )
        if len(single_bulk) == 1:
            bulk = OverTorque(pair.torques, single_bulk[0]).at(loads.torque)
        else:
            of_flanks = zip(single_bulk, loads.torque.tolist(), strict=True)
            bulk = np.stack([OverTorque(pair.torques, values).at(torque) for values, torque in of_flanks])
        return _machine_loss_of(loads, curves, speed, bulk)
    cooling = lubrication.bulk

    def step(bulk: Array) -> Array:
        """Return the bulk temperatures (n, 2) C that follow from the machine's heat at bulk temperatures
        (n, 2) C.
        """
        heat = _heat(loads, *_losses(loads, pair.losses(speed, bulk), speed))
        return _machine_bulk(loads, heat, cooling, lubrication.oil_temperature)

    bulk = settled_bulk(step, lubrication, loads.torque, speed)
    return _machine_loss_of(loads, pair.curves(speed, bulk), speed, bulk)


def settled_bulk(
    step: Callable[[Array], Array], lubrication: Lubrication, torque: Array, speed: float
) -> Array:
    """Find the fixed point of a step from bulk temperatures to bulk temperatures, by Anderson mixing.

    Parameters
    ----------
    step : callable
        Function from bulk temperatures (n, 2) C to those (n, 2) C that follow from the loss at them.
    lubrication : Lubrication
        Source of the starting temperatures and of the oil's flash point.
    torque : (n,) array
        Pinion torque of each row, N m, for the message alone.
    speed : float
        Pinion speed, rad/s, for the message alone.

    Returns
    -------
    (n, 2) array
        Bulk temperatures of pinion and gear, C, within BULK_TOLERANCE.

    Raises
    ------
    TooHot
        If a step gives a temperature above the oil's flash point.
    NotConverged
        If they do not settle within STEPS steps.
    """

    def cool(bulk: Array) -> Array:
        """Apply `step` and raise TooHot if a temperature passes the oil's flash point."""
        after = step(bulk)
        for row, load in zip(after.tolist(), torque.tolist(), strict=True):
            require_cool((row[0], row[1]), lubrication, load, speed)
        return after

    start = np.tile(starting_bulk(lubrication), (torque.size, 1))
    try:
        return anderson(
            lambda bulk: cool(bulk) - bulk,
            start,
            alpha=1.0,  # the first step takes over what `cool` gives
            f_tol=BULK_TOLERANCE,
            maxiter=STEPS,
            line_search=None,
        )
    except NoConvergence:
        attempt = f"{STEPS} steps of loss and bulk temperature"
        raise NotConverged("bulk temperature", f"{speed:g} rad/s", attempt) from None


def _losses(loads: MeshLoads, curves: LossCurves, speed: float) -> tuple[Array, Array]:
    """Return the loss (n,) of every loaded flank at its mean torque, and the part that heats the pinion,
    both in W.
    """
    loss_fraction, fraction = curves.at(loads.torque, "loss_fraction", "heat_fraction")
    loss = loss_fraction * loads.torque * speed
    return loss, fraction * loss


def _heat(loads: MeshLoads, loss: Array, warm: Array) -> Array:
    """Return the heat (bodies,) W that every body takes up, pinions first.

    `loss` (n,) is the loss of each loaded flank and `warm` (n,) the part of it that heats the pinion,
    both in W.
    """
    heat = np.zeros(loads.bodies)
    np.add.at(heat, loads.pinion, warm)
    np.add.at(heat, loads.pinions + loads.gear, loss - warm)
    return heat


def _machine_loss_of(loads: MeshLoads, curves: MeshCurves, speed: float, bulk: Array) -> MachineLoss:
    """Evaluate the curves of all loaded flanks: losses at mean torques, flash and films at peak torques.

    `curves` were computed at the pinion speed `speed`, rad/s. `bulk` (n, 2) C is stored in the result.
    """
    loss, warm = _losses(loads, curves, speed)
    flash, film_ratio, micropitting = curves.at(loads.peak, "flash", "film_ratio", "micropitting")
    torque_range = OverTorque(curves.torques, curves.torques)
    return MachineLoss(
        loss=loss,
        pinion_heat=warm,
        bulk=bulk,
        flash=flash,
        film_ratio=film_ratio,
        micropitting=micropitting,
        within=torque_range.within(loads.torque) & torque_range.within(loads.peak),
        heat=_heat(loads, loss, warm),
    )


def _machine_bulk(loads: MeshLoads, heat: Array, cooling: Cooling, oil_temperature: float) -> Array:
    """Return the bulk temperatures (n, 2) C of pinion and gear of every loaded flank: oil's plus heat /
    cooling.

    `heat` (bodies,) W is what each body takes up from all its meshes, pinions first.
    """
    rises = heat[loads.pinion] / cooling.pinion, heat[loads.pinions + loads.gear] / cooling.face_gear
    return oil_temperature + np.stack(rises, axis=1)
