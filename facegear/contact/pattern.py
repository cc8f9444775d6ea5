"""Columns of the contact table, the contact pattern, and its distance from the edges of the flanks."""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array, Arrays, Integers
from facegear.quantities import BODIES
from facegear.teeth.design import PairDesign
from facegear.teeth.limits import pitch_line_radius, radius_limits
from facegear.teeth.placement import pinion_angle, to_left_flank

SHARES = tuple(f"load_share_pair_{name}" for name in ("m2", "m1", "0", "p1", "p2"))
"""Load shares of the tooth pairs -2..2 (numbers as in `facegear.teeth.design`)."""

LTCA_COLUMNS = (
    "torque_n_m",
    "position",
    "ste_um",
    "unloaded_ste_um",
    "k_average_n_per_m",
    "k_local_n_per_m",
    "pairs_in_contact",
    *SHARES,
    "pressure_mpa",
    "pressure_error_mpa",
    "tip_line_load_n_per_mm",
    "tip_length_mm",
    "fillet_share",
    "interference_um",
    "kkt_residual",
    "torque_residual",
)
"""Columns of table `ltca`, a row for each torque and position; units stand in the names."""
LTCA_FINITE = tuple(
    name for name in LTCA_COLUMNS if name not in ("k_average_n_per_m", "pressure_mpa", "pressure_error_mpa")
)
"""Columns whose numbers are always finite: teeth that interfere have no average stiffness, and edges may
carry all load, where pressure has no limit."""

FILLET_CONTACT = 1e-3
"""Fraction of the torque in fillets, in column `fillet_share`, from which on it is reported and judged."""

PRESSURE_ARRAYS = {
    "torque_n_m": (None,),
    "position": (None,),
    "tooth": (None,),
    "node": (None,),
    "force_n": (None,),
    "in_fillet": (None,),
    "shape": (2,),
    "point_m": (None, 3),
    "line_torque_n_m": (None,),
    "line_position": (None,),
    "line_tooth": (None,),
    "line_plane": (None,),
    "line_where": (None,),
    "line_length_m": (None,),
    "line_load_n_per_m": (None,),
    "line_pressure_pa": (None,),
    "line_error_pa": (None,),
    "line_half_width_m": (None,),
    "contact_position": (None,),
    "contact_tooth": (None,),
    "contact_point_m": (None, None, 3),
}
"""Arrays of the pressure file, see `facegear.contact.analysis.pressure_arrays`.

They belong to the drive flank of the upper gear. For teeth other than spur ones `flank_variant` (2, 2)
follows, the number of the contact of each gear (upper, lower) and flank (drive, back), and the arrays of
further contacts behind their number (1_force_n), with their unloaded_m: unloaded transmission error of each
entry of `contact_position`.
"""


def pressure_of_flanks(arrays: Arrays) -> tuple[list[Arrays], Integers]:
    """Take apart the arrays of the contacts of all flanks.

    Parameters
    ----------
    arrays : Arrays
        Arrays as PRESSURE_ARRAYS.

    Returns
    -------
    list of Arrays
        PRESSURE_ARRAYS of each contact, that of the upper gear's drive flank first; `unloaded_m` with the
        others.
    (2, 2) array of int
        Number of the contact of each gear (upper, lower) and flank (drive, back); 0 where all are alike.
    """
    numbers = np.asarray(arrays.get("flank_variant", np.zeros((2, 2), dtype=int)))
    names = (*PRESSURE_ARRAYS, "unloaded_m")
    further_arrays = [
        {name: arrays[f"{number}_{name}"] for name in names} for number in range(1, int(numbers.max()) + 1)
    ]
    return [arrays, *further_arrays], numbers


LOAD_ARRAYS = {
    "variant": (None,),
    "flank_variant": (2, 2),
    "torque_n_m": (None,),
    "position": (None,),
    **{f"{body}_{name}": (None,) for body in BODIES for name in ("case", "tooth", "node", "force_n")},
    "nodes": (2,),
}
"""Arrays of the loads file: an entry a case, a row a loaded node of a body, and the numbers of nodes.

`variant` numbers the assembly errors of a case, `flank_variant` those of each gear (upper, lower) and flank
(drive, back), see `facegear.teeth.placement`.
"""

TOOTH_ERROR_ARRAYS = {f"{body}_{side}_m": (None,) for body in BODIES for side in ("drive", "back")}
"""Arrays of the contribution of a gear's teeth to the transmission error of a flank over one of the gear's
turns, m."""

EDGES = ("inside", "pinion tip", "gear tip", "end")
"""Locations of a loaded plane's strip of contact; `where` of the line loads numbers these."""


@dataclass(frozen=True, eq=False)
class Pattern:
    """One tooth's passage through the mesh in p steps and n planes across the pinion's axis.

    points (p, n, 3) m: its contact lines, on the right flank in the pinion's body frame; for each torque:
    `pressure` (p, n) Pa, nan where it is not known, and `edge` (p, n), a number in EDGES, -1 where
    unloaded; `line_load` (p, n) N/m.
    """

    points: Array
    pressure: dict[float, Array]
    edge: dict[float, Integers]
    line_load: dict[float, Array]

    @property
    def largest(self) -> float:
        """Largest pressure of all torques, Pa; 0 where there is none."""
        return max((float(np.nanmax(p, initial=0.0)) for p in self.pressure.values()), default=0.0)


def passage(position: Array, tooth: Integers) -> Array:
    """Return the position of a tooth in its passage: pair j at position x is where pair 0 is at x + j.

    Parameters
    ----------
    position : (...) array
        Mesh position in pitches, 0 to 1.
    tooth : (...) array of int
        Number j of the pair, -2 to 2.

    Returns
    -------
    (...) array
        position + tooth, in pitches, rounded to 9 digits so that equal places compare equal.
    """
    return np.round(position + tooth, 9)


def pattern(arrays: Arrays) -> Pattern:
    """Build the contact pattern from stored pressures.

    Parameters
    ----------
    arrays : Arrays
        Arrays as PRESSURE_ARRAYS.

    Returns
    -------
    Pattern
        Pattern at each torque, in SI units (m, Pa, N/m).
    """
    stages, first = np.unique(passage(arrays["contact_position"], arrays["contact_tooth"]), return_index=True)
    points = arrays["contact_point_m"][first]
    at = np.searchsorted(stages, passage(arrays["line_position"], arrays["line_tooth"]))
    shape = points.shape[:2]
    pressure, edge, line_load = {}, {}, {}
    for torque in np.unique(arrays["line_torque_n_m"]):
        on = arrays["line_torque_n_m"] == torque
        cells = at[on], arrays["line_plane"][on]
        values, kind, load = np.full(shape, np.nan), np.full(shape, -1), np.zeros(shape)
        inside = arrays["line_where"][on] == EDGES.index("inside")
        values[cells] = np.where(inside, arrays["line_pressure_pa"][on], np.nan)
        kind[cells], load[cells] = arrays["line_where"][on], arrays["line_load_n_per_m"][on]
        pressure[float(torque)], edge[float(torque)], line_load[float(torque)] = values, kind, load
    return Pattern(points=points, pressure=pressure, edge=edge, line_load=line_load)


def imprint(arrays: Arrays, face: tuple[float, float]) -> Array:
    """Measure the imprint of a passage along the pinion's axis, at each torque.

    Each loaded plane counts half way to its neighbours, within the face.

    Parameters
    ----------
    arrays : Arrays
        Arrays as PRESSURE_ARRAYS.
    face : tuple[float, float]
        Ends of the face, m from the gear's axis.

    Returns
    -------
    (torques, 4) array
        Torque (N m), length of the imprint (m), length over the width of the face, and its middle (m).
    """
    contact_pattern = pattern(arrays)
    half = 0.5 * float(np.diff(contact_pattern.points[0, :, 1]).mean())
    rows = []
    for torque, edge in contact_pattern.edge.items():
        y = contact_pattern.points[..., 1][edge >= 0]
        ends = np.clip([y.min() - half, y.max() + half], *face) if y.size else np.zeros(2)
        length = float(np.ptp(ends))
        rows.append((torque, length, length / (face[1] - face[0]), float(ends.mean())))
    return np.array(rows)


def pressure_surface(
    arrays: Arrays,
) -> tuple[Array, dict[str, Integers], dict[str, Array]]:
    """Return the pattern as quadrilaterals for ParaView.

    Parameters
    ----------
    arrays : Arrays
        Arrays as PRESSURE_ARRAYS.

    Returns
    -------
    tuple
        Points (n, 3), m; cells by kind (m, 4); fields (n,) by name: pressure (Pa, nan where it is not
        known) and line load (N/m) at each torque.
    """
    contact_pattern = pattern(arrays)
    steps, planes = contact_pattern.points.shape[:2]
    nodes = np.arange(steps * planes).reshape(steps, planes)
    corners = nodes[:-1, :-1], nodes[1:, :-1], nodes[1:, 1:], nodes[:-1, 1:]
    fields = {}
    for torque in contact_pattern.pressure:
        fields[f"pressure_pa_at_{torque:g}_n_m"] = contact_pattern.pressure[torque].ravel()
        fields[f"line_load_n_per_m_at_{torque:g}_n_m"] = contact_pattern.line_load[torque].ravel()
    cells = {"quad": np.stack([c.ravel() for c in corners], axis=-1)}
    return contact_pattern.points.reshape(-1, 3), cells, fields


@dataclass(frozen=True)
class PatternMargins:
    """Distances (m) from a contact pattern to the edges of the flanks, 0 where it reaches one.

    Attributes
    ----------
    inner_end, outer_end
        Along the gear's radius, to the ends of the common face.
    pinion_tip
        Along the pinion's radius, to its tip.
    gear_tip
        Along the gear's axis, to its tip plane.
    undercut, pointing
        Along the gear's radius, to where the gear's flank ends in undercut, and where its tips are pointed.
    """

    inner_end: float
    outer_end: float
    pinion_tip: float
    gear_tip: float
    undercut: float
    pointing: float


def pattern_margins(arrays: Arrays, design: PairDesign, torque: float) -> PatternMargins | None:
    """Compute the distances of the contact pattern from the edges of the flanks.

    Loaded planes across the pinion's axis count half way to their neighbours. Across the profile the
    pattern is that of the positions solved; a strip that reaches over a tip edge has no distance to it.

    Parameters
    ----------
    arrays : Arrays
        Arrays as PRESSURE_ARRAYS of the pair.
    design : PairDesign
        Pair of gears.
    torque : float
        On the pinion, N m.

    Returns
    -------
    PatternMargins, optional
        Distances, m; None without load at this torque.
    """
    on = arrays["line_torque_n_m"] == torque
    if not on.any():
        return None
    line_keys = list(zip(arrays["contact_position"].tolist(), arrays["contact_tooth"].tolist(), strict=True))
    row = {key: number for number, key in enumerate(line_keys)}
    keys = zip(arrays["line_position"][on].tolist(), arrays["line_tooth"][on].tolist(), strict=True)
    lines = np.array([row[key] for key in keys])
    points = arrays["contact_point_m"][lines, arrays["line_plane"][on]]
    touches_edge = {
        name: bool((arrays["line_where"][on] == number).any()) for number, name in enumerate(EDGES)
    }
    half = 0.5 * float(np.diff(arrays["contact_point_m"][0, :, 1]).mean())
    phi1 = pinion_angle(design, arrays["line_position"][on])
    motion = to_left_flank(design, phi1, np.zeros_like(phi1), arrays["line_tooth"][on])
    x, y, z = motion.points(points[:, None, :])[:, 0].T
    radius = np.hypot(x, y)
    half_face, limits = design.pinion.width / 2, radius_limits(design)
    first, last = (pitch_line_radius(design, design.middle + end) for end in (-half_face, half_face))
    first, last = max(design.face_gear.inner_radius, first), min(design.face_gear.outer_radius, last)
    inner, outer = max(radius.min() - half, first), min(radius.max() + half, last)
    growth = (points[:, 1] - design.middle) * design.family.taper
    to_tip = (design.pinion_tip_radius + growth - np.hypot(points[:, 0], points[:, 2])).min()
    below = (design.family.gear_tip.height(radius) - z).min()
    return PatternMargins(
        inner_end=inner - first,
        outer_end=last - outer,
        pinion_tip=0.0 if touches_edge["pinion tip"] else max(float(to_tip), 0.0),
        gear_tip=0.0 if touches_edge["gear tip"] else max(float(below), 0.0),
        undercut=inner - limits.inner,
        pointing=limits.outer - outer,
    )
