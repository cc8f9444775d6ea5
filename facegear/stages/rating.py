"""Safety and life of the tooth pair under its duty cycle."""

from collections.abc import Sequence
from dataclasses import replace

import pandas as pd

from facegear.arrays import Arrays
from facegear.config.strength import Strength, duty_bins, rating_request
from facegear.config.tooth_pair import ToothPair, pair
from facegear.errors import ConfigError
from facegear.geometry.analysis import section_contact_ratio
from facegear.stages.outcome import Outcome
from facegear.strength.flank_contacts import flank_contacts
from facegear.strength.paired_flanks import met_by, worst_pressure, worst_root
from facegear.strength.posed_contacts import duty_contact_poses, posed_of
from facegear.strength.rating import FailureRating, rate
from facegear.strength.rating_tables import curve_table, damage_table, rating_table, safety_table
from facegear.strength.scuffed_flanks import with_scuffing


def rating(
    stress: Arrays,
    by_flank: pd.DataFrame,
    duty_spectrum: pd.DataFrame | None = None,
    mesh_losses: pd.DataFrame | None = None,
    posed: Arrays | None = None,
    posed_by_torque: pd.DataFrame | None = None,
    poses: Arrays | None = None,
    duty_poses: pd.DataFrame | None = None,
    *,
    tooth_pair: ToothPair,
    strength: Strength | None,
    gears: Sequence[str],
) -> Outcome:
    """Compute safety, damage and life from the root stress.

    Every flank is judged by the contacts that it has with the `gears` of the machine.

    Parameters
    ----------
    stress : Arrays
        Arrays of stage root_stress.
    by_flank : pd.DataFrame
        Table `by_flank` of stage contact.
    duty_spectrum : pd.DataFrame or None
        Table of stage duty_loads, where the loads are the machine's.
    mesh_losses : pd.DataFrame or None
        Table `meshes` of stage machine_loss, where its flanks are lubricated.
    posed : Arrays or None
        Arrays `contacts` of stage posed_stress, None unless the machine's forces pose the teeth.
    posed_by_torque : pd.DataFrame or None
        Table `by_torque` of stage posed_stress, None unless the machine's forces pose the teeth.
    poses : Arrays or None
        Arrays of stage pose_surface, None unless the machine's forces pose the teeth.
    duty_poses : pd.DataFrame or None
        Table of stage duty_poses, None unless the machine's forces pose the teeth.
    tooth_pair : ToothPair
        Section `tooth_pair` of the config.
    strength : Strength or None
        Section `strength` of the config, None if it has none.
    gears : Sequence[str]
        Face gears of the machine, `upper` alone or `upper` and `lower`.

    Returns
    -------
    Outcome
        Tables `safety`, `rating`, `damage` and `curves`.

    Raises
    ------
    ConfigError
        Without section strength.
    """
    if strength is None:
        raise ConfigError("strength", None, "given for safety and life")
    design = pair(tooth_pair).design
    request, bins = rating_request(strength, design, duty_spectrum), duty_bins(strength)
    contacts = flank_contacts(stress, by_flank)
    at_pose = posed_of(contacts, gears, posed, posed_by_torque, poses)
    stands = None if duty_poses is None else duty_contact_poses(duty_poses)
    ratings: list[FailureRating] = []
    tables: dict[str, list[pd.DataFrame]] = {}
    for duty in request.duty:
        of_loads = None
        if at_pose is None or stands is None:
            flank_contacts_met = [contacts[flank] for flank in met_by(duty, gears)]
        else:
            flank_contacts_met = [at_pose.contacts[mesh][flank] for mesh, flank in at_pose.met_by(duty)]
            of_loads = at_pose.stresses(duty, stands)
        roots, pressure = (
            {duty.gear: worst_root(duty, flank_contacts_met)},
            worst_pressure(flank_contacts_met),
        )
        alone = replace(request, duty=(duty,))
        ways = rate(design, section_contact_ratio(design), roots, pressure, alone, of_loads)
        ratings += ways
        for name, table in {
            "safety": safety_table(ways, pressure),
            "rating": rating_table(ways, pressure, roots),
            "damage": damage_table(ways, bins, pressure),
            "curves": curve_table(ways),
        }.items():
            tables.setdefault(name, []).append(table)
    content = {name: pd.concat(parts, ignore_index=True) for name, parts in tables.items()}
    if duty_spectrum is not None and mesh_losses is not None:
        content["safety"] = with_scuffing(content["safety"], duty_spectrum, mesh_losses)
    worst = min(ratings, key=lambda flank_rating: flank_rating.safety / flank_rating.required_safety)
    flank_name = f"{worst.duty.body.replace('_', ' ')}, {worst.duty.flank}"
    text = f"{flank_name}, {worst.failure} ({worst.method})"
    return Outcome(
        content,
        f"nearest to its limit: {text}, safety {worst.safety:.2f} "
        f"where {worst.required_safety:g} is required",
    )
