"""Columns of the branches stage's tables, apart from the code that computes them: readers need no solver."""

BRANCH_COLUMNS = (
    "branch",
    "point",
    "arc",
    "speed_rpm",
    "period",
    "stable",
    "leading_multiplier_real",
    "leading_multiplier_imaginary",
    "mesh",
    "deflection_ac_rms_um",
    "deflection_rms_um",
    "deflection_minimum_um",
    "deflection_maximum_um",
    "peak_force_n",
    "open_fraction",
    "drive_fraction",
    "back_fraction",
)
"""Columns of table `branches`, a row for each point and mesh; units stand in the names."""
BRANCH_FINITE = tuple(name for name in BRANCH_COLUMNS if "multiplier" not in name)
"""Columns whose numbers are finite in every row."""
SPECIAL_COLUMNS = (
    "branch",
    "period",
    "kind",
    "speed_rpm",
    "arc",
    "multiplier_real",
    "multiplier_imaginary",
    "angle_deg",
    "stable_before",
    "stable_after",
    "meshes",
    "edge",
    "proof",
)
"""Columns of table `special`: folds, doublings and other special points."""
SWEPT_COLUMNS = (
    "direction",
    "speed_rpm",
    "class",
    "period",
    "branch",
    "distance",
    "sweep_error",
    "note",
)
"""Columns of table `swept`: the branch of each periodic row of a sweep."""
JUMP_COLUMNS = (
    "direction",
    "speed_before_rpm",
    "speed_after_rpm",
    "class_before",
    "branch",
    "kind",
    "speed_rpm",
    "note",
)
"""Columns of table `jumps`: the branch that ends at each jump of a sweep."""
