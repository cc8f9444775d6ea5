"""Columns of the tables of root stress, apart from what computes them."""

from facegear.quantities import BODIES

FILLETS = ("loaded", "other")
"""Below the flank that is loaded when the pinion drives, and below the other flank of the same tooth."""

ROOT_STRESS_COLUMNS = (
    "torque_n_m",
    "body",
    "fillet",
    "largest_mpa",
    "largest_error_mpa",
    "passage",
    "radius_mm",
    "tangent_deg",
    "at_30_deg_mpa",
    "smallest_mpa",
)
"""Columns of table `root_stress`; units stand in the names."""
PASSAGE_COLUMNS = ("torque_n_m", "body", "fillet", "passage", "largest_mpa", "smallest_mpa")
"""Columns of stress over the passage of a tooth."""
ALONG_FACE_COLUMNS = ("torque_n_m", "body", "fillet", "radius_mm", "largest_mpa", "smallest_mpa")
"""Columns of stress along the face."""

ROOT_STRESS_BY_FLANK_COLUMNS = ("gear", "flank", *ROOT_STRESS_COLUMNS)
"""Columns of root stress of each gear's flanks."""
ROOT_STRESS_ARRAYS = {
    "torque_n_m": (None,),
    "flank_variant": (2, 2),
    **{
        f"{body}_{name}": shape
        for body in BODIES
        for name, shape in (
            ("passage", (None,)),
            ("stress_pa", (None, None, 2, None, None)),
            ("other_stress_pa", (None, None, None, 2, None, None)),
            ("position_m", (2, None, None, 3)),
            ("tangent_rad", (2, None, None)),
            ("error", (None,)),
        )
    },
}
"""Stress over torque, place in the passage, fillet, gauges down the fillet and along the face.

`stress_pa` under the first of the assembly errors that flanks meet, `other_stress_pa` under the others;
`flank_variant` numbers those of each gear (upper, lower) and flank (drive, back).
"""

SAFETY_COLUMNS = (
    "body",
    "flank",
    "verdict",
    "bending_safety",
    "standard_bending_safety",
    "pitting_safety",
    "standard_pitting_safety",
    "edge_line_load_n_per_mm",
    "edge_length_mm",
    "life_hours",
    "reliability",
    "nearest_limit",
    "reason",
    "caveat",
    "within_torques_solved",
)
"""Columns of table `safety`."""
SCUFFED_COLUMNS = ("scuffing_safety", "scuffing_margin_k", "smallest_film_ratio", "micropitting_safety")
"""Further columns of the table of safety where section lubrication is given (the running machine)."""
RATED_FLANK = ("body", "gear", "flank", "failure", "method")
"""Columns that name the subject of a row of a rating."""
RATING_COLUMNS = (
    *RATED_FLANK,
    "stress_mpa",
    "stress_error_mpa",
    "allowed_mpa",
    "cycles",
    "safety",
    "required",
    "verdict",
    "reason",
    "caveat",
    "damage",
    "life_hours",
    "reliability",
    "within_torques_solved",
)
"""Columns of table `rating`."""
CURVE_COLUMNS = (*RATED_FLANK, "cycles", "allowed_mpa")
"""Columns of allowed stress over cycles."""
DAMAGE_COLUMNS = (
    *RATED_FLANK,
    "bin",
    "torque_n_m",
    "speed_rpm",
    "hours",
    "stress_mpa",
    "cycles",
    "damage",
    "within_torques_solved",
)
"""Columns of damage by bin."""

DUTY_LOAD_COLUMNS = (
    "bin",
    "torque_n_m",
    "speed_rpm",
    "mesh",
    "flank",
    "mean_force_n",
    "largest_force_n",
    "mesh_load_factor",
    "dynamic_factor",
    "motion",
    "settled",
)
"""Columns of the table of loads in every bin of the duty cycle, a row for each flank of a mesh that carries
any."""
DUTY_SPECTRUM_COLUMNS = ("bin", "body", "gear", "flank", "mesh", "fraction", "force_n")
"""Columns of the table of forces that the hardest loaded tooth of a body meets in its passages through a
mesh."""

RATING_FINITE = tuple(
    name
    for name in RATING_COLUMNS
    if name not in ("stress_error_mpa", "reason", "caveat", "damage", "life_hours", "reliability")
)
"""Columns of `rating` that hold a value in every row."""
DAMAGE_FINITE = tuple(name for name in DAMAGE_COLUMNS if name != "damage")
"""Columns of damage that hold a value in every row."""
SAFETY_FINITE = tuple(
    name
    for name in SAFETY_COLUMNS
    if name not in ("standard_bending_safety", "pitting_safety", "standard_pitting_safety")
    and name not in ("life_hours", "reliability", "reason", "caveat")
)
"""Columns of `safety` that hold a value in every row."""
MAY_BE_UNKNOWN = ("largest_error_mpa", "at_30_deg_mpa")
"""Columns of root stress that may be empty."""
ROOT_STRESS_BY_FLANK_FINITE = tuple(
    name for name in ROOT_STRESS_BY_FLANK_COLUMNS if name not in MAY_BE_UNKNOWN
)
"""Columns of root stress by flank that hold a value in every row."""
ROOT_STRESS_FINITE = tuple(name for name in ROOT_STRESS_COLUMNS if name not in MAY_BE_UNKNOWN)
"""Columns whose numbers are always finite: life may last for ever, 30 degrees lie beside the gauges, the
error of a mesh of few elements is not known, and edges may carry all load, where pressure has no limit."""

DYNAMIC_STRESS_COLUMNS = (
    "mesh",
    "mean_force_n",
    "largest_force_n",
    "dynamic_factor",
    "pinion_mean_mpa",
    "pinion_running_mpa",
    "pinion_bound_mpa",
    "face_gear_mean_mpa",
    "face_gear_running_mpa",
    "face_gear_bound_mpa",
    "pressure_mean_mpa",
    "pressure_bound_mpa",
    "within_torques_solved",
)
"""Columns of root stress in motion; units stand in the names."""
DYNAMIC_STRESS_FINITE = tuple(
    name for name in DYNAMIC_STRESS_COLUMNS if name != "dynamic_factor" and not name.startswith("pressure")
)
"""Columns whose numbers are always finite: an open mesh has no dynamic factor, and edges may carry all."""

STRESS_OVER_SPEED_COLUMNS = (
    "motion",
    "class",
    "speed_rpm",
    "mesh",
    "largest_force_n",
    "dynamic_factor",
    "pinion_mpa",
    "face_gear_mpa",
    "pressure_mpa",
    "within_torques_solved",
    "worst",
)
"""Columns of the table of stress over speed, a row for each motion known at a speed."""
STRESS_OVER_SPEED_FINITE = tuple(
    name for name in STRESS_OVER_SPEED_COLUMNS if name not in ("pressure_mpa", "dynamic_factor")
)
"""Columns whose numbers are always finite: edges may carry all, and a machine run without load."""
