"""Figures of the shafts: side views, deflections and slopes."""

from collections.abc import Mapping

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.build.tooth_numbers import ToothNumbers
from facegear.number_format import format_number
from facegear.report.figures.colours import ORANGE, WHITE, grey
from facegear.report.figures.description import Axis, Figure, Key, Panel
from facegear.report.figures.machine import CURVES, MARGIN
from facegear.report.figures.marks import Area, Curve, Line, Look, Text
from facegear.schema.shafts import ShaftSection
from facegear.schema.transmission import Transmission

SHAFT, BORE, PINION = grey(0.75), WHITE, ORANGE
"""Colours of the parts of a shaft."""


def shafts_figures(
    bearings: pd.DataFrame,
    deflections: pd.DataFrame,
    transmission: Transmission,
    teeth: ToothNumbers,
    width_mm: float | None,
) -> list[Figure]:
    """Draw one figure with a pair of panels for each shaft; no figure for a machine without shafts.

    Parameters
    ----------
    bearings : DataFrame
        Forces on the bearings of the shafts: pinion, bearing (letter), radial_n.
    deflections : DataFrame
        Deflections along the shafts: pinion, at_mm, x_um, y_um.
    transmission : Transmission
        Section `transmission` of the config.
    teeth : ToothNumbers
        Numbers of teeth and sizes of the pair.
    width_mm : float or None
        Face width of the pinions, mm, where it is known.

    Returns
    -------
    list of Figure
        No or one figure.
    """
    sections = {pinion.name: transmission.shaft_of(pinion) for pinion in transmission.pinions}
    shaft_sections = {name: section for name, section in sections.items() if section is not None}
    if not shaft_sections:
        return []
    return [shafts_figure(shaft_sections, bearings, deflections, 1e3 * teeth.pitch_radius, width_mm)]


def shafts_figure(
    sections: Mapping[str, ShaftSection],
    bearings: pd.DataFrame,
    deflections: pd.DataFrame,
    radius_mm: float,
    width_mm: float | None,
) -> Figure:
    """Draw a pair of panels for each shaft: above its bearings and the forces on them, below its deflections.

    Equal shafts with equal forces and deflections share a pair of panels.

    Parameters
    ----------
    sections : mapping of str to ShaftSection
        Shaft of each pinion by the pinion's name.
    bearings : DataFrame
        Forces on the bearings of the shafts: pinion, bearing (letter), radial_n.
    deflections : DataFrame
        Deflections along the shafts: pinion, at_mm (from the inner end), x_um (tangential to the gear),
        y_um (along the gear's axis).
    radius_mm : float
        Pitch radius of the pinions, mm.
    width_mm : float or None
        Face width of the pinions, mm, where it is known.

    Returns
    -------
    Figure
        Two panels for each group of equal shafts.
    """
    panels = []
    for names in _group_equal_shafts(sections, bearings, deflections):
        section = sections[names[0]]
        margin = MARGIN * section.length_mm + 0.5 * (width_mm or 0.0)
        along = Axis(
            "Along the shaft, from its inner end outwards", "mm", low=-margin, high=section.length_mm + margin
        )
        positions = [
            Line(at, colour=grey(0.6), line="dot")
            for at in (section.pinion_mm, *(bearing.at_mm for bearing in section.bearings))
        ]
        forces = bearings[bearings["pinion"] == names[0]]
        side, reach = _side_view(section, forces, radius_mm, width_mm)
        height = Axis("", "", low=-1.1 * reach, high=1.1 * reach)
        shaft_deflections = deflections[deflections["pinion"] == names[0]]
        curves = [
            Curve(shaft_deflections["at_mm"], shaft_deflections[f"{key}_um"], words, colour, line)
            for key, (words, colour, line) in CURVES.items()
        ]
        panels += [
            Panel(along, height, [*positions, *side], title=", ".join(names), height=1.5, bare=True),
            Panel(along, Axis("Deflection", "µm"), [*positions, *curves], height=1.2),
        ]
    keys = [
        Key("pinion", PINION, area=True, opacity=0.7),
        Key("bearing and radial force on it", line="none", marker="triangle-up"),
    ]
    return Figure(panels, shared_x=False, keys=keys)


def _group_equal_shafts(
    sections: Mapping[str, ShaftSection], bearings: pd.DataFrame, deflections: pd.DataFrame
) -> list[list[str]]:
    """Return the names of the pinions in groups of equal shafts: equal sections, and radial bearing
    forces (N) and deflections (µm) that agree within 1e-4 relative or 1e-3 absolute.
    """
    groups: list[tuple[ShaftSection, Array, list[str]]] = []
    for name, section in sections.items():
        forces = bearings.loc[bearings["pinion"] == name, "radial_n"].to_numpy(dtype=float)
        displacements = deflections.loc[deflections["pinion"] == name, ["x_um", "y_um"]].to_numpy(dtype=float)
        numbers = np.concatenate([forces, displacements.ravel()])
        for group_section, group_shape, names in groups:
            if group_section == section and np.allclose(numbers, group_shape, rtol=1e-4, atol=1e-3):
                names.append(name)
                break
        else:
            groups.append((section, numbers, [name]))
    return [names for *_, names in groups]


def _side_view(
    section: ShaftSection,
    bearings: pd.DataFrame,
    radius_mm: float,
    width_mm: float | None,
) -> tuple[list[Area | Curve | Text], float]:
    """Return the marks of a shaft's side view (mm along the shaft and from its axis): segments with
    their bores, pinion, bearings with their radial forces (kN); and its largest radius, mm.

    bearings: rows of the bearing table of this shaft; radius_mm: pitch radius; width_mm: face width of
    the pinion, None if unknown.
    """
    marks: list[Area | Curve | Text] = []
    begin = 0.0
    for segment in section.segments:
        for diameter, colour in ((segment.diameter_mm, SHAFT), (segment.bore_mm, BORE)):
            if diameter > 0.0:
                box = _box(begin, segment.length_mm, 0.5 * diameter)
                marks.append(Area(*box, colour=colour, outline=grey(0.3)))
        begin += segment.length_mm
    width = width_mm or 0.0
    pinion = _box(section.pinion_mm - 0.5 * width, width, radius_mm)
    marks.append(Area(*pinion, colour=PINION, opacity=0.7, outline=PINION))
    outer = max(segment.diameter_mm for segment in section.segments) / 2.0
    forces = bearings.set_index("bearing")["radial_n"]
    for letter, bearing in zip(forces.index, section.bearings, strict=True):
        half = 0.5 * _diameter_at(section, bearing.at_mm)
        for height, marker in ((-half, "triangle-up"), (half, "triangle-down")):
            at = np.array([bearing.at_mm]), np.array([height])
            marks.append(Curve(*at, line="none", marker=marker, size=9.0))
        text = f"{letter}\n{format_number(1e-3 * forces[letter])} kN"
        look: Look = {"shift": (0.0, -12.0), "across": "center", "upright": "top", "paper": True}
        marks.append(Text(bearing.at_mm, -half, text, **look))
    return marks, max(outer, radius_mm)


def _box(begin: float, length: float, half: float) -> tuple[Array, Array]:
    """Return the corners x, y (5,) of a closed rectangle about the shaft's axis, from its begin and
    length along the axis and its half height, all in mm.
    """
    end = begin + length
    return np.array([begin, end, end, begin, begin]), half * np.array([-1.0, -1.0, 1.0, 1.0, -1.0])


def _diameter_at(section: ShaftSection, at: float) -> float:
    """Return the diameter (mm) of a shaft at a distance (mm) from its inner end: the larger one at a step."""
    ends = np.cumsum([0.0, *(segment.length_mm for segment in section.segments)])
    diameters = [
        segment.diameter_mm
        for segment, begin, end in zip(section.segments, ends[:-1], ends[1:], strict=True)
        if begin <= at <= end
    ]
    return max(diameters or [section.segments[-1].diameter_mm])
