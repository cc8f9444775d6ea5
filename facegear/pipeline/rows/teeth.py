"""Tooth pair: geometry, meshes, compliance, contact, stiffness, friction."""

from facegear.pipeline import arguments, conditions, contact_studies
from facegear.pipeline.rows.common_needs import FLANKS, PAIR, SPEED, STORED_CONTACT
from facegear.pipeline.stage import ComputedValue, Figures, File, From, Needs, Stage, from_stage

MESH: Needs = {**PAIR, "mesh": "mesh"}
"""Needs of a finite-element mesh of the teeth."""
BODY = {"body": "pinion|face_gear"}
"""Wildcard of both bodies."""
CONTACT_POINTS = ComputedValue(contact_studies.contact_points, ("studies",))
"""Points of studies that have a contact analysis of their own."""
STUDIED_CONTACT = {
    "pair": From("geometry", "pair", each_wildcards=contact_studies.contact_cases),
    **{
        kind: From("contact", kind, each_wildcards=contact_studies.contact_cases)
        for kind in ("ltca", "by_torque", "pressure")
    },
}
"""Geometry and contact of the machine and of the studied points."""

ROWS = (
    Stage(
        name="geometry",
        module="teeth",
        title="Tooth geometry",
        needs=PAIR,
        files={
            "pair": File(
                "geometry/pair.json",
                (
                    "design_si",
                    "blanks",
                    "flanks",
                    "radii_mm",
                    "limits_mm",
                    "smallest_gap",
                    "unloaded",
                    "backlash_um",
                ),
            ),
            "flanks": File(
                "geometry/flanks.npz", {"pinion_section": (None, 2), "gear_flank": (None, None, 3)}
            ),
            "contact": File("geometry/contact.npz", {"contour_gap": (None, None), "path_roll": (None,)}),
        },
        figures=Figures(
            draw="facegear.report.figures.teeth:tooth_pair_figures",
            names=("tooth_pair", "tooth_sections", "separation"),
            chapter="teeth",
            upstream=from_stage("geometry", "pair", "flanks", "contact"),
        ),
        condition=conditions.contact,
        priority=65,
    ),
    Stage(
        name="mesh",
        module="tooth_bodies",
        title="Meshes of both bodies",
        needs=MESH,
        files={
            **{
                f"{body}_{kind}": File(f"mesh/{body}.{kind}")
                for body in conditions.BODIES
                for kind in ("msh", "vtu", "inp")
            },
            "quality": File("mesh/quality.csv"),
        },
        condition=conditions.contact,
        memory_mb=2000,
    ),
    Stage(
        name="cad",
        module="tooth_bodies",
        title="Exact teeth for CAD",
        needs={**MESH, "case": ComputedValue(arguments.config_name, ("case",))},
        files={"step": File("cad/{body}.step"), "stl": File("cad/{body}.stl")},
        wildcards=BODY,
    ),
    Stage(
        name="compliance",
        module="tooth_bodies",
        title="Flank compliance",
        needs={
            "tooth_pair": ComputedValue(arguments.without_gaps, ("tooth_pair",)),
            "mesh": "mesh",
            "contact": ComputedValue(arguments.without_loads, ("tooth_pair", "mesh", "contact")),
            "gears": ComputedValue(arguments.gears_with_bodies, ("tooth_pair", "transmission")),
        },
        files={"arrays": File("compliance/{body}.npz", "facegear.contact.gear_flank:ARRAY_SHAPES")},
        wildcards=BODY,
        memory_mb=3000,
        minutes=30,
        priority=90,
    ),
    Stage(
        name="contact",
        title="Loaded tooth contact",
        needs={**PAIR, "contact": "contact"},
        upstream=FLANKS,
        files={
            "ltca": File("contact/ltca.csv", "facegear.contact.pattern:LTCA_FINITE"),
            "ltca_by_flank": File(
                "contact/ltca_by_flank.csv",
                ("torque_n_m", "position", "interference_um"),
                text=("gear", "flank"),
                may_be_empty=True,
            ),
            "by_torque": File(
                "contact/by_torque.csv", ("torque_n_m", "ste_peak_to_peak_um", "path_radius_mm")
            ),
            "by_flank": File("contact/by_flank.csv", ("offset_um", "torque_n_m", "path_radius_mm")),
            "pressure": File("contact/pressure.npz", "facegear.contact.pattern:PRESSURE_ARRAYS"),
            "loads": File("contact/loads.npz", "facegear.contact.pattern:LOAD_ARRAYS"),
            "vtu": File(
                "contact/pressure.vtu", view="facegear.contact.pattern:pressure_surface", of="pressure"
            ),
        },
        figures=Figures(
            draw="facegear.report.figures.contact:contact_figures",
            names=("contact_curves", "contact_pattern"),
            chapter="contact",
            upstream=from_stage("contact", "ltca", "pressure"),
        ),
        condition=conditions.contact,
        memory_mb=4000,
        minutes=30,
        priority=80,
    ),
    Stage(
        name="stiffness",
        title="Mesh stiffness",
        needs={"mesh_stiffness": "mesh_stiffness"},
        upstream={
            "ltca": From("contact", "ltca", when=conditions.computed_stiffness),
            "flanks": From("contact", "ltca_by_flank", when=conditions.computed_stiffness),
        },
        files={
            "tvms": File("stiffness/tvms.csv", ("position", "k_n_per_m", "k_series_n_per_m")),
            "harmonics": File(
                "stiffness/harmonics.csv", "facegear.meshing.stiffness_source:HARMONICS_COLUMNS"
            ),
            "spectrum": File("stiffness/spectrum.csv", ("order", "amplitude_n_per_m")),
        },
        figures=Figures(
            draw="facegear.report.figures.stiffness:stiffness_figures",
            names=("mesh_stiffness", "stiffness_harmonics"),
            chapter="mesh_stiffness",
            upstream=from_stage("stiffness", "tvms", "spectrum"),
        ),
        condition=conditions.always,
        local=True,
        priority=75,
    ),
    Stage(
        name="topography",
        module="teeth",
        title="Flanks as measured, with nominal points and normals",
        needs=PAIR,
        files={
            "points": File(
                "geometry/topography.csv", ("face_mm", "profile_mm", "deviation_um"), text=("tooth", "flank")
            )
        },
        figures=Figures(
            draw="facegear.report.figures.teeth:topography_figures",
            names=("topography_pinion", "topography_face_gear"),
            chapter="teeth",
            upstream=from_stage("topography", "points"),
        ),
        condition=conditions.measured_flanks,
        local=True,
    ),
    Stage(
        name="tooth_errors",
        module="contact",
        title="Teeth that deviate from the others of their gear",
        needs={**PAIR, "torque": "mesh_stiffness.torque_n_m"},
        upstream={**FLANKS, "loads": From("contact", "loads")},
        files={
            "curves": File("contact/tooth_errors.npz", "facegear.contact.pattern:TOOTH_ERROR_ARRAYS"),
            "orders": File(
                "contact/tooth_errors.csv", ("order", "unloaded_um", "loaded_um"), may_be_empty=True
            ),
        },
        figures=Figures(
            draw="facegear.report.figures.teeth:tooth_errors_figures",
            names=("tooth_errors",),
            chapter="contact",
            upstream=from_stage("tooth_errors", "curves", "orders"),
        ),
        condition=conditions.single_teeth,
        local=True,
    ),
    Stage(
        name="mesh_law",
        module="contact",
        title="Load-dependent mesh law",
        needs={**PAIR, "contact": "contact", "mesh_stiffness": "mesh_stiffness"},
        upstream={**FLANKS, **from_stage("contact", "ltca")},
        files={
            "law": File("stiffness/law.npz", "facegear.meshing.fitted_law:LAW_ARRAYS"),
            "levels": File("stiffness/law.csv", "facegear.meshing.fitted_law:LEVEL_COLUMNS"),
        },
        figures=Figures(
            draw="facegear.report.figures.stiffness:mesh_law_figures",
            names=("mesh_law", "mesh_law_surface"),
            chapter="mesh_stiffness",
            upstream=from_stage("mesh_law", "law"),
        ),
        condition=conditions.load_dependent,
        memory_mb=4000,
        minutes=30,
        priority=74,
    ),
    Stage(
        name="pose_surface",
        module="poses",
        title="Contact over pose",
        needs={
            **PAIR,
            "contact": "contact",
            "torque_n_m": "mesh_stiffness.torque_n_m",
            "tilting": ComputedValue(conditions.tilting, ("transmission",)),
        },
        upstream=FLANKS,
        files={
            "surface": File("poses/surface.npz", "facegear.machine.poses.surface:SURFACE_ARRAYS"),
            "nodes": File("poses/nodes.csv", ("unloaded_path_mm", "torque_n_m", "stiffness_n_per_m")),
            "errors": File("poses/errors.csv", ("largest", "rms"), text=("quantity", "left_out")),
        },
        condition=conditions.poses,
        memory_mb=4000,
        minutes=30,
        priority=74,
    ),
    Stage(
        name="load_dependence",
        module="stiffness",
        title="Stiffness against load",
        upstream=from_stage("contact", "ltca"),
        files={"table": File("stiffness/load_dependence.csv", ("definition", "torque_n_m", "mean_n_per_m"))},
        figures=Figures(
            draw="facegear.report.figures.stiffness:load_figures",
            names=("stiffness_load",),
            chapter="mesh_stiffness",
            upstream=from_stage("load_dependence", "table"),
        ),
        condition=conditions.contact,
        local=True,
    ),
    Stage(
        name="contact_studies",
        module="contact",
        title="Contact of the studies' cases side by side",
        needs={"points": CONTACT_POINTS},
        upstream=STUDIED_CONTACT,
        files={"table": File("contact/studies.csv")},
        figures=Figures(
            draw="facegear.report.figures.contact:contact_study_figures",
            names=contact_studies.contact_figures,
            chapter="contact",
            upstream=STUDIED_CONTACT,
            needs={
                "points": CONTACT_POINTS,
                "titles": ComputedValue(contact_studies.contact_titles, ("studies",)),
                "torque": ComputedValue(contact_studies.contact_torque, ("contact", "mesh_stiffness")),
            },
        ),
        condition=contact_studies.contact_studied,
        local=True,
    ),
    Stage(
        name="lubrication",
        module="friction",
        title="Sliding, friction, heat and film of the pair",
        needs={**PAIR, **SPEED, "lubrication": "lubrication"},
        section="lubrication",
        upstream=STORED_CONTACT,
        files={
            "by_torque": File("lubrication/friction.csv", "facegear.lubrication.columns:BY_TORQUE_FINITE"),
            "positions": File("lubrication/positions.csv", "facegear.lubrication.columns:POSITION_FINITE"),
            "limits": File(
                "lubrication/limits.csv", "facegear.lubrication.columns:LIMIT_COLUMNS", may_be_empty=True
            ),
            "map": File("lubrication/map.csv", "facegear.lubrication.columns:MAP_FINITE"),
            "local": File("lubrication/local.npz", "facegear.lubrication.columns:LOCAL_ARRAYS"),
            "excitation": File(
                "lubrication/excitation.csv", "facegear.lubrication.columns:EXCITATION_COLUMNS"
            ),
        },
        figures=Figures(
            draw="facegear.report.figures.friction:figures",
            names=("friction_path", "friction_flank", "efficiency_map"),
            chapter="friction",
            upstream={
                "local": From("lubrication", "local"),
                "pressure": From("contact", "pressure"),
                "map_table": From("lubrication", "map"),
            },
        ),
        condition=conditions.friction,
        local=True,
    ),
)
"""Stages on geometry, meshes, compliance, contact, stiffness, pose surface and friction of the pair."""
