"""Stages of the loaded contact of the tooth pair, and of the laws and errors that follow from it."""

from collections.abc import Mapping, Sequence
from math import lcm
from typing import Any

import numpy as np
import pandas as pd

from facegear.arrays import Array, Arrays
from facegear.build.plans import contact_plan, stiffness_request
from facegear.build.tooth_pair import ToothPair, pair, pair_design, single_teeth
from facegear.contact.analysis import ContactAnalysis, contact_analysis
from facegear.contact.gear_flank import every_flank_from_arrays, flank_models
from facegear.contact.ltca import ContactModel, even_positions, loaded_contact
from facegear.contact.options import ContactOptions
from facegear.contact.pattern import FILLET_CONTACT
from facegear.contact.position import LoadedPosition
from facegear.contact.summary import StudiedContact, study_table
from facegear.contact.teeth import ContactSide
from facegear.contact.tooth_errors import loaded_curves, located_range, orders, pair_gaps, unloaded_errors
from facegear.errors import FacegearError
from facegear.meshing.fitted_law import FlankContacts, fitted_tables, law_arrays, law_torques, level_table
from facegear.meshing.stiffness_curve import load_table
from facegear.meshing.stiffness_request import StiffnessRequest
from facegear.number_format import count_noun, format_number
from facegear.pipeline.outcome import Outcome
from facegear.quantities import BODIES, Body
from facegear.schema.contact import Contact
from facegear.schema.stiffness import MeshStiffness
from facegear.teeth.placement import FLANKS, nominal_pairs, nominal_teeth, pair_at


def contact(
    pinion: Arrays,
    face_gear: Arrays,
    tooth_pair: ToothPair,
    contact: Contact,
) -> Outcome:
    """Solve the loaded tooth contact at every position of a pitch and every torque, on condensed FE
    compliances.

    All parts but `by_flank` and `loads` belong to the drive flank of the upper gear; `pressure` of teeth
    other than spur ones has further arrays of the other flanks. These are solved where they differ from it.

    Parameters
    ----------
    pinion : Arrays
        Arrays of stage compliance for the pinion: surface and compliance of its flank.
    face_gear : Arrays
        Arrays of stage compliance for the face gear.
    tooth_pair : ToothPair
        Section `tooth_pair` of the config.
    contact : Contact
        Section `contact` of the config: torques (N m on the pinion), positions, options of the solver.

    Returns
    -------
    Outcome
        Tables `ltca` (a row a torque and position), `by_torque` and `by_flank`, described by
        `ContactResult`, and `ltca_by_flank` (see `contents`). Arrays `pressure` (PRESSURE_ARRAYS) and
        `loads` (nodal forces on both bodies, LOAD_ARRAYS).

    Raises
    ------
    NotConverged
        Naming position and torque.
    """
    teeth, plan = pair(tooth_pair), contact_plan(contact)
    flanks = list(zip(*map(every_flank_from_arrays, (pinion, face_gear)), strict=True))
    analysis = contact_analysis(teeth.design, teeth.materials, flanks, plan)
    return Outcome(contents(analysis), _mean_stiffness(analysis.ltca[0]))


def contents(analysis: ContactAnalysis) -> dict[str, Any]:
    """Return the tables and arrays that stage contact stores.

    Parameters
    ----------
    analysis : ContactAnalysis
        Solved contact of all flanks that differ.

    Returns
    -------
    dict[str, Any]
        Tables `ltca`, `by_torque` and `by_flank`, arrays `pressure` and `loads`; `ltca` and `by_torque` of
        the upper gear's drive flank, and `pressure` of spur teeth as well. Table `ltca_by_flank`:
        `ContactAnalysis.other_flanks`.
    """
    return {
        "ltca": analysis.ltca[0],
        "ltca_by_flank": analysis.other_flanks,
        "by_torque": analysis.by_torque[0],
        "by_flank": analysis.by_flank,
        "pressure": analysis.stored_pressure,
        "loads": analysis.loads,
    }


def _mean_stiffness(table: pd.DataFrame) -> str:
    """Say the mean average stiffness of a contact table, or why there is none, for the summary.

    Where fillets carry FILLET_CONTACT of the torque or more, their largest share is named as well.
    """
    mean, row = table["k_average_n_per_m"].mean(skipna=False), table.loc[table["fillet_share"].idxmax()]
    text = f"mean stiffness {format_number(1e-6 * mean)} N/um"
    if np.isnan(mean):
        depth = table["interference_um"].max()
        text = f"no mean stiffness as the teeth interfere, by {depth:.3g} um along the line of action"
    if row["fillet_share"] < FILLET_CONTACT:
        return text
    fillet_text = f"{100 * row['fillet_share']:.2g} % of the torque at {row['torque_n_m']:g} N m"
    return f"{text}, fillets carry up to {fillet_text}, kept out of pressure and root stress"


def contact_studies(
    points: Sequence[Sequence[str]],
    pair: Sequence[Mapping[str, Any]],
    ltca: Sequence[pd.DataFrame],
    by_torque: Sequence[pd.DataFrame],
    pressure: Sequence[Arrays],
) -> Outcome:
    """Collect the contact of the studies' cases side by side.

    Parameters
    ----------
    points : Sequence[Sequence[str]]
        Study, point and label of each case; the machine itself (`nominal`) first.
    pair : Sequence[Mapping[str, Any]]
        Record `pair` of stage geometry of each case.
    ltca : Sequence[pd.DataFrame]
        Table `ltca` of stage contact of each case.
    by_torque : Sequence[pd.DataFrame]
        Table `by_torque` of stage contact of each case.
    pressure : Sequence[Arrays]
        Arrays `pressure` of stage contact of each case.

    Returns
    -------
    Outcome
        `table`, a row for each case and torque: study, point, label, the columns of `by_torque`, and
        the shifts of the contact path from the machine itself (mm, positive outwards); see
        `study_table` of `facegear.contact.summary`.
    """
    cases = StudiedContact.from_columns(points, pair, ltca, by_torque, pressure)
    table = study_table(cases)
    shift = table.loc[table["path_shift_mm"].abs().idxmax()]
    largest = f"{shift['path_shift_mm']:.2f} mm ({shift['label']})"
    return Outcome(
        {"table": table}, f"{count_noun(len(cases) - 1, 'case')}; largest shift of the contact path {largest}"
    )


ORDERS = 6
"""Number of orders of a gear's turn that the table of tooth errors lists; higher ones stay in the curves."""


def tooth_errors(
    pinion: Arrays, face_gear: Arrays, loads: Arrays, tooth_pair: ToothPair, torque: float
) -> Outcome:
    """Compute how teeth that deviate from the others of their gear disturb the mesh.

    The unloaded transmission error follows tooth pair by tooth pair over the hunting cycle. Under the
    torque each gear's contribution is computed over one of its turns, with the loads of stage contact.

    Parameters
    ----------
    pinion : Arrays
        Compliance of the pinion's flank, arrays of stage compliance.
    face_gear : Arrays
        Compliance of the face gear's flank, arrays of stage compliance.
    loads : Arrays
        Arrays `loads` of stage contact: nodal forces by torque, position and flank.
    tooth_pair : ToothPair
        Section `tooth_pair` of the config.
    torque : float
        Torque on the pinion, N m, at which the loaded curves are taken.

    Returns
    -------
    Outcome
        Arrays `curves`, `<body>_<flank>_m` for both bodies and flanks: what its teeth add to the
        transmission error under the torque, at even positions of one turn, m, positive where teeth come
        early. Table `orders`: body, order of its turn (1 to ORDERS), unloaded_um and loaded_um,
        amplitudes on the drive flank; only bodies whose teeth differ.

    Raises
    ------
    NotConverged
        Where contact does not converge.
    """
    design = pair_design(tooth_pair)
    bodies = nominal_pairs(design)
    flanks = list(zip(*map(every_flank_from_arrays, (pinion, face_gear)), strict=True))
    curves: dict[str, Array] = {}
    for number, side in enumerate(FLANKS):
        teeth = single_teeth(tooth_pair, side)
        flank_pair = pair_at(design, "upper", side)
        on_pinion, on_gear = flanks[bodies.index(nominal_teeth(flank_pair))]
        sides: dict[Body, ContactSide] = {"pinion": on_pinion.side, "face_gear": on_gear.side}
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
    """Return the amplitudes (ORDERS,) of orders 1 to ORDERS of a curve over one period, in the unit of
    the curve.
    """
    return (2.0 * np.abs(np.fft.rfft(curve)) / curve.size)[1 : ORDERS + 1]


DEFAULT = ContactOptions()
"""Options of contact of a pair for which the config says nothing."""


def mesh_law(
    pinion: Arrays,
    face_gear: Arrays,
    ltca: pd.DataFrame,
    tooth_pair: ToothPair,
    contact: Contact,
    mesh_stiffness: MeshStiffness,
) -> Outcome:
    """Compute the load-dependent mesh law: force of a flank over its deflection and the phase of the
    mesh.

    Contact is solved over a pitch at more torques. Tables of cubics over deflection with Fourier series
    over phase are fitted to forces and slopes. A law is made for every flank that errors make differ
    from the others.

    Parameters
    ----------
    pinion : Arrays
        Compliance of the pinion's flank, arrays of stage compliance.
    face_gear : Arrays
        Compliance of the face gear's flank, arrays of stage compliance.
    ltca : pd.DataFrame
        Table `ltca` of stage contact; with source fem_scaled it decides the factor on all forces (see
        `_scale`).
    tooth_pair : ToothPair
        Section `tooth_pair` of the config.
    contact : Contact
        Section `contact` of the config.
    mesh_stiffness : MeshStiffness
        Section `mesh_stiffness` of the config.

    Returns
    -------
    Outcome
        Arrays `law` (LAW_ARRAYS: levels in m, series of force in N and of slope in N/m, table of each
        flank). Table `levels`: mean force and slope at each level by gear and flank, see
        `MeshLawResult.table`.

    Raises
    ------
    NotConverged
        Naming position and torque.
    FacegearError
        Where teeth interfere.
    """
    plan = contact_plan(contact)
    request = stiffness_request(mesh_stiffness)
    design = pair(tooth_pair).design
    flanks = list(zip(*map(every_flank_from_arrays, (pinion, face_gear)), strict=True))
    models, numbers = flank_models(design, flanks)
    scale = _scale(ltca, request)
    largest = plan.torques[-1] / scale
    contacts = [flank_contacts(model, plan.positions, largest, plan.options) for model in models]
    tables, errors = fitted_tables(contacts, request.order)
    tables = [table.scale(scale) for table in tables]
    levels = level_table(tables, errors, numbers, design.normal_arm)
    rms, largest = (100.0 * max(getattr(error, name) for error in errors) for name in ("rms", "largest"))
    summary = (
        f"{count_noun(tables[0].levels.size - 1, 'level')} up to {1e6 * tables[0].levels[-1]:.3g} um, "
        f"{tables[0].forces.shape[2] - 1} orders, times {scale:.4f}; against contact between the levels "
        f"{rms:.2g} % rms, {largest:.2g} % at most of the largest mean force"
    )
    return Outcome({"law": law_arrays(tables, numbers), "levels": levels}, summary)


def flank_contacts(
    model: ContactModel, positions: int, largest: float, options: ContactOptions = DEFAULT
) -> FlankContacts:
    """Solve the contact of a flank over a pitch at the t torques that a law up to the largest torque
    needs.

    Parameters
    ----------
    model : ContactModel
        Contact model of the flank.
    positions : int
        Number p of even positions of a pitch.
    largest : float
        Largest torque of the law, N m.
    options : ContactOptions
        Options of the contact solver.

    Returns
    -------
    FlankContacts
        Forces along the line of action (t,), N; approach beyond first contact (t, p), m; local
        stiffness (t, p), N/m.

    Raises
    ------
    NotConverged
        Naming position and torque.
    FacegearError
        Where teeth interfere.
    """
    torques = law_torques(largest)
    contacts = loaded_contact(model, even_positions(positions), torques, options)
    if any(np.isnan(contact.k_average) for contact in contacts):
        raise FacegearError("mesh law: there is none, as the teeth interfere")

    def by_torque(values: list[float]) -> np.ndarray:
        """Arrange values that come position by position as an array (torques, positions)."""
        return np.array(values).reshape(positions, len(torques)).T

    def approach(contact: LoadedPosition) -> float:
        """Return how far a loaded position has closed beyond first contact, m: loaded less unloaded
        transmission error.
        """
        return contact.ste - contact.unloaded_error

    return FlankContacts(
        np.array(torques) / model.design.normal_arm,
        by_torque([approach(contact) for contact in contacts]),
        by_torque([contact.k_local for contact in contacts]),
    )


def _scale(ltca: pd.DataFrame, request: StiffnessRequest) -> float:
    """Return the factor on forces and slopes of the law: 1, but with source fem_scaled the given mean
    stiffness over the computed.

    The computed one is the mean over a pitch at the torque and by the definition of the request, as in
    stage stiffness.
    """
    if request.source != "fem_scaled":
        return 1.0
    assert request.mean is not None
    assert request.torque is not None
    return request.mean / float(load_table(ltca).at(request.torque, request.definition).mean())
