"""Early findings about a run, from geometry and from statics with an estimated mesh stiffness.

No contact analysis is made, so that all of it takes about a second.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from facegear.build.lower_gear import other_lower_gear
from facegear.build.lumped_model import machine
from facegear.build.machine_layout import lumped_sections
from facegear.build.strength import rating_request
from facegear.build.tooth_pair import ToothPair, pair_design
from facegear.errors import FacegearError
from facegear.harmonics import Harmonics
from facegear.machine.ratings import mesh_table
from facegear.schema.plausibility import MESH_STIFFNESS, USUAL_FACE_MODULES
from facegear.schema.strength import Strength
from facegear.strength.cylindrical import hertz_stress, pinion_notch, unknown_to_standard
from facegear.teeth.analysis import (
    PairAnalysis,
    analyse,
    jam,
    jam_in_words,
    summary_in_words,
    transverse_contact_ratio,
)
from facegear.teeth.design import PairDesign
from facegear.teeth.pitch_line import path_middles, pitch_line_radius
from facegear.teeth.placement import FLANKS, GEARS, pair_at

POSITIONS = 16
"""Positions of a pitch that are looked at; the smallest gap is refined between them."""
LIGHTEST = 0.05
"""Part of the largest mesh load below which the torques of the contact analysis need not reach down."""
NOTCHES = (1.0, 8.0)
"""Range of q_s in which ISO 6336-3 gives the stress correction."""
ROUNDING = 1e-6
"""Relative difference of torques that is rounding, or that of an estimated stiffness."""


@dataclass(frozen=True)
class EarlyFindings:
    """Lines about a case.

    Attributes
    ----------
    failures
        What would end a stage of the run.
    remarks
        What the run would warn of.
    facts
        Key numbers of the geometry.
    """

    failures: tuple[str, ...]
    remarks: tuple[str, ...]
    facts: tuple[str, ...]


def pair_findings(values: Mapping[str, Any]) -> EarlyFindings:
    """Find what geometry alone says of a pair: jamming, interference, contact ratio, path of contact,
    fillets.

    Interference is a failure where the stiffness comes from contact, else a remark. A failure is also a
    pair that the rating refuses.

    Parameters
    ----------
    values : mapping
        Plain values of a validated config, as `facegear.build.config.resolved_values` returns them.

    Returns
    -------
    EarlyFindings
        Failures, remarks, and one line of facts; no lines for a pair without bodies.
    """
    if values["tooth_pair"]["pinion"] is None:
        return EarlyFindings((), (), ())
    design = pair_design(ToothPair.of_config(values["tooth_pair"]))
    from_contact = values["mesh_stiffness"]["source"] != "harmonics"
    geometry = _meshing_findings(design, from_contact)
    machine_values = values["transmission"]
    has_lower_gear = machine_values is not None and "lower" in machine_values["face_gears"]
    lower = other_lower_gear(design) if has_lower_gear else None
    if lower is not None:
        of_lower = _meshing_findings(lower, from_contact)
        failures, remarks, facts = (
            tuple(f"lower gear: {line}" for line in lines)
            for lines in (of_lower.failures, of_lower.remarks, of_lower.facts)
        )
        geometry = EarlyFindings(
            geometry.failures + failures, geometry.remarks + remarks, geometry.facts + facts
        )
    if not geometry.facts:
        return geometry
    unrated, beyond = _rating(values, design)
    return replace(geometry, failures=(*geometry.failures, *unrated), remarks=(*geometry.remarks, *beyond))


def _meshing_findings(design: PairDesign, from_contact: bool) -> EarlyFindings:
    """Return what geometry alone says of the teeth of one face gear; no facts where it cannot be computed.

    `from_contact` says whether the mesh stiffness comes from contact.
    """
    try:
        analysis = analyse(design, POSITIONS)
        stuck = jam(design, analysis)
    except FacegearError as error:
        return EarlyFindings((f"tooth_pair: {error}",), (), ())
    failures: list[str] = []
    remarks: list[str] = []
    if stuck is not None:
        failures.append(jam_in_words(analysis, stuck))
    elif analysis.interference is not None:
        lines = failures if from_contact else remarks
        lines.append(_interference(analysis, from_contact))
    if analysis.contact_ratio < 1.0:
        remarks.append(
            f"tooth_pair: contact ratio {analysis.contact_ratio:.3f}, below 1: tooth pairs do not overlap, "
            "and flanks touch with their edges"
        )
    gear, family = design.face_gear, design.family
    # of spur teeth both flanks have the same path
    for path in dict.fromkeys(pitch_line_radius(family, path_middles(family)).tolist()):
        if not gear.inner_radius <= path <= gear.outer_radius:
            remarks.append(
                f"tooth_pair: the path of contact, at gear radius {1e3 * path:.1f} mm, lies beside the face "
                f"of {1e3 * gear.inner_radius:g} to {1e3 * gear.outer_radius:g} mm: flanks touch at its end"
            )
    return EarlyFindings(tuple(failures), tuple(remarks), (f"geometry: {summary_in_words(analysis)}",))


def machine_findings(values: Mapping[str, Any]) -> EarlyFindings:
    """Find meshes without load at rest, and mesh torques outside those of the contact analysis.

    Statics take a constant mesh stiffness, given or estimated, and no transmission error.

    Parameters
    ----------
    values : mapping
        Plain values of a validated config, as `facegear.build.config.resolved_values` returns them.

    Returns
    -------
    EarlyFindings
        Remarks only; no lines for a config without a machine.
    """
    if values["transmission"] is None:
        return EarlyFindings((), (), ())
    section, teeth = lumped_sections(values["transmission"], values["tooth_pair"])
    stiffness = Harmonics(np.zeros(1), np.array([_stiffness(values)]))
    no_error = Harmonics(np.zeros(1), np.zeros(1))
    try:
        meshes = mesh_table(machine(section, teeth, stiffness, no_error), values["dynamics"]["speed_rpm"])
    except FacegearError as error:
        return EarlyFindings((), (f"the machine at rest, with an estimated mesh stiffness: {error}",), ())
    remarks = []
    open_ones = meshes.loc[meshes["flank"] == "open", "mesh"]
    if len(open_ones):
        remarks.append(f"no load at rest: {', '.join(open_ones)}")
    if values["mesh_stiffness"]["source"] != "harmonics":
        loads = meshes.set_index("mesh")["pinion_torque_n_m"].abs()
        remarks += _unsolved(values, dict(loads[loads > 0.0]))
    return EarlyFindings((), tuple(remarks), ())


def _interference(analysis: PairAnalysis, from_contact: bool) -> str:
    """Return one line that says where the teeth interfere, how deep, and what then cannot be computed.

    `from_contact` says whether the mesh stiffness comes from contact.
    """
    gap = analysis.interference
    assert gap is not None
    consequence = (
        "no mesh stiffness can be computed" if from_contact else "the given mesh stiffness leaves it out"
    )
    return (
        f"tooth_pair: the teeth interfere: at gear radius {1e3 * gap.radius:.1f} mm the gear's "
        f"{gap.gear_part} stands {-1e6 * gap.gap:.1f} um deep in the pinion's {gap.pinion_part}; "
        f"{consequence}"
    )


def _rating(values: Mapping[str, Any], design: PairDesign) -> tuple[list[str], list[str]]:
    """Return failures and remarks about the rating of a pair, as two lists of lines.

    A failure is the error by which the rating would end. Remarks tell of a notch parameter q_s of the
    pinion's fillet outside NOTCHES, the range of ISO 6336-3, below either flank, and of teeth that the
    standard does not know. Both are empty without the teeth's part of section `strength`.
    """
    section = values["strength"]
    if section is None or section["pinion"] is None:
        return [], []
    missing_kinds, remarks = unknown_to_standard(design), []
    try:
        notches = [pinion_notch(pair_at(design, GEARS[0], flank)) for flank in FLANKS]
        if not missing_kinds:
            request = rating_request(Strength.of_config(section), design)
            hertz_stress(design, transverse_contact_ratio(design), request)
    except FacegearError as error:
        text = str(error)
        return [text if text.startswith("strength") else f"strength: {text}"], []
    low, high = NOTCHES
    remarks += [
        f"strength: notch parameter q_s = {notch:.3g} of the pinion's fillet, outside the {low:g} to "
        f"{high:g} of ISO 6336-3; tooth_pair.pinion.rack_tip_radius_modules rounds it"
        for notch in dict.fromkeys(notches)
        if not low <= notch < high
    ]
    if missing_kinds:
        remarks.append(f"strength: rated by contact alone, as ISO 6336 does not know {missing_kinds}")
    return [], remarks


def _stiffness(values: Mapping[str, Any]) -> float:
    """Return the mean mesh stiffness, N/m: as given, else that of a steel mesh of this face width.

    Without bodies the face is taken as USUAL_FACE_MODULES modules wide.
    """
    mean = values["mesh_stiffness"]["mean_n_per_m"]
    if mean is not None:
        return float(mean)
    gear, module = values["tooth_pair"]["face_gear"], values["tooth_pair"]["module_mm"]
    face = USUAL_FACE_MODULES * module if gear is None else gear["outer_radius_mm"] - gear["inner_radius_mm"]
    return MESH_STIFFNESS * 1e-3 * float(face)


def _unsolved(values: Mapping[str, Any], loads: Mapping[str, float]) -> Iterator[str]:
    """Yield remarks on meshes whose torque at rest lies outside the torques of the contact analysis.

    `loads` has the size of the torque on the pinion by mesh name, N m. One line is for the most loaded
    mesh above the range. One, with a load-dependent law, is for the least loaded below it, of those above
    LIGHTEST.
    """
    if not loads:
        return
    low, high = values["contact"]["torques_n_m"][0], values["contact"]["torques_n_m"][-1]
    heaviest = max(loads, key=lambda mesh: loads[mesh])
    if loads[heaviest] > high * (1.0 + ROUNDING):
        yield (
            f"contact.torques_n_m ends at {high:g}: {heaviest} carries about {loads[heaviest]:.3g} N m "
            "at rest, so that its numbers are extrapolated"
        )
    if values["mesh_stiffness"]["mesh_law"] != "load_dependent":
        return
    light = [mesh for mesh, load in loads.items() if LIGHTEST * loads[heaviest] < load < low]
    if light:
        lightest = min(light, key=lambda mesh: loads[mesh])
        yield (
            f"contact.torques_n_m begins at {low:g}: {lightest} carries about {loads[lightest]:.3g} N m "
            "at rest"
        )
