"""Captions of the figures and texts of the chapters of a case's report."""

CAPTIONS = {
    "tooth_pair": "Pinion and face gear in mesh; both tooth sections with limits; contact path, separation.",
    "contact_curves": "Static transmission error, stiffness and load share against position.",
    "contact_pattern": "Largest pressure each point of the flank sees over a pitch.",
    "fig07": "Figure 7: mesh stiffness over a mesh period, and its Fourier series.",
    "fig08": "Figure 8: amplitudes of the mesh stiffness harmonics.",
    "stiffness_load": "Mean stiffness and its harmonics against load.",
    "fig06": "Figure 6: typical mode shapes.",
    "campbell": "Campbell diagram: natural frequencies against multiples of the mesh frequency.",
    "fig09": "Figure 9: mesh deflections at the nominal speed and their spectra.",
    "fig10": "Figure 10: RMS of the pinions' translations over speed.",
    "fig11": "Figure 11: RMS of the face gears' translations over speed.",
    "fig12": "Figure 12: RMS of the mesh deflections, speed rising and falling; ticks mark jumps.",
    "waterfall": "Spectra over speed.",
    "layout": "The machine to scale: directions of rotation, mean forces of meshes and on bearings, at rest.",
    "hunting": "Share of each mesh in its group's load over the hunting cycle, quasi-static.",
    "bearing_stiffness": "K_gamma against the bearing stiffness of inputs and idlers, both kinematics.",
    "sensitivity": "Change of K_gamma per micrometre of each error, largest first.",
}

CHAPTERS: tuple[tuple[str, str, tuple[str, ...]], ...] = (
    ("Tooth pair", "Generated surfaces, limits and the unloaded pair.", ("tooth_pair",)),
    (
        "Loaded contact",
        "Unilateral contact of all candidate tooth pairs on the bodies' finite element compliance. Average "
        "stiffness is force over deflection, local stiffness the slope of that curve; both are along the "
        "line of action.",
        ("contact_pattern", "contact_curves"),
    ),
    ("Mesh stiffness", "What the lumped model is given.", ("fig07", "fig08", "stiffness_load")),
    (
        "Modes",
        "Constant mean stiffness, no backlash. T translation, R rotation, A axial.",
        ("fig06", "campbell"),
    ),
    (
        "Nominal response and speed sweeps",
        "The state is carried over from speed to speed, upwards and downwards. A class of motion stands "
        "beside every number; where the motion is not periodic the number is an average.",
        ("fig09", "fig10", "fig11", "fig12", "waterfall"),
    ),
    (
        "Load sharing at rest",
        "Every position of the hunting cycle as one contact problem with gaps, clearances and all errors. "
        "K_gamma is a path's largest load over an even share of the group's mean; it falls with torque.",
        ("layout", "hunting", "bearing_stiffness", "sensitivity"),
    ),
    (
        "Load sharing",
        "Equations (25) and (26) on magnitudes. Instants at which no path carries load have no coefficient "
        "and are counted as undefined.",
        (),
    ),
)
"""Title, text and figures of each chapter; figures of studies go to the last."""
