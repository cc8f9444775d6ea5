"""Texts above the tables of a report, and the columns that its widest tables show at once."""

BY_TORQUE = (
    "One row for each torque on the pinion, over a pitch. ste peak to peak: the largest transmission error "
    "less the smallest of the positions solved, which is never more than the true value; half: the same with "
    "every second position only. pressure: the largest away from edges, with the error that the mesh leaves. "
    "tip line load: the largest at a tip edge, where pressure has no limit; tip length: the greatest length "
    "of a tip edge that carries load. path radius: distance of the contact forces' centroid from the gear's "
    "axis"
)
"""Caption of the table of contact by torque."""
BEARINGS = (
    "Reactions of the bearing of every body at the nominal speed. static: at rest under the mean torques; "
    "peak: the largest magnitude in each direction. x of a pinion is tangential and y is along the gears' "
    "axis; the axis of a face gear is z"
)
"""Caption of the table of bearing forces."""
ROOT_STRESS = (
    "Largest and smallest stress of each fillet over a passage. loaded: the fillet below the flank that "
    "carries the load; radius: distance from the gear's axis; tangent: angle between the fillet and the "
    "tooth's middle line"
)
"""Caption of the table of root stress."""
SHAFT_TABLES = {
    "shafts_seats": "Stiffness of what each pinion sits on, without moments, and where it stands under the "
    "mean torques",
    "shafts_bearings": "Loads of the shafts on their bearings under the mean torques",
    "shafts_torsion": "Masses behind torsional springs: twist of the spring, of all before it as well "
    "(windup), and natural frequencies of the chain with its gear free",
}
"""Captions of the tables of shafts."""


STUDY_COLUMNS = [
    *("study", "label", "torque_n_m", "k_average_mean_n_per_m", "ste_peak_to_peak_um"),
    *("path_radius_mm", "path_shift_mm", "unloaded_path_shift_mm", "backlash_um"),
]
"""Columns of studied contact that the report shows."""
SAFETY = (
    "Safety and life of every flank under the duty cycle. drive: the flank with which a pinion drives. "
    "Safety is the factor on all stresses at which Miner's sum is 1. Bending is judged by the root stress of "
    "the finite elements, and for pinions after ISO 6336-3 (standard) as well; no standard exists for face "
    "gears, which are judged by the same limits. Pitting is judged by the pressure of the contact analysis "
    "away from edges, and after ISO 6336-2 (standard) with the gear's flank as that of a rack. edge: "
    "what tip "
    "edges carry under the largest torque, where pressure has no limit. life: the shortest of all; inf: no "
    "load does damage. reliability: at the end of the duty cycle, where the material card gives a Weibull "
    "shape and a load does damage. green: as safe as required; red: less safe, for the reason given. caveat: "
    "what the method does not know; it never changes the colour"
)
"""Caption of the table of safety."""
RATING = "Every kind of failure with its limits; the stress is that of the hardest load"
"""Caption of the table of ratings."""
DUTY_LOADS = (
    "Loads of the running machine in every bin of the duty cycle: the flank with the largest force. "
    "mesh load factor (K_gamma): the largest mean of a mesh cycle over the mesh's nominal even "
    "share; dynamic "
    "factor (K_v): the largest force over that mean; followed: computed through the hunting cycle while "
    "runouts turn"
)
"""Caption of the table of loads in the bins of the duty cycle."""


EVERY_LOAD = "Loads of every flank in every bin"
"""Caption of the table of loads of every flank."""
DYNAMIC = (
    "Largest root stress of every mesh at the nominal speed. mean: with the mean force of the mesh; running: "
    "the largest of the history, in which every tooth carries its share of the force of that moment; bound: "
    "with the largest force throughout the passage. Pressure is that away from edges. Beyond the torques of "
    "the contact analysis (contact.torques_n_m) stress is taken in proportion"
)
"""Caption of the table of root stress in motion."""
OVER_SPEED = (
    "Hardest loads over the speed range: at the nominal speed, and the worst of each motion. dynamic factor: "
    "the largest mesh force over the largest at rest; stress and pressure are those with that force "
    "throughout "
    "the passage; worst: whether the motion is the hardest of all that are known at that speed"
)
"""Caption of the table of stress over speed."""
MODE_CONTACTS = (
    "Contacts that are closed in the modes, because the mean torques press them together, with the mesh "
    "stiffness used. local: the slope dF / d deflection, which small vibrations feel; average: F / "
    "deflection; "
    "given: a number of the config. An undecided contact carries too little load to tell it from "
    "rounding, and "
    "counts as open"
)
"""Caption of the table of contacts in the modes."""
NEAR_RESONANCE = 0.3
"""Largest relative distance of a jump from the linear resonance that it may belong to."""
JUMPS = (
    "Abrupt changes of the motion. kind: a jump from one periodic motion, which ends or loses its "
    "stability, to another; a step of the sweep that left a stable motion because it was too large; or "
    "irregular motion that begins or ends. error: how far the speed may lie from that of the change. "
    "moves most: the linear mode with the largest fraction of the energy just "
    "beside the "
    "jump, and the multiple of the mesh frequency at which it moves most. linear resonance: the "
    "speed at which "
    "that multiple meets the mode's frequency; blank where the jump is more than "
    f"{100 * NEAR_RESONANCE:.0f} % away from it, and so belongs to no linear resonance of that mode"
)
"""Caption of the table of jumps."""
SAFETY_SHOWN = (
    *("body", "flank", "verdict", "bending_safety", "standard_bending_safety"),
    *("pitting_safety", "life_hours", "reason"),
)
"""Columns of safety that are not folded."""
DYNAMIC_SHOWN = (
    *("mesh", "mean_force_n", "largest_force_n", "dynamic_factor"),
    *("pinion_running_mpa", "face_gear_running_mpa", "pressure_bound_mpa", "within_torques_solved"),
)
"""Columns of root stress in motion that are not folded."""
FOLLOWING_SHOWN = (
    *("group", "speed_rpm", "torque_n_m", "mesh_cycles", "mean", "k_gamma", "k_v", "k_gamma_static"),
)
"""Columns of the running machine that are not folded."""
BY_TORQUE_SHOWN = (
    *("torque_n_m", "k_average_mean_n_per_m", "k_local_mean_n_per_m", "ste_peak_to_peak_um"),
    *("pressure_mpa", "pressure_error_mpa", "tip_line_load_n_per_mm", "fillet_share"),
)
"""Columns of contact by torque that are not folded."""
OVER_SPEED_SHOWN = (
    *("motion", "speed_rpm", "mesh", "largest_force_n", "dynamic_factor"),
    *("pinion_mpa", "face_gear_mpa", "pressure_mpa"),
)
"""Columns of the widest tables that are shown at once."""
REACTIONS = ("radial", "x", "y", "z")
"""Directions of a bearing's reactions, in the order of columns."""
DRAWINGS = ("layout", "machine", "tooth_pair")
"""Figures that show the machine; the first that exists stands in the chapter on the machine."""
LONG_TABLE = 40
"""Rows of natural frequencies above which their table is folded."""
