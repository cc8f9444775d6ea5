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
    """Ratios (p, 5) at the p positions of a pitch, rising, of hats of one torque with coefficients (h,).

    Force on the pinion along x, y and -z of the mesh frame (tangential, along the pinion's axis, along the
    gear's axis), the moment on the pinion about its axis and that on the face gear about its own, m; over
    the force along the line of action that carries the torque.
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
    summed = np.zeros((positions.size, 5))
    np.add.at(summed, row, parts)
    return summed * design.pinion_base_radius / float(hats.torque[0])


def excitation_table(pair: LoadedPair, states: Sequence[Running], design: PairDesign) -> pd.DataFrame:
    """One row a torque and position, columns as EXCITATION_COLUMNS."""
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
