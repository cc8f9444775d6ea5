"""Friction of a mesh as a disturbance of the motion: its force and moments over the force of the mesh.

At every loaded hat friction acts on the pinion against the sliding velocity. The sums over the contact at
each position of a pitch keep the sign that sliding has there: it turns at the pitch line.
"""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.geometry.design import PairDesign
from facegear.lubrication.columns import EXCITATION_COLUMNS
from facegear.lubrication.heat import Running
from facegear.lubrication.kinematics import spins
from facegear.lubrication.loss import HatSlip
from facegear.lubrication.machine_loss import LoadedPair


def friction_ratios(design: PairDesign, hats: HatSlip, friction: Array) -> Array:
    """Compute force and moments of friction over the mesh force at each position of a pitch.

    The mesh force is the force along the line of action that carries the torque.

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
    (p, 5) array
        For each position, rising: force on the pinion along x, y and -z of the mesh frame (tangential, along
        the pinion's axis, along the gear's axis), dimensionless; moment on the pinion about its axis and on
        the face gear about its own, m.
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
    parts = np.stack([force[:, 0], force[:, 1], -force[:, 2], on_pinion, on_gear], axis=1)
    sums = np.zeros((positions.size, 5))
    np.add.at(sums, row, parts)
    return sums * design.pinion_base_radius / float(hats.torque[0])


def excitation_table(pair: LoadedPair, states: Sequence[Running], design: PairDesign) -> pd.DataFrame:
    """Tabulate force and moments of friction over the mesh force.

    Parameters
    ----------
    pair : LoadedPair
        The lubricated pair.
    states : Sequence[Running]
        State of the flanks at each torque.
    design : PairDesign
        Geometry of the pair.

    Returns
    -------
    pd.DataFrame
        One row for each torque and position, columns EXCITATION_COLUMNS.
    """
    frames = []
    for contact, state in zip(pair.contacts, states, strict=True):
        hats = contact.hats
        ratios = friction_ratios(design, hats, contact.at_hats(state.friction))
        ratios[:, 3:] *= 1e3
        frame = pd.DataFrame(ratios, columns=list(EXCITATION_COLUMNS[2:]))
        frame.insert(0, "torque_n_m", contact.torque)
        frame.insert(1, "position", np.unique(hats.position))
        frames.append(frame)
    return pd.concat(frames, ignore_index=True)
