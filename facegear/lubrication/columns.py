"""Columns of the tables of friction and heat, apart from what computes them."""

BY_TORQUE_COLUMNS = (
    "torque_n_m",
    "speed_rpm",
    "friction_model",
    "loss_factor",
    "loss_factor_min",
    "loss_factor_max",
    "mean_friction",
    "loss_w",
    "efficiency",
    "pinion_heat_w",
    "face_gear_heat_w",
    "pinion_bulk_c",
    "face_gear_bulk_c",
    "largest_sliding_m_per_s",
    "largest_flash_k",
    "flash_position",
    "flash_pair",
    "flash_axial_mm",
    "contact_temperature_c",
    "allowed_contact_temperature_c",
    "allowed_contact_temperature_source",
    "scuffing_safety",
    "scuffing_margin_k",
    "mean_flash_k",
    "integral_temperature_c",
    "allowed_integral_temperature_c",
    "integral_safety",
    "smallest_film_um",
    "smallest_short_film_um",
    "smallest_film_ratio",
    "smallest_micropitting_film_ratio",
    "micropitting_safety",
)
"""Columns of `assessment.by_torque_table`."""
BY_TORQUE_FINITE = tuple(
    name
    for name in BY_TORQUE_COLUMNS
    if "allowed" not in name
    and "safety" not in name
    and "margin" not in name
    and not name.startswith(("smallest", "flash_"))
)
"""Columns whose numbers are always finite: limits may be unknown, and edges may carry all."""

POSITION_COLUMNS = (
    "torque_n_m",
    "position",
    "loss_factor",
    "loss_w",
    "largest_flash_k",
    "smallest_film_um",
    "smallest_film_ratio",
)
"""Columns of `assessment.position_table`."""
POSITION_FINITE = POSITION_COLUMNS[:5]
"""Columns of table `positions` that hold a number in every row."""

EXCITATION_COLUMNS = (
    "torque_n_m",
    "position",
    "tangential",
    "along_pinion_axis",
    "along_gear_axis",
    "pinion_lever_mm",
    "face_gear_lever_mm",
)
"""Friction over the force of the mesh: forces on the pinion, moments on pinion and face gear."""
EXCITATION_FLANK = ("gear", "flank")
"""Columns in front of EXCITATION_COLUMNS for teeth other than spur ones, whose flanks all have rows."""
EXCITATION_TILTS = ("pinion_tilt_x_mm", "pinion_tilt_y_mm")
"""Columns behind EXCITATION_COLUMNS for teeth other than spur ones: moments that tilt the pinion."""

LIMIT_COLUMNS = ("friction_model", "limit", "limit_source", "torque_n_m", "loss_outside_percent")
"""Columns of `assessment.limit_table`."""

MAP_COLUMNS = (
    "torque_n_m",
    "speed_rpm",
    "loss_w",
    "efficiency",
    "largest_flash_k",
    "contact_temperature_c",
    "smallest_film_ratio",
)
"""Columns of `assessment.map_table`."""
MAP_FINITE = MAP_COLUMNS[:2]
"""The rest is empty where a body would pass the flash point of the oil."""

MESH_COLUMNS = (
    "bin",
    "speed_rpm",
    "mesh",
    "flank",
    "pinion_torque_n_m",
    "largest_torque_n_m",
    "power_w",
    "loss_w",
    "loss_percent",
    "loss_in_motion_w",
    "pinion_heat_w",
    "face_gear_heat_w",
    "pinion_bulk_c",
    "face_gear_bulk_c",
    "largest_flash_k",
    "contact_temperature_c",
    "scuffing_safety",
    "scuffing_margin_k",
    "smallest_film_ratio",
    "smallest_micropitting_film_ratio",
    "micropitting_safety",
    "within_torques_solved",
)
"""Bin 0 is the nominal load at rest, the others are those of the duty cycle. Loss in motion: the mean of the
motion at the nominal load, where friction disturbs it."""
MESH_FINITE = tuple(
    name
    for name in MESH_COLUMNS
    if "safety" not in name and "margin" not in name and "smallest" not in name and name != "loss_in_motion_w"
)
"""Columns of table `meshes` that hold a number in every row."""

BODY_COLUMNS = ("bin", "speed_rpm", "body", "heat_w", "bulk_c")
"""Columns of table `bodies`: heat, W, and bulk temperature, C, of each body."""

MACHINE_COLUMNS = (
    "bin",
    "hours",
    "speed_rpm",
    "power_in_w",
    "power_through_meshes",
    "loss_w",
    "loss_percent",
    "efficiency",
    "energy_lost_kwh",
    "within_torques_solved",
)
"""power_through_meshes: sum of the power of all meshes over the power in. The last row, bin -1, is the whole
duty cycle."""

FRICTION_STUDY_COLUMNS = (
    *("study", "point", "label"),
    *("speed_rpm", "power_in_w", "loss_w", "loss_percent"),
    *("hottest_mesh", "contact_temperature_c", "scuffing_safety"),
    "smallest_film_ratio",
    "within_torques_solved",
)
"""Columns of the table of studied machines with friction; units stand in the names."""

LOCAL_ARRAYS: dict[str, tuple[int | None, ...]] = {
    "torque_n_m": (None,),
    "position": (None,),
    "tooth": (None,),
    "plane": (None,),
    "inside": (None,),
    "axial_m": (None,),
    "roll_rad": (None,),
    "line_load_n_per_m": (None,),
    "radius_m": (None,),
    "u1_m_per_s": (None,),
    "u2_m_per_s": (None,),
    "sliding_m_per_s": (None,),
    "sliding_across_m_per_s": (None,),
    "sliding_along_m_per_s": (None,),
    "entrained_along_m_per_s": (None,),
    "friction": (None,),
    "loss_w_per_m": (None,),
    "flash_k": (None,),
    "pinion_heat_fraction": (None,),
    "film_m": (None,),
    "shear_factor": (None,),
    "film_ratio": (None,),
    "micropitting_film_ratio": (None,),
    "speed_rad_per_s": (1,),
}
"""A row for every loaded plane of a contact line, at the nominal speed."""
