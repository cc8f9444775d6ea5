"""Stages of face gears that bend: their bodies, and the waves of the turning machine."""

from collections.abc import Hashable, Mapping
from typing import Any

import numpy as np
import pandas as pd

from facegear.build.elastic_bodies import body_key, contact_patch, elastic_gears, fitted_shape
from facegear.build.lumped_model import given_torques
from facegear.build.machine_layout import layout
from facegear.build.tooth_numbers import ToothNumbers
from facegear.build.tooth_pair import ToothPair
from facegear.errors import ConfigError
from facegear.machine.elastic_coordinates import gear_forces
from facegear.machine.layout import Layout, Side
from facegear.machine.machine import Machine
from facegear.machine.static_gears import at_rest
from facegear.machine.statics import mean_equilibrium
from facegear.machine.turning_modes import (
    GROWS,
    campbell_crossings,
    campbell_table,
    machine_at_speeds,
    wave_table,
)
from facegear.number_format import count_noun
from facegear.parts import body_tables
from facegear.parts.gear_body import SolvedBody, reduced_body, solve_body
from facegear.parts.reduced_body import ReducedBody
from facegear.pipeline.outcome import Outcome
from facegear.schema.gear_body import BodySection
from facegear.schema.transmission import Transmission


def gear_bodies(
    transmission: Transmission, tooth_pair: ToothPair, speed_rpm: float, last_rpm: float
) -> Outcome:
    """Solve the finite element section of every face gear that bends: modes and compliance with its hub
    fixed.

    Parameters
    ----------
    transmission : Transmission
        Section `transmission` of the config.
    tooth_pair : ToothPair
        Section `tooth_pair` of the config.
    speed_rpm : float
        Nominal speed of the pinions, rpm.
    last_rpm : float
        Largest pinion speed up to which crossings of modes and mesh harmonics are listed, rpm.

    Returns
    -------
    Outcome
        Tables `bodies`, `modes`, `crossings`, `compliance` and `influence`, described by
        `GearBodiesResult`. Arrays `reduced`: modal matrices from which the machine is built; arrays
        `shapes`: nodes and mode shapes for pictures.

    Raises
    ------
    ConfigError
        Where all face gears are rigid.
    NotConverged
        Where the modes do not converge.
    """
    sections = elastic_gears(transmission)
    if not sections:
        raise ConfigError("transmission.face_gear.body", None, "given: all face gears are rigid")
    machine = layout(transmission, ToothNumbers.of_config(tooth_pair.model_dump()))
    bodies = _solve_bodies(sections, tooth_pair)
    parts = [
        _parts(gear, bodies[gear], sections[gear], tooth_pair, machine, (speed_rpm, last_rpm))
        for gear in sections
    ]
    names = ("bodies", "modes", "crossings", "compliance", "influence")
    content: dict[str, Any] = {
        name: pd.concat([part[name] for part in parts], ignore_index=True) for name in names
    }
    shapes = [item for gear in sections for item in body_tables.shape_arrays(gear, bodies[gear]).items()]
    reduced_arrays = [
        item
        for gear, section in sections.items()
        for item in _reduce_body(gear, bodies[gear], section, tooth_pair).arrays(gear).items()
    ]
    content |= {"reduced": dict(reduced_arrays), "shapes": dict(shapes)}
    gives = _gives_way(content["bodies"], transmission, machine)
    summary = _summary(content["bodies"], content["modes"]) + _fitted_layers(sections, bodies) + gives
    return Outcome(content, summary)


def _fitted_layers(sections: Mapping[str, BodySection], bodies: Mapping[str, SolvedBody]) -> str:
    """Describe the tooth layers whose stiffness was fitted: density and stiffness as fractions of the
    solid ring's.
    """
    parts = []
    for gear, section in sections.items():
        if section.teeth == "fitted" and (layer := bodies[gear].section.layer) is not None:
            fractions = f"{layer.density:.4f} of the ring, {layer.hoop:.4f} of E and {layer.shear:.4f} of G"
            parts.append(f"; {gear}: teeth fitted, {fractions} round the axis")
    return "".join(parts)


def _gives_way(bodies: pd.DataFrame, transmission: Transmission, machine: Layout) -> str:
    """Return a warning where a body deflects at a mesh by more than the backlash, otherwise an empty
    text.

    Contacts then open or close that the config did not intend. Deflection is the body's compliance at a
    mesh times a force: the largest pinion torque over the pinion's lever arm, shared evenly by its
    meshes.
    """
    torque = float(np.abs(given_torques(transmission, machine)).max())
    force = torque / machine.pinion_arm / len(machine.gears)
    gives = 1e6 * force * float(bodies["own_compliance_m_per_n"].max())
    backlash = transmission.backlash_um
    if backlash is None or gives <= backlash:
        return ""
    return f"; at {force:.4g} N a mesh gives {gives:.4g} um, more than its backlash of {backlash:.4g} um"


def _reduce_body(gear: str, body: SolvedBody, section: BodySection, tooth_pair: ToothPair) -> ReducedBody:
    """Reduce a solved body to the matrices of its modes, with the patch on which teeth press and with
    its damping.
    """
    return reduced_body(body, contact_patch(section, tooth_pair, gear), *section.damping)


def _solve_bodies(sections: Mapping[str, BodySection], tooth_pair: ToothPair) -> dict[str, SolvedBody]:
    """Solve the finite element body of every gear, by gear name; gears with equal sections and equal teeth
    share one solution.
    """
    body_keys = {gear: body_key(section, tooth_pair, gear) for gear, section in sections.items()}
    bodies: dict[Hashable, SolvedBody] = {}
    for gear, section in sections.items():
        if body_keys[gear] not in bodies:
            bodies[body_keys[gear]] = solve_body(
                fitted_shape(section, tooth_pair, gear),
                section.max_frequency_hz,
                section.nodal_diameters,
                tooth_pair.face_gear_teeth,
            )
    return {gear: bodies[body_keys[gear]] for gear in sections}


def _parts(
    gear: str,
    body: SolvedBody,
    section: BodySection,
    tooth_pair: ToothPair,
    machine: Layout,
    speeds_rpm: tuple[float, float],
) -> dict[str, pd.DataFrame]:
    """Return the five tables of one gear (bodies, modes, crossings, compliance, influence) by name.

    `speeds_rpm` holds the pinion speed at which the waves of modes are given, and the last one for
    crossings with mesh harmonics.
    """
    patch = contact_patch(section, tooth_pair, gear)
    ratio = tooth_pair.face_gear_teeth / tooth_pair.pinion_teeth
    speed = speeds_rpm[0] / ratio / body_tables.RPM
    number = [member.side for member in machine.gears].index(Side(gear))
    forces = gear_forces(machine, number)
    angles = dict(zip((pinion.name for pinion in machine.pinions), machine.angles.tolist(), strict=True))
    return {
        "bodies": body_tables.body_table(gear, body, patch, forces, machine.angles),
        "modes": body_tables.mode_table(
            gear, body, speed, tooth_pair.face_gear_teeth, ratio, section.damping
        ),
        "crossings": body_tables.crossing_table(
            gear, body, tooth_pair.face_gear_teeth, ratio, speeds_rpm[1], machine.angles
        ),
        "compliance": body_tables.compliance_table(gear, body, patch),
        "influence": body_tables.influence_table(gear, body, patch, forces, angles),
    }


def _summary(bodies: pd.DataFrame, modes: pd.DataFrame) -> str:
    """Say in one line mass, lowest frequency and compliance at a mesh of each gear."""
    parts = []
    for row in bodies.itertuples():
        gear_modes = modes[modes["gear"] == row.gear]
        first = f"from {gear_modes['frequency_hz'].min():.1f} Hz" if len(gear_modes) else "none"
        parts.append(
            f"{row.gear}: {row.mass_kg:.4g} kg, {count_noun(len(gear_modes), 'mode')} {first} "
            f"(+-{100 * row.frequency_change:.2g} %), {1e9 * row.own_compliance_m_per_n:.4g} nm/N at a mesh, "
            f"of which the modes hold {100 * row.modal_fraction:.1f} %"
        )
    return "; ".join(parts)


SPEEDS = 21
"""Speeds of the Campbell diagram from rest to the last one of the sweep, beside the nominal one."""


def gear_waves(
    machine: Machine,
    speed_rpm: float,
    last_rpm: float,
) -> Outcome:
    """Compute damped modes of the machine, linear about its static load, while face gears that bend
    turn.

    Meshes have their mean stiffness. Modes are tabulated at the nominal speed; the Campbell diagram
    goes from rest to `last_rpm` in SPEEDS even steps, with the nominal speed beside.

    Parameters
    ----------
    machine : Machine
        The machine with at least one face gear that bends.
    speed_rpm : float
        Nominal speed of the pinions, rpm.
    last_rpm : float
        Last pinion speed of the Campbell diagram, rpm.

    Returns
    -------
    Outcome
        Tables `waves` (a row a mode, gear and nodal diameters), `campbell` (a row a speed and mode) and
        `campbell_crossings` (with mesh harmonics), described by `GearWavesResult`.

    Raises
    ------
    ConfigError
        Where all face gears are rigid.
    NotConverged
        Where the static load does not converge.
    """
    if machine.bodies is None:
        raise ConfigError("transmission.face_gear.body", None, "given: all face gears are rigid")
    speeds = sorted({*np.linspace(0.0, last_rpm, SPEEDS).tolist(), float(speed_rpm)})
    all_modes = machine_at_speeds(machine, speeds)
    modes = all_modes[speeds.index(float(speed_rpm))]
    growing = modes.frequencies[modes.damping_ratios < -GROWS]
    summary = f"{count_noun(modes.frequencies.size, 'mode')} at {speed_rpm:g} rpm"
    if growing.size:
        frequencies = ", ".join(f"{frequency:.1f}" for frequency in growing)
        summary = f"{summary}; the damping that turns with the gears makes those grow at {frequencies} Hz"
    summary += _left_out(machine)
    layout, linear = machine.layout, machine.linear
    campbell = campbell_table(layout, linear, speeds, all_modes)
    tables = {
        "waves": wave_table(layout, linear, modes),
        "campbell": campbell,
        "campbell_crossings": campbell_crossings(
            campbell, (layout.pinion_teeth, layout.gear_teeth), layout.angles
        ),
    }
    return Outcome(tables, summary)


def _left_out(machine: Machine) -> str:
    """Say how far mesh forces at rest (N) change if the compliance between meshes that motion neglects
    is counted.
    """
    reduced_forces, full_forces = (
        mean_equilibrium(variant).forces[0] for variant in (machine, at_rest(machine))
    )
    off, largest = float(np.abs(reduced_forces - full_forces).max()), float(np.abs(full_forces).max())
    return (
        f"; the compliance between meshes that they leave out moves mesh forces at rest by up to {off:.3g} N "
        f"of {largest:.5g} N"
    )
