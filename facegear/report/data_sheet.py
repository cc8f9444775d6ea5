"""Data of both gears as on a drawing, and numbers of the machine at rest."""

from collections.abc import Mapping, Sequence
from math import cos, degrees, hypot, pi, sin, tan
from typing import Any

import pandas as pd

from facegear.schema.tooth_pair import flank_angles_deg

DATA_SHEET = "Gear data, as on a drawing"
"""Caption of the data sheet."""
DECIMALS = 3
"""Decimals of lengths in mm: micrometres, as drawings give them."""

KINDS_IN_WORDS = (
    ("helix_angle_deg", "helix angle", "deg", 0.0),
    ("taper_angle_deg", "taper angle", "deg", 0.0),
    ("shaft_angle_deg", "shaft angle", "deg", 90.0),
    ("offset_mm", "offset", "mm", 0.0),
)
"""Keys of the pair that are told where they differ from spur teeth: words, unit, value of spur teeth."""


def data_sheet_table(pair: Mapping[str, Any]) -> pd.DataFrame:
    """List the data of pinion and face gear that a drawing states.

    Parameters
    ----------
    pair : mapping
        Record of the tooth geometry (`geometry/pair.json`): lengths in m below `design_si`, in mm below
        `radii_mm`.

    Returns
    -------
    DataFrame
        Columns quantity, pinion, face gear, unit, all text; blank where a gear has no such quantity.
    """
    if not has_spur_teeth(pair["design_si"]):
        return _table([*kind_rows(pair), *_common_rows(pair)])
    design, radii = pair["design_si"], pair["radii_mm"]
    pinion, gear, shaper = design["pinion"], design["face_gear"], design["shaper"]
    module = 1e3 * design["module"]
    shift = 1e3 * pinion["profile_shift"]
    axis = radii["pinion_pitch"] + shift
    span_teeth, span = pinion_span(pair)
    middle = _mm(0.5 * (radii["gear_inner"] + radii["gear_outer"]))
    path = radii["gear_contact_path_nominal"]
    rows = [
        ("Teeth", f"{pinion['teeth']}", f"{gear['teeth']}", ""),
        ("Module", _mm(module), _mm(module), "mm"),
        ("Pressure angle", *2 * (f"{degrees(design['pressure_angle']):.4g}",), "deg"),
        ("Profile shift coefficient", f"{shift / module + 0.0:.4f}", "", ""),
        ("Pitch diameter", _mm(2 * radii["pinion_pitch"]), _mm(2 * path), "mm"),
        ("Base diameter", _mm(2 * radii["pinion_base"]), _mm(2 * radii["gear_base"]), "mm"),
        ("Tip diameter", _mm(2 * radii["pinion_tip"]), "", "mm"),
        ("Root diameter", _mm(2 * radii["pinion_root"]), "", "mm"),
        ("Fillet begins at diameter", _mm(2 * radii["pinion_fillet_start"]), "", "mm"),
        (
            "Tooth thickness at the pitch diameter",
            _mm(pinion_tooth_thickness(pair)),
            _mm(pi * module / 2.0),
            "mm",
        ),
        (f"Span over {span_teeth} teeth", _mm(span), "", "mm"),
        *_face_rows(pair),
        ("Middle of the face from the gear's axis", middle, middle, "mm"),
        ("Pinion axis to pitch plane", "", _mm(axis), "mm"),
        ("Pinion axis to tip plane", "", _mm(axis - 1e3 * gear["addendum"]), "mm"),
        ("Pinion axis to root plane", "", _mm(axis + 1e3 * shaper["addendum"]), "mm"),
        *_common_rows(pair),
    ]
    return _table(rows)


def _table(rows: list[tuple[str, str, str, str]]) -> pd.DataFrame:
    """Return rows of quantity, pinion, face gear and unit as a table."""
    return pd.DataFrame(rows, columns=["quantity", "pinion", "face gear", "unit"])


def _face_rows(pair: Mapping[str, Any]) -> list[tuple[str, str, str, str]]:
    """Return the rows on the width and the ends of both faces."""
    radii, width = pair["radii_mm"], 1e3 * pair["design_si"]["pinion"]["width"]
    return [
        ("Face width", _mm(width), _mm(radii["gear_outer"] - radii["gear_inner"]), "mm"),
        ("Inner diameter of the face", "", _mm(2 * radii["gear_inner"]), "mm"),
        ("Outer diameter of the face", "", _mm(2 * radii["gear_outer"]), "mm"),
    ]


def _common_rows(pair: Mapping[str, Any]) -> list[tuple[str, str, str, str]]:
    """Return the last rows, which teeth of all kinds share: rim, tool, chamfer, bore, backlash."""
    design = pair["design_si"]
    pinion, gear, shaper = design["pinion"], design["face_gear"], design["shaper"]
    backlash = f"{pair['backlash_um']['smallest']:.1f}"
    return [
        ("Rim below the root", "", _mm(1e3 * gear["rim_thickness"]), "mm"),
        ("Teeth of the shaper", "", f"{shaper['teeth']}", ""),
        ("Tip rounding of the shaper", "", _mm(1e3 * shaper["tip_rounding"]), "mm"),
        ("Tip chamfer", _mm(1e3 * pinion["tip_chamfer"]), "", "mm"),
        ("Bore diameter", _mm(2e3 * pinion["bore_radius"]), "", "mm"),
        ("Backlash along the line of action, as assembled", backlash, backlash, "µm"),
    ]


def has_spur_teeth(design: Mapping[str, Any]) -> bool:
    """Whether a design has spur teeth alone, like on both flanks, at 90 degrees and without offset.

    Parameters
    ----------
    design : mapping
        Entry `design_si` of the record of the tooth geometry.

    Returns
    -------
    bool
        True if so.
    """
    angles = (design["helix_angle"], design["taper_angle"], design["offset"])
    coast = design["coast_pressure_angle"] in (None, design["pressure_angle"])
    return angles == (0.0, 0.0, 0.0) and design["shaft_angle"] == pi / 2 and coast


def kind_rows(pair: Mapping[str, Any]) -> list[tuple[str, str, str, str]]:
    """List the data of helical, tapered, offset or asymmetric teeth, up to the rim.

    Parameters
    ----------
    pair : mapping
        Record of the tooth geometry (`geometry/pair.json`).

    Returns
    -------
    list of tuple
        Texts quantity, pinion, face gear and unit. A quantity that both flanks have in common has one row,
        else each flank has one. Three numbers are those at the inner end, the middle and the outer end.
    """
    design, blanks, flanks = pair["design_si"], pair["blanks"], pair["flanks"]
    pinion, module, helix = design["pinion"], 1e3 * design["module"], degrees(design["helix_angle"])
    hand = f", {'right' if helix > 0 else 'left'} hand" if helix else ""
    shaft, offset = f"{degrees(design['shaft_angle']):.4g}", _mm(1e3 * design["offset"])
    pitch, gear_pitch = (_mm(2 * radius) for radius in blanks["pitch_radii_mm"])
    span = blanks["span"]
    span_rows = [(f"Span over {span[0]} teeth", _mm(span[1]), "", "mm")] if span else []
    return [
        ("Teeth", f"{pinion['teeth']}", f"{design['face_gear']['teeth']}", ""),
        ("Normal module", _mm(module), _mm(module), "mm"),
        ("Transverse module", *2 * (_mm(blanks["transverse_module_mm"]),), "mm"),
        (f"Helix angle{hand}", f"{abs(helix):.5g}", "", "deg"),
        ("Taper angle, positive outwards", f"{degrees(design['taper_angle']):.5g}", "", "deg"),
        ("Shaft angle", shaft, shaft, "deg"),
        ("Offset of the axes", offset, offset, "mm"),
        (
            "Profile shift coefficient in the middle",
            f"{1e3 * pinion['profile_shift'] / module + 0.0:.4f}",
            "",
            "",
        ),
        ("Pitch diameter", pitch, gear_pitch, "mm"),
        ("Tip diameter", _series(blanks["pinion_tip_radii_mm"], 2.0), "", "mm"),
        *_flank_rows(flanks, "Normal pressure angle", "pressure_angle_deg", "{:.5g}", "deg", on_gear=True),
        *_flank_rows(flanks, "Transverse pressure angle", "transverse_pressure_angle_deg", "{:.5g}", "deg"),
        *_flank_rows(flanks, "Base helix angle", "base_helix_deg", "{:.5g}", "deg"),
        *_flank_rows(flanks, "Base diameter", "base_radius_mm", f"{{:.{DECIMALS}f}}", "mm", 2.0),
        *_flank_rows(flanks, "Form diameter", "form_radii_mm", f"{{:.{DECIMALS}f}}", "mm", 2.0),
        ("Transverse tooth thickness at the pitch diameter", _mm(blanks["tooth_thickness_mm"]), "", "mm"),
        *span_rows,
        *_face_rows(pair),
        ("Middle of the face along the pinion's axis", _mm(blanks["middle_mm"]), "", "mm"),
        ("Half angle of the tip surface", "", f"{blanks['tip_cone_deg']:.5g}", "deg"),
        ("Tip below the common perpendicular", "", _series(blanks["tip_heights_mm"], -1.0), "mm"),
        ("Root below the common perpendicular", "", _series(blanks["root_heights_mm"], -1.0), "mm"),
        *_flank_rows(flanks, "Contact ratio", "contact_ratio", "{:.4f}", "", on_gear=True),
        *_flank_rows(
            flanks, "Sliding at first, middle and last contact", "sliding_mm_per_rad", "{:.4g}", "mm/rad"
        ),
        *_flank_rows(
            flanks, "Axial force for 1 N m, outwards", "axial_force_per_torque_per_m", "{:.4f}", "N"
        ),
        *_flank_rows(
            flanks, "Separating force for 1 N m", "separating_force_per_torque_per_m", "{:.4f}", "N"
        ),
        *_flank_rows(flanks, "Mesh phase by axial way", "phase_deg_per_mm", "{:.4f}", "deg/mm"),
        ("Backlash by axial way", f"{blanks['backlash_um_per_mm']:.3f}", "", "µm/mm"),
    ]


def _series(numbers: Sequence[float], factor: float = 1.0) -> str:
    """Return lengths (mm) times a factor as one text, or one length where all are equal."""
    texts = [_mm(factor * number) for number in numbers]
    return texts[0] if len(set(texts)) == 1 else " / ".join(texts)


def _flank_rows(
    flanks: Mapping[str, Mapping[str, Any]],
    quantity: str,
    key: str,
    style: str,
    unit: str,
    factor: float = 1.0,
    on_gear: bool = False,
) -> list[tuple[str, str, str, str]]:
    """Return the rows of a quantity of the pinion's flanks, or of both gears' (`on_gear`): one if drive and
    coast read the same, else one for each.
    """
    texts = {}
    for name in ("drive", "coast"):
        numbers = flanks[name].get(key)
        if numbers is None:
            texts[name] = "none"
            continue
        numbers = numbers if isinstance(numbers, list) else [numbers]
        parts = [style.format(factor * number + 0.0) for number in numbers]
        texts[name] = parts[0] if len(set(parts)) == 1 else " / ".join(parts)
    if texts["drive"] == texts["coast"]:
        return [(quantity, texts["drive"], texts["drive"] if on_gear else "", unit)]
    return [
        (f"{quantity}, {name} flank", text, text if on_gear else "", unit) for name, text in texts.items()
    ]


def pinion_tooth_thickness(pair: Mapping[str, Any]) -> float:
    """Compute the tooth thickness of the pinion on its pitch circle.

    Parameters
    ----------
    pair : mapping
        Record of the tooth geometry (`geometry/pair.json`), in m below `design_si`.

    Returns
    -------
    float
        Length of the arc, mm: m (pi / 2 + 2 x tan alpha) less thinning / cos alpha, as the thinning is
        given along the normal. x: profile shift coefficient, alpha: pressure angle, m: module.
    """
    design, pinion = pair["design_si"], pair["design_si"]["pinion"]
    angle = design["pressure_angle"]
    nominal = pi * design["module"] / 2.0 + 2.0 * pinion["profile_shift"] * tan(angle)
    return 1e3 * (nominal - pinion["thinning"] / cos(angle))


def pinion_span(pair: Mapping[str, Any]) -> tuple[int, float]:
    """Compute the span over the number of teeth for which its anvils touch nearest to the shifted pitch
    circle.

    That has the pitch radius plus the profile shift. Numbers of teeth run from 2 to half of all.

    Parameters
    ----------
    pair : mapping
        Record of the tooth geometry (`geometry/pair.json`), in m below `design_si`.

    Returns
    -------
    tuple of (int, float)
        Number of teeth and span, mm.

    References
    ----------
    ISO 21771: W_k = m cos(alpha) ((k - 1/2) pi + z inv(alpha)) + 2 x m sin(alpha), less the normal thinning.
    """
    design, pinion = pair["design_si"], pair["design_si"]["pinion"]
    angle, teeth = design["pressure_angle"], pinion["teeth"]
    base = pair["radii_mm"]["pinion_base"]
    target = pair["radii_mm"]["pinion_pitch"] + 1e3 * pinion["profile_shift"]

    def span(count: int) -> float:
        """Return the span W_k over `count` teeth, mm."""
        involute = tan(angle) - angle
        nominal = design["module"] * cos(angle) * ((count - 0.5) * pi + teeth * involute)
        with_shift = nominal + 2.0 * pinion["profile_shift"] * sin(angle)
        return 1e3 * (with_shift - pinion["thinning"])

    counts = range(2, max(teeth // 2, 2) + 1)
    best = min(counts, key=lambda count: abs(hypot(base, span(count) / 2.0) - target))
    return best, span(best)


def _mm(length: float) -> str:
    """Return a length in mm as text with DECIMALS decimals."""
    return f"{length:.{DECIMALS}f}"


def teeth_in_words(pair: Mapping[str, Any]) -> str:
    """Describe the teeth of a config in a sentence.

    Parameters
    ----------
    pair : mapping
        Plain values of section `tooth_pair`.

    Returns
    -------
    str
        Module, pressure angles, and what makes teeth other than spur ones.
    """
    drive, coast = flank_angles_deg(pair["pressure_angle_deg"])
    angles = f"{drive:g} deg" if drive == coast else f"{drive:g} deg on drive, {coast:g} deg on coast flanks"
    parts = [f"module {pair['module_mm']:g} mm", f"pressure angle {angles}"]
    for key, words, unit, spur_value in KINDS_IN_WORDS:
        if pair[key] != spur_value:
            parts.append(f"{words} {pair[key]:g} {unit}")
    return ", ".join(parts) + ". "


ROUNDING_OF_POWER = 1e-9
"""Relative difference of power in and out that is rounding."""


def machine_numbers(tables: Mapping[str, pd.DataFrame]) -> dict[str, Any]:
    """Return the numbers of table `ratings`, with the torque of the output: the bodies that take most
    power.

    If gears take most, output_torque_n_m is the largest magnitude of a gear's torque. If pinions do,
    output_pinions_n_m holds the different magnitudes of theirs, speed_ratio is 1 and gear_ratio is left
    out, as no gear is the output then.

    Parameters
    ----------
    tables : mapping of str to DataFrame
        Tables of the report by name: `ratings` (quantity, value) and `bodies` (role, torque_n_m,
        power_kw; power taken out is negative).

    Returns
    -------
    dict
        Numbers by quantity, whose names end in their units; empty without a machine.
    """
    if "ratings" not in tables:
        return {}
    numbers = dict(tables["ratings"].itertuples(index=False))
    driven_bodies = tables["bodies"][tables["bodies"]["power_kw"] < 0.0]
    gears = driven_bodies["role"] == "face gear"
    if (
        len(driven_bodies)
        and driven_bodies.loc[~gears, "power_kw"].sum() < driven_bodies.loc[gears, "power_kw"].sum()
    ):
        torques = dict.fromkeys(sorted(driven_bodies.loc[~gears, "torque_n_m"].abs()))
        return {
            **{name: value for name, value in numbers.items() if name != "gear_ratio"},
            "speed_ratio": 1.0,
            "output_pinions_n_m": tuple(torques),
        }
    torques = tables["bodies"].loc[tables["bodies"]["role"] == "face gear", "torque_n_m"]
    return numbers | {"output_torque_n_m": float(torques.abs().max())}


def nominal(tables: Mapping[str, pd.DataFrame]) -> pd.DataFrame:
    """Return the load sharing of the machine itself at its nominal speed, without its studies.

    Parameters
    ----------
    tables : mapping of str to DataFrame
        Tables of the report by name.

    Returns
    -------
    DataFrame
        Rows of table `summary` of stage load_sharing_summary with study `nominal`; empty without that
        table.
    """
    summary = tables.get("summary")
    return pd.DataFrame() if summary is None else summary[summary["study"] == "nominal"]
