"""Values of spur teeth at ninety degrees: points, normals, limits, paths and fillets of the shipped configs.

`python tests/helpers/spur_values.py` wrote `tests/unit/teeth/spur.npz` while spur teeth had formulas of their
own, at the commit that added the file; they are a limit of the family since.
Each array's name is that of the config, a stroke and the quantity.
"""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np

from facegear.build.load import load_config
from facegear.build.tooth_pair import pair_design
from facegear.teeth import face_gear, face_gear_fillet, pinion
from facegear.teeth.conjugate import PairNumbers, conjugate_slopes, contact_at
from facegear.teeth.curvature import relative_curvatures
from facegear.teeth.design import AssemblyErrors, PairDesign, as_cut
from facegear.teeth.limits import radius_limits, tip_plane_radius

ROOT = Path(__file__).parents[2]
STORED = ROOT / "tests" / "unit" / "teeth" / "spur.npz"
ERRORS = (
    AssemblyErrors(),
    AssemblyErrors(offset=120e-6, gear_axial=-40e-6),
    AssemblyErrors(offset=-80e-6, shaft_angle_error=5e-4, gear_axial=30e-6),
)


@cache
def shipped_designs() -> dict[str, PairDesign]:
    """Return the different designs of the shipped configs, without modifications, by the config's name."""
    designs: dict[str, PairDesign] = {}
    for path in sorted((ROOT / "config").glob("*.yaml")):
        section = load_config(path).tooth_pair
        if section is None or section.pinion is None:
            continue
        design = as_cut(pair_design(section))
        if design.is_spur and design not in designs.values():
            designs[path.stem] = design
    rounded = next(design for design in designs.values() if design.shaper.tip_rounding > 0.0)
    designs["sharp"] = replace(rounded, shaper=replace(rounded.shaper, tip_rounding=0.0))
    shifted = replace(rounded.pinion, profile_shift=0.2 * rounded.module, thinning=1e-4)
    designs["shifted"] = replace(rounded, pinion=shifted)
    return designs


def spur_values(design: PairDesign) -> dict[str, np.ndarray]:
    """Return values of a design, in m and rad."""
    gear, values = design.face_gear, {}
    radius = np.linspace(gear.inner_radius, gear.outer_radius, 5)[:, None]
    last = design.shaper_tip_roll
    deepest = face_gear.flank_point(design, last, face_gear.psi_at(design, radius, last))[..., 2]
    tip = face_gear.tip_height(design, radius)
    height = tip + np.linspace(0.0, 0.9, 4) * (deepest - tip)
    roll, psi = face_gear.roll_and_psi_at_height(design, radius, height)
    values["flank"] = np.stack([roll, psi])
    values["flank points"] = face_gear.flank_point(design, roll, psi)
    values["flank normals"] = face_gear.flank_normal(design, roll, psi)
    values["flank tangents"] = np.stack(face_gear.flank_tangents(design, roll, psi))
    values["flank end"] = face_gear.psi_at(design, radius[:, 0], last)
    values["tip edge"] = face_gear.tip_edge(design, radius[:, 0])
    slopes = face_gear_fillet.fillet_slopes(design, radius, np.linspace(0.0, 1.0, 5))
    values["fillet"] = np.stack(face_gear_fillet.fillet_section(design, radius, slopes))
    values["fillet normals"] = face_gear_fillet.fillet_normal(design, radius, slopes)
    values["fillet slopes"] = slopes
    radii = radius[0, 0]
    values["root"] = np.array(
        [face_gear_fillet.root_half_angle(design, radii), face_gear_fillet.root_height(design, radii)]
    )
    limits = radius_limits(design)
    values["limits"] = np.array([limits.inner, limits.outer, limits.outer_planar, tip_plane_radius(design)])
    y = design.middle
    start = float(pinion.junction_roll(design, y))
    rolls = np.linspace(max(start, 0.0), design.pinion_tip_roll, 5)
    values["involute"] = np.stack(pinion.involute_point(design, rolls, y))
    values["involute normals"] = pinion.involute_normal(design, rolls, y)[:, [0, 2]].T
    gamma = np.linspace(design.pressure_angle, np.pi / 2, 5)
    values["trochoid"] = np.stack(pinion.trochoid_point(design, gamma, y))
    values["trochoid normals"] = pinion.trochoid_normal(design, gamma, y)[:, [0, 2]].T
    values["pinion"] = np.array([start, pinion.tip_half_angle(design, y), pinion.root_half_angle(design)])
    curvatures = relative_curvatures(design, np.linspace(0.3, 0.6, 4), design.pressure_angle)
    values["curvatures"] = np.stack(curvatures)
    numbers = PairNumbers.of_design(design)
    for case, errors in enumerate(ERRORS):
        contact = contact_at(numbers, errors)
        if contact is None:
            continue
        path = contact.psi, contact.turn, contact.transmission_error, contact.y, contact.normal_roll
        values[f"path {case}"] = np.array(path)
        slopes = conjugate_slopes(numbers, errors, contact)
        values[f"path slopes {case}"] = np.stack([slopes.transmission_error, slopes.path])
    return values


def all_spur_values() -> dict[str, np.ndarray]:
    """Return the values of all designs, by name."""
    return {
        f"{name}/{quantity}": value
        for name, design in shipped_designs().items()
        for quantity, value in spur_values(design).items()
    }


if __name__ == "__main__":
    np.savez_compressed(STORED, **all_spur_values())
