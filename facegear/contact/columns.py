"""Columns of the contact table, apart from what computes it, so that readers need no solver."""

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
    "peak_pressure_mpa",
    "edge_pressure_mpa",
    "kkt_residual",
    "torque_residual",
)

PRESSURE_ARRAYS = {
    "torque_n_m": (None,),
    "position": (None,),
    "tooth": (None,),
    "node": (None,),
    "force_n": (None,),
    "pressure_pa": (None,),
    "whole": (None,),
    "shape": (2,),
    "point_m": (None, 3),
    "area_m2": (None,),
}
"""Arrays of the pressure file: one loaded hat a row, then the lattice the nodes belong to."""

LOAD_ARRAYS = {
    "torque_n_m": (None,),
    "position": (None,),
    **{
        f"{body}_{name}": (None,)
        for body in ("pinion", "face_gear")
        for name in ("case", "tooth", "node", "force_n")
    },
    "nodes": (2,),
}
"""Arrays of the loads file: an entry a case, a row a loaded node of a body, and the numbers of nodes."""
