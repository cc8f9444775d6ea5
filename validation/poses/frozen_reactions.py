"""Reactions of loaded contact by moving the pinion while every load stays as it is.

At rest the energy F x - gap . f - f . C f / 2 is stationary in the loads f, so that its derivative by a pose
at constant force is that of gap . f + f . C f / 2 with f held: the loads press along their normals, and other
parts of the teeth give way differently. Nothing here comes from the surface over pose.
"""

from dataclasses import replace

import numpy as np

from facegear.arrays import Array
from facegear.contact.candidates import Candidates, influence_matrix
from facegear.contact.ltca import ContactModel, even_positions, loaded_contact
from facegear.contact.options import ContactOptions
from facegear.contact.position import LoadedPosition
from facegear.contact.search import find_candidates
from facegear.teeth.design import AssemblyErrors
from facegear.teeth.placement import pinion_angle
from facegear.teeth.unloaded_contact import unloaded_motion

STEPS = {"offset": 2e-7, "gear_axial": 2e-7, "shaft_angle_error": 1e-6}
FARTHER = 1.3


def frozen_reactions(
    model: ContactModel, torque: float, positions: int, options: ContactOptions
) -> tuple[Array, Array]:
    """Return the means over a pitch of gap_p . f and of f . C_p f / 2, by offset, axial shift, shaft angle.

    Parameters
    ----------
    model : ContactModel
        Contact of the pair.
    torque : float
        Torque on the pinion, N m.
    positions : int
        Number of positions in a pitch.
    options : ContactOptions
        Options of contact.

    Returns
    -------
    (3,) array, (3,) array
        Both means, N, N and N m.
    """
    results = loaded_contact(model, even_positions(positions), [torque], options)
    phi1 = pinion_angle(model.design, [result.position for result in results])
    phi2, _ = unloaded_motion(model.design, phi1)
    parts = np.zeros((len(results), 2, len(STEPS)))
    for row, result in enumerate(results):
        placement = float(phi1[row]), float(phi2[row])
        for number, (name, step) in enumerate(STEPS.items()):
            models = [_displace_pinion(model, name, sign * step) for sign in (1.0, -1.0)]
            candidates = [
                _candidates(displaced_model, result, placement, options) for displaced_model in models
            ]
            after, before = (
                _energies(
                    displaced_model, result, pairs, [_row_by_hat(pair) for pair in opposite_pairs], options
                )
                for displaced_model, pairs, opposite_pairs in zip(
                    models, candidates, candidates[::-1], strict=True
                )
            )
            parts[row, :, number] = (after - before) / (2.0 * step)
    along, compliance_part = parts.mean(axis=0)
    return along, compliance_part


def _displace_pinion(model: ContactModel, name: str, step: float) -> ContactModel:
    errors: AssemblyErrors = model.design.assembly
    return model.with_assembly(replace(errors, **{name: getattr(errors, name) + step}))


def _candidates(
    model: ContactModel, result: LoadedPosition, placement: tuple[float, float], options: ContactOptions
) -> list[Candidates]:
    """Find the candidates of the teeth that are loaded at a position, one for each of its spots."""
    teeth = np.array([spot.tooth for spot in result.spots])
    limit = FARTHER * (result.ste - result.unloaded_error) / model.design.pinion_base_radius
    pairs = find_candidates(model.flanks, placement, teeth, limit, options)
    by_tooth = {pair.tooth: pair for pair in pairs}
    return [by_tooth[spot.tooth] for spot in result.spots]


def _energies(
    model: ContactModel,
    result: LoadedPosition,
    candidates: list[Candidates],
    also: list[dict[tuple[int, int], int]],
    options: ContactOptions,
) -> Array:
    """gap . f and f . C f / 2, (2,) J, with the loads of a position on its candidates.

    Loads on hats that the placement on the other side does not have, at the end of a tooth, are left out.
    """
    pairs, forces = [], []
    for spot, pair, other_rows in zip(result.spots, candidates, also, strict=True):
        row_by_hat = _row_by_hat(pair)
        force_by_row = {
            row_by_hat[key]: force
            for key, force in zip(_number_hats(spot.hats.tolist()), spot.force, strict=True)
            if key in row_by_hat and key in other_rows
        }
        keep = np.zeros(len(pair.hats), bool)
        keep[list(force_by_row)] = True
        pairs.append(pair.only(keep))
        forces.append(np.array([force_by_row[row] for row in sorted(force_by_row)]))
    force = np.concatenate(forces)
    assert force.sum() > 0.99 * sum(spot.force.sum() for spot in result.spots)
    gap = np.concatenate([pair.gap for pair in pairs])
    matrix = influence_matrix(pairs, model.pinion, model.gear, options.is_coupled)
    return np.array([gap @ force, 0.5 * force @ matrix @ force])


def _row_by_hat(pair: Candidates) -> dict[tuple[int, int], int]:
    return {key: row for row, key in enumerate(_number_hats(pair.hats.tolist()))}


def _number_hats(hats: list[int]) -> list[tuple[int, int]]:
    """Each hat with how often it came before: hats of a flank and of an edge may share a node."""
    counts: dict[int, int] = {}
    keys = []
    for hat in hats:
        keys.append((hat, counts.get(hat, 0)))
        counts[hat] = counts.get(hat, 0) + 1
    return keys
