"""Face gears that bend: their modes and their compliance below the teeth, with their hubs held."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from facegear.config.elastic_bodies import contact_patch, elastic_gears, fitted_shape
from facegear.config.gear_body import BodySection
from facegear.config.lumped_model import given_torques
from facegear.config.machine_layout import ToothNumbers, layout
from facegear.config.tooth_pair import ToothPair
from facegear.config.transmission import Transmission
from facegear.errors import ConfigError
from facegear.gear_body import tables
from facegear.gear_body.body import SolvedBody, solve_body
from facegear.gear_body.reduced_body import ReducedBody
from facegear.gear_body.reduction import reduced_body
from facegear.number_format import count_noun
from facegear.stages.outcome import Outcome
from facegear.transmission.layout import Layout


def gear_bodies(
    transmission: Transmission, tooth_pair: ToothPair, speed_rpm: float, last_rpm: float
) -> Outcome:
    """`bodies`, `modes`, `crossings`, `compliance`, `influence` (tables), `reduced` and `shapes` (arrays) of
    the gears that bend.

    Raises ConfigError where all face gears are rigid, NotConverged.
    """
    sections = elastic_gears(transmission)
    if not sections:
        raise ConfigError("transmission.face_gear.body", None, "given: all face gears are rigid")
    machine = layout(transmission, ToothNumbers.of_config(tooth_pair.model_dump()))
    solved = _solved(sections, tooth_pair)
    parts = [
        _parts(gear, solved[gear], sections[gear], tooth_pair, machine, (speed_rpm, last_rpm))
        for gear in sections
    ]
    names = ("bodies", "modes", "crossings", "compliance", "influence")
    content: dict[str, Any] = {
        name: pd.concat([part[name] for part in parts], ignore_index=True) for name in names
    }
    shapes = [item for gear in sections for item in tables.shape_arrays(gear, solved[gear]).items()]
    reduced = [
        item
        for gear, section in sections.items()
        for item in _reduced(solved[gear], section, tooth_pair).arrays(gear).items()
    ]
    content |= {"reduced": dict(reduced), "shapes": dict(shapes)}
    gives = _gives_way(content["bodies"], transmission, machine)
    said = _summary(content["bodies"], content["modes"]) + _fitted(sections, solved) + gives
    return Outcome(content, said)


def _fitted(sections: Mapping[str, BodySection], solved: Mapping[str, SolvedBody]) -> str:
    """Layers of teeth that were fitted."""
    parts = []
    for gear, section in sections.items():
        if section.teeth == "fitted" and (layer := solved[gear].section.layer) is not None:
            fractions = f"{layer.density:.4f} of the ring, {layer.hoop:.4f} of E and {layer.shear:.4f} of G"
            parts.append(f"; {gear}: teeth fitted, {fractions} round the axis")
    return "".join(parts)


def _gives_way(bodies: pd.DataFrame, transmission: Transmission, machine: Layout) -> str:
    """What a reader should know where a body gives more than the backlash takes up: contacts that the config
    did not mean then open or close.

    The load is that of the pinion with the largest torque, shared evenly by its meshes.
    """
    torque = float(np.abs(given_torques(transmission, machine)).max())
    force = torque / machine.pinion_arm / len(machine.gears)
    gives = 1e6 * force * float(bodies["own_compliance_m_per_n"].max())
    backlash = transmission.backlash_um
    if backlash is None or gives <= backlash:
        return ""
    return f"; at {force:.4g} N a mesh gives {gives:.4g} um, more than its backlash of {backlash:.4g} um"


def _reduced(body: SolvedBody, section: BodySection, tooth_pair: ToothPair) -> ReducedBody:
    return reduced_body(body, contact_patch(section, tooth_pair), *section.damping)


def _solved(sections: Mapping[str, BodySection], tooth_pair: ToothPair) -> dict[str, SolvedBody]:
    """Every gear's body; those that are alike are solved once."""
    done: dict[BodySection, SolvedBody] = {}
    for section in sections.values():
        if section not in done:
            done[section] = solve_body(
                fitted_shape(section, tooth_pair),
                section.max_frequency_hz,
                section.nodal_diameters,
                tooth_pair.face_gear_teeth,
            )
    return {gear: done[section] for gear, section in sections.items()}


def _parts(
    gear: str,
    body: SolvedBody,
    section: BodySection,
    tooth_pair: ToothPair,
    machine: Layout,
    speeds_rpm: tuple[float, float],
) -> dict[str, pd.DataFrame]:
    """Tables of one gear at a pinion speed, and up to the last one."""
    patch = contact_patch(section, tooth_pair)
    ratio = tooth_pair.face_gear_teeth / tooth_pair.pinion_teeth
    speed = speeds_rpm[0] / ratio / tables.RPM
    sign = next(member.sign for member in machine.gears if member.side == gear)
    angles = dict(zip((pinion.name for pinion in machine.pinions), machine.angles.tolist(), strict=True))
    angle = machine.pressure_angle
    return {
        "bodies": tables.body_table(gear, body, patch, angle, machine.angles),
        "modes": tables.mode_table(gear, body, speed, tooth_pair.face_gear_teeth, ratio, section.damping),
        "crossings": tables.crossing_table(
            gear, body, tooth_pair.face_gear_teeth, ratio, speeds_rpm[1], machine.angles
        ),
        "compliance": tables.compliance_table(gear, body, patch),
        "influence": tables.influence_table(gear, body, patch, angle, sign, angles),
    }


def _summary(bodies: pd.DataFrame, modes: pd.DataFrame) -> str:
    parts = []
    for row in bodies.itertuples():
        own = modes[modes["gear"] == row.gear]
        first = f"from {own['frequency_hz'].min():.1f} Hz" if len(own) else "none"
        parts.append(
            f"{row.gear}: {row.mass_kg:.4g} kg, {count_noun(len(own), 'mode')} {first} "
            f"(+-{100 * row.frequency_change:.2g} %), {1e9 * row.own_compliance_m_per_n:.4g} nm/N at a mesh, "
            f"of which the modes hold {100 * row.modal_fraction:.1f} %"
        )
    return "; ".join(parts)
