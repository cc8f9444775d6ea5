"""The public designs of the family of teeth as sections `tooth_pair` of a config."""

from typing import Any

from public_teeth import PARAMETERS


def public_section(name: str) -> dict[str, Any]:
    """Return the plain values of section `tooth_pair` of a public design."""
    module, teeth, angles, helix, taper, shaft, offset, middle, width, radii, addendum, rounding = PARAMETERS[
        name
    ]
    drive, coast = angles
    return {
        "pinion_teeth": teeth[0],
        "face_gear_teeth": teeth[1],
        "module_mm": module,
        "pressure_angle_deg": drive if drive == coast else {"drive": drive, "coast": coast},
        "helix_angle_deg": helix,
        "taper_angle_deg": taper,
        "shaft_angle_deg": shaft,
        "offset_mm": offset,
        "pinion": {"width_mm": width, "bore_radius_mm": 20, "thinning_um": 100, "middle_mm": middle},
        "face_gear": {
            "inner_radius_mm": radii[0],
            "outer_radius_mm": radii[1],
            "rim_thickness_mm": 12,
            "addendum_modules": addendum / module,
        },
        "shaper": {"teeth": teeth[2], "tip_rounding_modules": rounding / module},
    }
