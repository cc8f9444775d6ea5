"""Columns of the contact table, apart from what computes it, so that readers need no solver."""

from facegear.geometry.bodies import BODIES

SHARES = tuple(f"load_share_pair_{name}" for name in ("m2", "m1", "0", "p1", "p2"))
"""Load shares of the tooth pairs -2..2 (numbers as in `facegear.geometry.design`)."""

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
"""Arrays of the pressure file, see `facegear.contact.tables.pressure_arrays`."""

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
(drive, back), see `facegear.geometry.flank_errors`.
"""

TOOTH_ERROR_ARRAYS = {f"{body}_{side}_m": (None,) for body in BODIES for side in ("drive", "back")}
"""Arrays of the contribution of a gear's teeth to the transmission error of a flank over one of the gear's
turns, m."""

EDGES = ("inside", "pinion tip", "gear tip", "end")
"""Where a loaded plane's strip of contact lies: `where` of the line loads numbers these."""
