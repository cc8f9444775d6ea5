"""Captions of the figures and texts of the chapters of a case's report."""

from collections.abc import Mapping
from typing import Any

CAPTIONS = {
    "pose_pattern": "Contact pattern of the mesh that its pose changes most, as assembled and where the "
    "machine's own forces put its teeth, on one scale.",
    "pose_paths": "Unloaded contact of every mesh along the pinion over the load, with the ends of the face.",
    "tooth_pair": "Pinion and face gear in mesh.",
    "tooth_sections": "Sections of both teeth, with the radii between which the gear's teeth can exist.",
    "separation": "Gap between the unloaded flanks, and the path of the contact over the gear's flank.",
    "contact_curves": "Static transmission error, stiffness and load share against position.",
    "topography_pinion": "Mean deviations of the pinion's teeth from the nominal flank.",
    "topography_face_gear": "Mean deviations of the face gear's teeth from the nominal flank.",
    "tooth_errors": "What single teeth that deviate from the others add to the transmission error.",
    "shaft_orders": "Mesh forces at the orders of the gears' turns, at the nominal speed and over speed, "
    "from runouts, pitch deviations and single teeth.",
    "contact_pattern": "Pressure on the flank that contact lines sweep; at edges only line loads are known.",
    "life": "Stress of every bin of the duty cycle beside the stress that is allowed for as many "
    "load cycles; of pinions and of face gears the flank nearest to its limit.",
    "damage": "Damage of every bin of the duty cycle to the same flanks; a sum of 1 is the end of life.",
    "stress_over_speed": "Largest root stress, pressure and dynamic factor of all meshes over speed; dots: "
    "stable motions that were followed; shaded: beyond the torques of the contact analysis.",
    "friction_path": "Sliding, flash temperature and film along the path of contact; beside edges no "
    "temperature is known.",
    "friction_flank": "Friction loss and flash temperature over the pinion's flank at the largest torque.",
    "efficiency_map": "Friction loss of a mesh and its contact temperature over torque and speed.",
    "root_stress_passage": "Root stress of a tooth on its way through the mesh: largest tension below the "
    "loaded flank, largest compression below the other.",
    "root_stress_along_face": "Root stress along the face, the largest over a passage.",
    "mesh_stiffness": "Mesh stiffness over a mesh period, and its Fourier series.",
    "stiffness_harmonics": "Amplitudes of the mesh stiffness harmonics.",
    "stiffness_load": "Mean stiffness and its harmonics against load.",
    "mesh_law": "Force of a mesh over a mesh period at even deflections, up to the last level of its law.",
    "mesh_law_surface": "Force of the same mesh over the mesh period and the deflection.",
    "law_loads": "Forces of the meshes at the nominal speed and in the sweep beside the table of their law, "
    "which ends at the mean force of its last level; "
    "beside a row: the fraction of the time past it.",
    "law_sweeps": "RMS of mesh deflections over speed, with the mesh laws of the studies over each other.",
    "mode_shapes": "Shapes of typical modes, of at most twelve kinds from low frequencies on; one bar stands "
    "for a casing.",
    "body_shapes": "Section of the face gear and its first mode shapes at a crest, exaggerated, hub held; "
    "grey: at rest, the brighter the larger the motion, that round the axis included.",
    "body_waves": "Frequencies of the face gears over nodal diameters, hubs held: at rest, and of waves in "
    "space at the nominal speed.",
    "shafts": "Shafts of the pinions with the radial forces on their bearings, and how they deflect under "
    "the mean torques; lengths and diameters have scales of their own. Pinions whose shafts do the same are "
    "drawn once.",
    "bearings": "Rolling bearings over the machine's torque, that of the config being 1: stiffness along "
    "the radial load, and angle of the circumference that is loaded. Bearings that do the same are drawn "
    "once.",
    "casing_sharing": "Forces of the meshes at rest on the casing, and on seats that stand still.",
    "casing_campbell": "Modes of the machine over speed, those of the casing in colour; marks: crossings "
    "with multiples of the mesh frequency.",
    "casing_acceleration": "Acceleration of the casing at its sensors over speed, by multiples of the mesh "
    "frequency.",
    "machine_campbell": "Modes of the whole machine over speed and the waves of its gears; marks: crossings "
    "with mesh harmonics, larger where the phases of the meshes add up.",
    "body_campbell": "Waves of a face gear over speed, hub held; marks: crossings with mesh harmonics, "
    "larger where the phases of the meshes add up.",
    "campbell": "Campbell diagram: natural frequencies against multiples of the mesh frequency. Crosses mark "
    "where irregular motion begins or ends; grey marks lie off the lines, at no multiple.",
    "mesh_deflections": "Mesh deflections at the nominal speed and their spectra.",
    "pinion_sweep": "RMS of the pinions' translations over speed.",
    "gear_sweep": "RMS of the face gears' translations over speed.",
    "mesh_sweep": "RMS of the mesh deflections, speed rising and falling; ticks mark jumps, "
    "dotted ones where irregular motion begins or ends.",
    "waterfall": "Spectrum of a mesh deflection over speed.",
    "machine": "The machine to scale: directions of rotation, and mean forces of meshes at rest.",
    "layout": "The machine to scale: directions of rotation, mean forces of meshes and on bearings, at rest.",
    "hunting": "Share of each mesh in its group's load over the hunting cycle, quasi-static.",
    "bearing_stiffness": "K_gamma against the bearing stiffness of inputs and idlers, both kinematics.",
    "tolerance_distributions": "Fraction of the samples above each value, with percentiles and their "
    "intervals.",
    "tolerance_importance": "Which tolerance matters: total Sobol indices, or rank correlations.",
    "tolerance_scatter": "Every sample against the two tolerances that matter most.",
    "tolerance_map": "Median and 99th percentile of the worst path over torque and, in motion, speed.",
    "search_front": "Designs tried, the front that none beats, and its winners beside the nominal design.",
    "search_hypervolume": "How much of the box between best and worst of the front each seed has covered.",
    "sharing_map": "K_gamma of idlers over k_e sigma / W (stiffness of a path, standard deviation of its "
    "lateness, load of all paths), and of inputs over 2 b k / W (backlash, mesh stiffness, load of the "
    "input). Curves: at the torque of the machine; dots: the machine at each of its torques; grey: closed "
    "forms, where they hold.",
    "sensitivity": "Change of K_gamma per micrometre of each error, largest first.",
}
"""Caption of each figure by its name."""

PAPER_NUMBERS = {
    "mode_shapes": 6,
    "mesh_stiffness": 7,
    "stiffness_harmonics": 8,
    "mesh_deflections": 9,
    "pinion_sweep": 10,
    "gear_sweep": 11,
    "mesh_sweep": 12,
}
"""Number of each figure in the reproduced paper, by name; the config gives those of studies."""

KINDS = {"inputs": "input pinions", "idlers": "idler and tail pinions"}
"""Kinds of load-sharing groups in words."""


def caption_of(name: str, values: Mapping[str, Any]) -> str:
    """Return the caption of a figure: that of CAPTIONS, or of a study by its title, or the name in words.

    Where the config reproduces the paper, "Figure n of the paper:" stands before it (PAPER_NUMBERS, or the
    numbers that a study gives).

    Parameters
    ----------
    name : str
        Name of the figure.
    values : Mapping[str, Any]
        Plain values of the config; `studies` and `reproduction` are read.

    Returns
    -------
    str
        The caption.
    """
    words, number = CAPTIONS.get(name, name.replace("_", " ").capitalize()), PAPER_NUMBERS.get(name)
    for study in values["studies"]:
        title = study["title"] or study["name"]
        if name == f"contact_study_{study['name']}":
            words = f"{title}: transmission error, stiffness and radius of the contact over a pitch."
        if name == f"contact_pattern_study_{study['name']}":
            words = f"{title}: contact patterns, largest pressure over a pitch."
        if name == f"study_{study['name']}_forces":
            words = (
                f"{title}: mean fraction of each mesh of its group's load, and largest dynamic force, at the "
                "nominal speed; hollow: motion that does not repeat with the mesh cycle."
            )
        for i, kind in enumerate(KINDS):
            if name == f"study_{study['name']}_{kind}":
                words = f"{title}: load sharing of the {KINDS[kind]}."
                number = study["figures"][i] if study["figures"] and i < 2 else None
    return words if number is None or not values["reproduction"] else f"Figure {number} of the paper: {words}"


FRICTION = "Friction and heat"
"""Title of the chapter on friction."""
CASING = "Casing"
"""Title of the chapter on the casing."""
SHAFTS = "Shafts"
"""Title of the chapter on shafts."""
SHARING = "Load sharing"
"""Title of the chapter on load sharing."""
SHARING_MAP = "Load-sharing map"
"""Title of the chapter on the load-sharing map."""
POSES = "Teeth where forces put them"
"""Title of the chapter on contact in the loaded position."""
STUDIED_CONTACT = "Studies of the contact"
"""Title of the chapter on studies of the contact."""
CHAPTERS: tuple[tuple[str, str, tuple[str, ...]], ...] = (
    (
        "Tooth pair",
        "Generated surfaces, limits and the unloaded pair.",
        ("tooth_pair", "tooth_sections", "separation", "topography_pinion", "topography_face_gear"),
    ),
    (
        "Loaded contact",
        "Unilateral contact of all candidate tooth pairs on the bodies' finite element compliance. Average "
        "stiffness is force over deflection, local stiffness the slope of that curve; both are along the "
        "line of action.",
        ("contact_pattern", "contact_curves", "tooth_errors"),
    ),
    (
        "Strength",
        "Normal stress down the fillets from surface strain gauges on the finite element model, under all "
        "contacts of the tooth and its neighbours. Passage: 0 to 1 while the tooth belongs to the pair in "
        "the middle of the mesh.",
        ("root_stress_passage", "root_stress_along_face", "life", "damage", "stress_over_speed"),
    ),
    (
        FRICTION,
        "Friction of the loaded contact to first order: sliding velocities of the exact flanks, a "
        "coefficient by the model that stands beside each number, flash temperature after Blok and Jaeger, "
        "film after Dowson and Higginson. Windage, churning, squeezing of oil, bearings, seals and the "
        "rolling traction of the film are left out.",
        ("friction_path", "friction_flank", "efficiency_map"),
    ),
    (
        STUDIED_CONTACT,
        "The cases of the studies that change the contact, beside the machine as configured. Shifts of the "
        "contact path are from the machine's own, positive outwards.",
        (),
    ),
    (
        "Mesh stiffness",
        "The mesh stiffness that the lumped model of the machine takes.",
        ("mesh_stiffness", "stiffness_harmonics", "stiffness_load", "mesh_law", "mesh_law_surface"),
    ),
    (
        "Modes",
        "Modes of the machine with constant mean mesh stiffness and without backlash. T: "
        "translation, R: rotation, A: axial motion.",
        (
            *("mode_shapes", "campbell"),
            *("machine_campbell", "body_shapes", "body_waves", "body_campbell"),
        ),
    ),
    (
        "Nominal response and speed sweeps",
        "The state is carried over from speed to speed, upwards and downwards. A class of motion stands "
        "beside every number; where the motion is not periodic the number is an average.",
        (
            *("mesh_deflections", "pinion_sweep", "gear_sweep", "mesh_sweep", "law_sweeps", "law_loads"),
            "waterfall",
            "shaft_orders",
        ),
    ),
    (
        SHAFTS,
        "Pinions on shafts and bearings and masses behind torsional springs, at rest under the mean torques. "
        "x is tangential to the face gear, y along its axis, z along the shaft.",
        ("shafts", "bearings"),
    ),
    (
        CASING,
        "The machine on its casing: forces of the meshes with and without it, modes of both together, and "
        "what its sensors feel, linear about the mean load.",
        ("casing_sharing", "casing_campbell", "casing_acceleration"),
    ),
    (
        POSES,
        "Forces move pinions in their bearings and tilt bodies, and the teeth then meet elsewhere than "
        "assembled. Poses, contact and load sharing are those that belong together, at rest under the mean "
        "torques.",
        ("pose_pattern", "pose_paths"),
    ),
    (
        "Load sharing at rest",
        "Every position of the hunting cycle as one contact problem with gaps, clearances and all errors. "
        "K_gamma is the largest mean of a mesh cycle over the nominal even share; it falls with torque.",
        ("layout", "hunting", "bearing_stiffness", "sensitivity"),
    ),
    (
        SHARING_MAP,
        "The machine at rest under its mean torques, many times over with idlers whose paths are late by "
        "drawn errors. K_gamma is the load of the hardest loaded mesh of a group over the nominal even "
        "share.",
        ("sharing_map",),
    ),
    (
        "Tolerances",
        "The machine as a series of machines: causes with their distributions, sampled by scrambled Sobol "
        "sequences. K_gamma is the largest mean of a mesh cycle over the mesh's nominal even share.",
        ("tolerance_distributions", "tolerance_importance", "tolerance_scatter", "tolerance_map"),
    ),
    (
        "Design search",
        "Designs that no other beats in every objective (NSGA-II), from several seeds. The winners are "
        "computed again at full accuracy.",
        ("search_front", "search_hypervolume"),
    ),
    (
        SHARING,
        "Equations (25) and (26) on magnitudes. Instants at which no path carries load have no coefficient "
        "and are counted as undefined.",
        (),
    ),
)
"""Title, text and figures of each chapter; of studies, figures of the contact go to `STUDIED_CONTACT`, the
others to the last.
"""
