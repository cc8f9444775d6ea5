"""How teeth that deviate from the others of their gear disturb the mesh over the hunting cycle."""

from math import lcm

import numpy as np
import pandas as pd

from facegear.arrays import Array, Arrays
from facegear.config.tooth_pair import ToothPair, pair_design, single_teeth
from facegear.contact.gear_flank import from_arrays
from facegear.contact.teeth import ContactSide
from facegear.contact.tooth_errors import loaded_curves, located_range, orders, pair_gaps, unloaded_errors
from facegear.geometry.bodies import BODIES, Body
from facegear.geometry.flank_errors import FLANKS, pair_at
from facegear.number_format import count_noun
from facegear.stages.outcome import Outcome

ORDERS = 6


def tooth_errors(
    pinion: Arrays, face_gear: Arrays, loads: Arrays, tooth_pair: ToothPair, torque: float
) -> Outcome:
    """Compute how teeth that deviate from the others of their gear disturb the mesh over the hunting cycle.

    Parameters
    ----------
    pinion : Arrays
        Compliance of the pinion's flank, arrays of stage compliance.
    face_gear : Arrays
        Compliance of the face gear's flank, arrays of stage compliance.
    loads : Arrays
        Arrays `loads` of stage contact.
    tooth_pair : ToothPair
        Section `tooth_pair` of the config.
    torque : float
        Torque on the pinion, N m.

    Returns
    -------
    Outcome
        Arrays `curves`: what the teeth of each gear add to the transmission error under the torque, over one
        of its turns. Table `orders`: amplitudes of the first orders of either gear, with and without load.

    Raises
    ------
    NotConverged
        Where contact does not converge.
    """
    sides: dict[Body, ContactSide] = {
        "pinion": from_arrays(pinion).side,
        "face_gear": from_arrays(face_gear).side,
    }
    design = pair_design(tooth_pair)
    curves: dict[str, Array] = {}
    for number, side in enumerate(FLANKS):
        teeth = single_teeth(tooth_pair, side)
        flank_pair = pair_at(design, "upper", side)
        if side == "back":  # seen in a mirror, teeth come into mesh the other way round
            teeth = {body: (tooth_indices[0], *tooth_indices[:0:-1]) for body, tooth_indices in teeth.items()}
        variant = int(loads["flank_variant"][0, number])
        curve_by_body = loaded_curves(flank_pair, sides, loads, torque, teeth, variant)
        curves |= {f"{body}_{side}_m": curve_by_body[body] for body in BODIES}
    teeth = single_teeth(tooth_pair, "drive")
    turns = [len(tooth_indices) if len(set(tooth_indices)) > 1 else 1 for tooth_indices in teeth.values()]
    positions = np.unique(loads["position"])
    unloaded_curve = unloaded_errors(pair_gaps(design, positions), teeth, lcm(*turns))
    peak_to_peak, left = located_range(design, teeth, unloaded_curve)
    table = pd.DataFrame(
        [
            {"body": body, "order": order + 1, "unloaded_um": 1e6 * free, "loaded_um": 1e6 * loaded_amplitude}
            for body in BODIES
            if len(set(teeth[body])) > 1
            for order, (free, loaded_amplitude) in enumerate(
                zip(
                    orders(unloaded_curve, len(teeth[body]), ORDERS),
                    _curve_orders(curves[f"{body}_drive_m"]),
                    strict=True,
                )
            )
        ],
        columns=["body", "order", "unloaded_um", "loaded_um"],
    )
    loaded_range = sum(np.ptp(curves[f"{body}_drive_m"]) for body in BODIES)
    summary = (
        f"tooth to tooth {1e6 * peak_to_peak:.4g} um (within {1e6 * left:.1g}) without load over "
        f"{count_noun(len(unloaded_curve), 'mesh cycle')}, {1e6 * loaded_range:.3g} um at {torque:g} N m"
    )
    return Outcome({"curves": curves, "orders": table}, summary)


def _curve_orders(curve: Array) -> Array:
    return (2.0 * np.abs(np.fft.rfft(curve)) / curve.size)[1 : ORDERS + 1]
