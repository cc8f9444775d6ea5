"""Stages of strength: root stress at rest and in motion, safety and life."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from facegear.arrays import Array, Arrays
from facegear.build.lumped_model import stiffness_lags
from facegear.build.machine import MachineInputs
from facegear.build.strength import duty_bins, rating_request
from facegear.build.tooth_numbers import ToothNumbers
from facegear.build.tooth_pair import ContactSetup, ToothPair, contact_setup, pair
from facegear.contact.gear_flank import GearFlank, every_flank_from_arrays, flanks_of, gears_of
from facegear.errors import ConfigError, FacegearError
from facegear.machine.flanks import flank_places
from facegear.machine.static_gears import at_rest
from facegear.machine.statics import static_equilibrium
from facegear.motion.between_samples import finer
from facegear.motion.response_tables import shows_a_period
from facegear.pipeline.outcome import Outcome
from facegear.quantities import BODIES, Body
from facegear.schema.contact import Contact, Mesh
from facegear.schema.strength import Strength
from facegear.schema.transmission import Transmission
from facegear.strength.dynamic_stress import branch_forces, dynamic_stress_table, stress_table, swept_forces
from facegear.strength.flank_contacts import (
    flank_contacts,
    met_by,
    normal_arms,
    worst_contact,
    worst_pressure,
)
from facegear.strength.passage import coarser_roots, face_error, passing
from facegear.strength.posed_contacts import duty_contact_poses, mesh_contacts, posed_of
from facegear.strength.rating import FailureRating, rate
from facegear.strength.rating_tables import (
    curve_table,
    damage_table,
    rating_table,
    safety_table,
    with_scuffing,
)
from facegear.strength.root_stress import RootStress
from facegear.strength.root_tables import root_arrays, root_by_flank, root_tables
from facegear.teeth.design import PairDesign
from facegear.teeth.placement import FLANKS, GEARS, distinct_pairs, nominal_pairs, nominal_teeth, pair_at
from facegear.ties import first_largest_row


def root_stress(
    pinion: Arrays,
    face_gear: Arrays,
    loads: Arrays,
    tooth_pair: ToothPair,
    mesh: Mesh,
    contact: Contact,
) -> Outcome:
    """Compute the stress at the fillets of both gears while a tooth passes through the mesh, at each
    solved torque.

    Stress is superposed: nodal contact forces of stage contact times the readings of the gauges per
    unit force. Forces on fillets are left out. Tables `summary`, `passage` and `along_face` belong to
    the drive flank of the upper gear. The discretisation error along the face is estimated by a second
    solution with planes twice as far apart. It is nan where such a mesh cannot be made or its contact
    not be solved.

    Parameters
    ----------
    pinion : Arrays
        Arrays of stage compliance for the pinion: surface, compliance and gauges of its flank.
    face_gear : Arrays
        Arrays of stage compliance for the face gear.
    loads : Arrays
        Arrays `loads` of stage contact: nodal forces on both bodies by torque, position and flank.
    tooth_pair : ToothPair
        Section `tooth_pair` of the config.
    mesh : Mesh
        Section `mesh` of the config.
    contact : Contact
        Section `contact` of the config.

    Returns
    -------
    Outcome
        Tables `summary` (a row a torque, body and fillet), `passage` (over the passage of a tooth),
        `along_face` and `by_flank` (`summary` for both flanks of both gears), arrays `stress`
        (ROOT_STRESS_ARRAYS, Pa). `RootStressResult` lists the columns.

    Raises
    ------
    ConfigError
        Where the fillets carry no gauges.
    """
    setup = contact_setup(tooth_pair, mesh, contact)
    design, bodies = setup.pair.design, (every_flank_from_arrays(pinion), every_flank_from_arrays(face_gear))
    pairs = list(zip(*bodies, strict=True))
    variants = distinct_pairs(design, gears_of(design, pairs))[0]
    of_variants = [flanks_of(variant, design, pairs) for variant in variants]
    flanks: list[dict[Body, GearFlank]] = [dict(zip(BODIES, pair, strict=True)) for pair in of_variants]
    errors: list[dict[Body, float]] = []
    errors_of_teeth: dict[PairDesign, dict[Body, float]] = {}
    for number, (variant, bodies_of_flank) in enumerate(zip(variants, flanks, strict=True)):
        teeth = nominal_teeth(variant)
        if teeth not in errors_of_teeth:
            roots = {body: passing(body, flank, loads, number) for body, flank in bodies_of_flank.items()}
            errors_of_teeth[teeth] = _face_errors(setup, variant, roots)
        errors.append(errors_of_teeth[teeth])
    content = root_contents(flanks, loads, errors)
    return Outcome(content, _summary(content["by_flank"]))


def root_contents(
    flanks: Sequence[Mapping[Body, GearFlank]], loads: Arrays, face_errors: Sequence[Mapping[Body, float]]
) -> dict[str, Any]:
    """Build the tables and arrays that stage root_stress stores, for all flanks that differ.

    Parameters
    ----------
    flanks : Sequence[Mapping[Body, GearFlank]]
        Surface, compliance and gauges of both bodies, for each variant of the loads.
    loads : Arrays
        Arrays `loads` of stage contact.
    face_errors : Sequence[Mapping[Body, float]]
        Relative error of root stress by the distance of planes along the face, by body for each variant; it
        is added to the error of the mesh.

    Returns
    -------
    dict[str, Any]
        Tables `summary`, `passage`, `along_face` and `by_flank`, arrays `stress`.
    """
    numbers = loads["flank_variant"]
    variants: list[dict[str, RootStress]] = [
        {
            body: _passing(body, flank, loads, variant, face_errors[variant][body])
            for body, flank in of_variant.items()
        }
        for variant, of_variant in enumerate(flanks[: int(numbers.max()) + 1])
    ]
    positions: list[dict[str, Array]] = [
        {body: flank.gauges.position for body, flank in of_variant.items() if flank.gauges}
        for of_variant in flanks
    ]
    return {
        **root_tables(variants[0]),
        "by_flank": root_by_flank(variants, numbers),
        "stress": root_arrays(variants, numbers, positions),
    }


def _passing(body: Body, flank: GearFlank, loads: Arrays, variant: int, face_error: float) -> RootStress:
    """Return the root stress of a body over a passage, for one variant of the flanks.

    `variant` is the index of a pair that errors make differ from the others, 0 for the upper gear's
    drive flank. `face_error`, the relative error by planes along the face, is added to the error that
    `passing` gives.
    """
    root = passing(body, flank, loads, variant)
    return replace(root, error=root.error + face_error)


def _face_errors(
    setup: ContactSetup, design: PairDesign, roots: Mapping[Body, RootStress]
) -> dict[Body, float]:
    """Return the relative error of the root stress of a pair by the distance of planes along the face, by
    body.

    It is estimated from a solution with planes twice as far apart (Richardson); nan where that fails.
    """
    pair = setup.pair
    materials = {body: pair.material(body) for body in BODIES}
    try:
        coarser = coarser_roots(design, materials, setup.sizes, setup.plan, roots)
    except FacegearError:
        return dict.fromkeys(BODIES, np.nan)
    return {body: face_error(roots[body], coarser[body]) for body in BODIES}


def _summary(table: pd.DataFrame) -> str:
    """Say in one line the largest root stress of each body."""
    worst = table[table["torque_n_m"] == table["torque_n_m"].max()]
    peaks = worst.groupby("body", sort=False)["largest_mpa"].max()
    text = ", ".join(f"{body.replace('_', ' ')} {peak:.0f} MPa" for body, peak in peaks.items())
    return f"largest root stress at {worst['torque_n_m'].iloc[0]:g} N m: {text}"


FINER = 8
"""Instants for each sample of the history at which force and stress are looked at."""


def dynamic_root_stress(
    response: pd.DataFrame,
    summary: pd.DataFrame,
    stress: Arrays,
    by_flank: pd.DataFrame,
    tooth_pair: ToothPair,
    transmission: Transmission,
    teeth: ToothNumbers,
    gears: Sequence[str],
    posed_contacts: Arrays | None = None,
    posed_by_torque: pd.DataFrame | None = None,
    poses: Arrays | None = None,
) -> Outcome:
    """Compute the root stress of every mesh at the nominal speed, from the mesh forces over time.

    A tooth is quasi-static: at each instant it has the stress of the contact analysis at that force and
    that position of the mesh cycle. The history is interpolated to FINER instants a sample, as peaks
    lie between samples.

    Parameters
    ----------
    response : pd.DataFrame
        Table `response` of stage dynamics_response: force of each mesh over time.
    summary : pd.DataFrame
        Table `summary` of stage dynamics_response, which tells whether the history is one period.
    stress : Arrays
        Arrays `stress` of stage root_stress.
    by_flank : pd.DataFrame
        Table `by_flank` of stage contact.
    tooth_pair : ToothPair
        Section `tooth_pair` of the config.
    transmission : Transmission
        Section `transmission` of the config.
    teeth : ToothNumbers
        Tooth numbers, module and pressure angle of the pair.
    gears : Sequence[str]
        Face gears of the machine, `upper` alone or `upper` and `lower`; a mesh has the stress of its
        own gear and flank.
    posed_contacts : Arrays or None
        Arrays `contacts` of stage posed_stress; None unless the machine's forces pose the teeth.
    posed_by_torque : pd.DataFrame or None
        Table `by_torque` of stage posed_stress, None unless the machine's forces pose the teeth.
    poses : Arrays or None
        Arrays of stage pose_surface at the pose of the machine's mean torques, None unless its forces
        pose the teeth.

    Returns
    -------
    Outcome
        Table `dynamic_stress`, a row a mesh: largest stress over a passage with its mean force, the
        largest while running, and a bound with its largest force; see `DynamicStressResult`.
    """
    lags = stiffness_lags(transmission, teeth).reshape(len(FLANKS), -1)
    forces, positions, whole = {}, {}, shows_a_period(response, summary)
    for number, (mesh, rows) in enumerate(response.groupby("mesh", sort=False)):
        cycles, force = rows["mesh_cycle"].to_numpy(), rows["elastic_force_n"].to_numpy()
        force = finer(force, FINER, whole)
        between = (cycles[1] - cycles[0]) * np.arange(FINER) / FINER
        drive, back = flank_places(lags[:, number], (cycles[:, None] + between).ravel()).T
        forces[str(mesh)], positions[str(mesh)] = force, np.where(force < 0.0, back, drive)
    contacts = flank_contacts(stress, by_flank)
    at_pose = posed_of(contacts, gears, posed_contacts, posed_by_torque, poses)
    contacts_by_mesh = mesh_contacts(forces, contacts, gears, at_pose)
    arms = normal_arms(pair(tooth_pair).design)
    table = dynamic_stress_table(forces, positions, arms, contacts_by_mesh)
    worst = first_largest_row(table, "face_gear_running_mpa")
    summary = f"{worst['mesh']}: face gear {worst['face_gear_running_mpa']:.0f} MPa"
    return Outcome({"dynamic_stress": table}, f"{summary}, pinion {worst['pinion_running_mpa']:.0f} MPa")


def stress_over_speed(
    sweep: pd.DataFrame,
    stress: Arrays,
    by_flank: pd.DataFrame,
    inputs: MachineInputs,
    tooth_pair: ToothPair,
    gears: Sequence[str],
    branches: pd.DataFrame | None = None,
    posed_contacts: Arrays | None = None,
    posed_by_torque: pd.DataFrame | None = None,
) -> Outcome:
    """Compute root stress and pressure under the largest mesh force at each speed, over the sweep and
    stable branches.

    The force is taken to act all through the passage, so that stresses are upper bounds. The dynamic
    factor is the force over the largest mesh force at standstill.

    Parameters
    ----------
    sweep : pd.DataFrame
        Table `sweep` of stage dynamics_sweep.
    stress : Arrays
        Arrays `stress` of stage root_stress.
    by_flank : pd.DataFrame
        Table `by_flank` of stage contact.
    inputs : MachineInputs
        Everything that a machine is built from.
    tooth_pair : ToothPair
        Section `tooth_pair` of the config.
    gears : Sequence[str]
        Face gears of the machine, `upper` alone or `upper` and `lower`; a mesh has the stress of its
        own gear, on the flank where it is more.
    branches : pd.DataFrame or None
        Table `branches` of stage branches, None if there is none.
    posed_contacts : Arrays or None
        Arrays `contacts` of stage posed_stress, None unless the machine's forces pose the teeth.
    posed_by_torque : pd.DataFrame or None
        Table `by_torque` of stage posed_stress, None unless the machine's forces pose the teeth.

    Returns
    -------
    Outcome
        Table `stress_over_speed`: a row a speed and motion (a direction of the sweep or a branch);
        `worst` marks the hardest at a speed. `StressOverSpeedResult` lists the columns.

    Raises
    ------
    NotConverged
        Where the equilibrium at standstill does not converge.
    """
    machine = inputs.build()
    at_standstill = float(np.abs(static_equilibrium(at_rest(machine)).forces).max())
    forces = swept_forces(sweep)
    if branches is not None:
        forces_of_branches = branch_forces(branches, np.unique(forces["speed_rpm"]))
        forces = pd.concat([forces, forces_of_branches], ignore_index=True)
    contacts = flank_contacts(stress, by_flank)
    at_pose = posed_of(contacts, gears, posed_contacts, posed_by_torque, inputs.poses)
    contacts_by_mesh = mesh_contacts(forces["mesh"].unique(), contacts, gears, at_pose)
    arms = normal_arms(pair(tooth_pair).design)
    table = stress_table(forces, at_standstill, arms, contacts_by_mesh)
    worst = first_largest_row(table, "largest_force_n")
    position = f"{worst['speed_rpm']:.0f} rpm ({worst['motion']}, {worst['class']})"
    stresses = f"face gear {worst['face_gear_mpa']:.0f} MPa, pinion {worst['pinion_mpa']:.0f} MPa"
    summary = f"largest dynamic factor {worst['dynamic_factor']:.2f} at {position}: {stresses}"
    return Outcome({"stress_over_speed": table}, summary)


def rating(
    stress: Arrays,
    by_flank: pd.DataFrame,
    duty_spectrum: pd.DataFrame | None = None,
    mesh_losses: pd.DataFrame | None = None,
    posed_contacts: Arrays | None = None,
    posed_by_torque: pd.DataFrame | None = None,
    poses: Arrays | None = None,
    duty_poses: pd.DataFrame | None = None,
    *,
    tooth_pair: ToothPair,
    strength: Strength | None,
    gears: Sequence[str],
) -> Outcome:
    """Compute safety against tooth breakage and pitting, damage and life of every flank under the duty
    cycle.

    A flank is judged by the worst of the contacts that it has with the `gears` of the machine. Loads
    are those of `duty_spectrum` where it is given, otherwise those of section `strength` with its own
    factors. With pose arguments each load has the stress at the pose of its bin.

    Parameters
    ----------
    stress : Arrays
        Arrays `stress` of stage root_stress.
    by_flank : pd.DataFrame
        Table `by_flank` of stage contact.
    duty_spectrum : pd.DataFrame or None
        Table `duty_spectrum` of stage duty_loads, where the loads are the machine's.
    mesh_losses : pd.DataFrame or None
        Table `meshes` of stage machine_loss, where flanks are lubricated; with the spectrum it adds
        scuffing and micropitting.
    posed_contacts : Arrays or None
        Arrays `contacts` of stage posed_stress, None unless the machine's forces pose the teeth.
    posed_by_torque : pd.DataFrame or None
        Table `by_torque` of stage posed_stress, None unless the machine's forces pose the teeth.
    poses : Arrays or None
        Arrays `surface` of stage pose_surface, None unless the machine's forces pose the teeth.
    duty_poses : pd.DataFrame or None
        Table `duty_poses` of stage duty_poses, None unless the machine's forces pose the teeth.
    tooth_pair : ToothPair
        Section `tooth_pair` of the config.
    strength : Strength or None
        Section `strength` of the config, None if it has none.
    gears : Sequence[str]
        Face gears of the machine, `upper` alone or `upper` and `lower`.

    Returns
    -------
    Outcome
        Tables `safety` (a row a flank), `rating` (a row a flank, failure and method), `damage` (a row a
        bin of the duty cycle for each of these) and `curves` (stress that may be repeated a number of
        times). `RatingResult` lists the columns.

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
    at_pose = posed_of(contacts, gears, posed_contacts, posed_by_torque, poses)
    stands = None if duty_poses is None else duty_contact_poses(duty_poses)
    has_other_bodies = len(nominal_pairs(design, gears)) > 1
    ratings: list[FailureRating] = []
    tables: dict[str, list[pd.DataFrame]] = {}
    for duty in request.duty:
        of_loads, contacts_met = None, met_by(duty, gears)
        of_body = {(gear, flank): contacts[gear, flank] for gear, _ in contacts_met for flank in FLANKS}
        if at_pose is not None and stands is not None:
            contacts_met, of_loads = at_pose.met_by(duty), at_pose.stresses(duty, stands)
            of_body = at_pose.of_body(duty.gear, contacts_met)
        worst_at = worst_contact(duty, {at: of_body[at] for at in contacts_met})
        roots = {duty.gear: of_body[worst_at].roots[duty.gear]}
        pressure = worst_pressure([of_body[at] for at in contacts_met])
        # flanks on other bodies bend teeth back in another way than the mirror image of the rated contact
        (other_flank,) = set(FLANKS) - {worst_at[1]}
        opposite = [
            contact.roots[duty.gear] for (_, flank), contact in of_body.items() if flank == other_flank
        ]
        ways = rate(
            pair_at(design, GEARS[0], worst_at[1]),
            roots,
            pressure,
            replace(request, duty=(duty,)),
            of_loads,
            opposite if has_other_bodies else (),
        )
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
