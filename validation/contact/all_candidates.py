"""Contact among all candidates, with an influence matrix of any origin: no strip, no check of others."""

from collections.abc import Callable, Sequence

import numpy as np

from facegear.arrays import Array
from facegear.contact.candidates import Candidates
from facegear.contact.position_solver import PositionContact, solve_contact


def solve_candidates(
    pairs: Sequence[Candidates], influence: Callable[[], Array], torques: Array, description: str
) -> PositionContact:
    """Solve for the contact among all candidates.

    Parameters
    ----------
    pairs : Sequence of Candidates
        Candidates (m,) of each pair of teeth.
    influence : Callable
        Makes the influence matrix (m, m) of all of them, m/N.
    torques : Array
        Torques (t,) N m, the largest first.
    description : str
        Names the position in an error.

    Returns
    -------
    PositionContact
        Contact under these torques (t,), in SI units (N, m, rad).

    Raises
    ------
    NotConverged
        If the active set finds no solution.
    """
    gap, lever_arm, node, fillet = (
        np.concatenate([np.zeros(0), *(getattr(pair, name) for pair in pairs)])
        for name in ("gap", "lever_arm", "hats", "fillet")
    )
    number = np.repeat(np.arange(len(pairs)), [len(pair.hats) for pair in pairs])
    forward = lever_arm > 0
    matrix = influence() if len(pairs) else np.zeros((0, 0))
    contacts = [
        solve_contact(matrix, gap, lever_arm, torque, None, description)
        for torque in torques
        if forward.any()
    ]
    force = np.array([contact.force for contact in contacts]).reshape(-1, gap.size)
    on_pinion, on_gear = (
        np.array(
            [
                [pair.loads(side, False).T @ row[number == order] for order, pair in enumerate(pairs)]
                for row in force
            ]
        )
        for side in range(2)
    )
    ends = np.cumsum([0, *(len(pair.hats) for pair in pairs)])
    rotation, slope, residual = (
        np.array([getattr(contact, name) for contact in contacts])
        for name in ("rotation", "slope", "residual")
    )
    return PositionContact(
        teeth=np.array([pair.tooth for pair in pairs], dtype=np.int64),
        rotation=rotation,
        slope=slope,
        residual=residual,
        steps=np.array([contact.steps for contact in contacts], dtype=np.int64),
        candidates=int(ends[-1]),
        forward=int(forward.sum()),
        strip_size=int(ends[-1]),
        overlap=float(np.max(-gap[forward] / lever_arm[forward], initial=0.0)),
        pair=number,
        node=node.astype(np.int64),
        lever_arm=lever_arm,
        fillet=fillet.astype(bool),
        force=force,
        on_pinion=on_pinion,
        on_gear=on_gear,
    )
