"""The table of stages: what each takes, what it writes, when it is made. All else that names them follows.

Columns that a reader asks for are given by name, so that reading this table loads nothing that computes.
"""

from facegear.config.lumped_model import TEETH
from facegear.pipeline import asked, studies
from facegear.pipeline.stage import NUMBER, Computed, Figures, File, From, Need, Stage

Needs = dict[str, Need]

PAIR: Needs = {"tooth_pair": "tooth_pair"}
MESH: Needs = {**PAIR, "mesh": "mesh"}
MACHINE: Needs = {"transmission": "transmission", "teeth": tuple(f"tooth_pair.{key}" for key in TEETH)}
SPEED: Needs = {"speed_rpm": "dynamics.speed_rpm"}
ACCURACY: Needs = {"accuracy": "dynamics.accuracy"}
SWEEP: Needs = {"sweep": "dynamics.sweep"}
BRANCHES: Needs = {**MACHINE, **SPEED, "branches": "branches"}
SHARING: Needs = {**MACHINE, **ACCURACY, **SPEED, "options": "load_sharing"}
CAUSES = tuple(f"tolerances.{key}" for key in ("causes", "correlations", "model", "seed", "hunting_cycles"))
SAMPLED: Needs = {
    **SHARING,
    "tolerances": CAUSES,
    "pair": Computed(asked.pair_where(asked.sampled_contact), asked.PAIR_SECTIONS),
}
SEARCHED: Needs = {
    **PAIR,
    **ACCURACY,
    **SPEED,
    "transmission": "transmission",
    "options": "load_sharing",
    "search": "search",
    "tolerances": "tolerances",
    "pair": Computed(asked.pair_where(asked.searched_contact), asked.PAIR_SECTIONS),
}

BODY = {"body": "pinion|face_gear"}
FLANKS = {name: From("compliance", "arrays", where={"body": name}) for name in asked.BODIES}
LTCA = From("contact", "ltca")
PRESSED = {"ltca": LTCA, "pressure": From("contact", "pressure")}
STRESS = {"stress": From("root_stress", "stress"), "by_flank": From("contact", "by_flank")}
GEARS = {"gears": Computed(asked.gears_met, ("transmission",))}
HARMONICS = {"harmonics": From("stiffness", "harmonics")}
SAMPLED_FROM = {
    **HARMONICS,
    "flanks": From("compliance", "arrays", each=asked.both_bodies, when=asked.sampled_contact),
}
SEARCHED_FROM = {
    **HARMONICS,
    "flanks": From("compliance", "arrays", each=asked.both_bodies, when=asked.searched_contact),
}
STUDIED_CONTACT = {
    "pair": From("geometry", "pair", each=studies.contact_cases),
    **{kind: From("contact", kind, each=studies.contact_cases) for kind in ("ltca", "by_torque", "pressure")},
}
CONTACT_POINTS = Computed(studies.contact_points, ("studies",))
CASE_COLUMNS = ("study", "point", "label")

ALL = (
    Stage(
        name="geometry",
        title="Tooth geometry",
        needs=PAIR,
        files={
            "pair": File(
                "geometry/pair.json",
                ("design_si", "radii_mm", "limits_mm", "smallest_gap", "unloaded", "backlash_um"),
            ),
            "flanks": File(
                "geometry/flanks.npz", {"pinion_section": (None, 2), "gear_flank": (None, None, 3)}
            ),
            "contact": File("geometry/contact.npz", {"contour_gap": (None, None), "path_roll": (None,)}),
        },
        figures=Figures(
            draw="facegear.plots.tooth_pair:figures",
            names=("tooth_pair", "tooth_sections", "separation"),
            chapter="teeth",
            upstream={name: From("geometry", name) for name in ("pair", "flanks", "contact")},
        ),
        asked=asked.contact,
    ),
    Stage(
        name="mesh",
        title="Meshes of both bodies",
        needs=MESH,
        files={
            **{
                f"{body}_{kind}": File(f"mesh/{body}.{kind}")
                for body in asked.BODIES
                for kind in ("msh", "vtu", "inp")
            },
            "quality": File("mesh/quality.csv"),
        },
        asked=asked.contact,
        memory_mb=2000,
    ),
    Stage(
        name="cad",
        title="Exact teeth for CAD",
        needs=MESH,
        files={"step": File("cad/{body}.step"), "stl": File("cad/{body}.stl")},
        wildcards=BODY,
    ),
    Stage(
        name="compliance",
        title="Flank compliance",
        needs={
            "tooth_pair": Computed(asked.without_gaps, ("tooth_pair",)),
            "mesh": "mesh",
            "contact": Computed(asked.without_loads, ("tooth_pair", "mesh", "contact")),
        },
        files={"arrays": File("compliance/{body}.npz", "facegear.contact.gear_flank:STORED")},
        wildcards=BODY,
        memory_mb=4000,
        minutes=30,
        priority=90,
    ),
    Stage(
        name="contact",
        title="Loaded tooth contact",
        needs={**PAIR, "contact": "contact"},
        upstream=FLANKS,
        files={
            "ltca": File("contact/ltca.csv", "facegear.contact.columns:LTCA_FINITE"),
            "by_torque": File(
                "contact/by_torque.csv", ("torque_n_m", "ste_peak_to_peak_um", "path_radius_mm")
            ),
            "by_flank": File("contact/by_flank.csv", ("offset_um", "torque_n_m", "path_radius_mm")),
            "pressure": File("contact/pressure.npz", "facegear.contact.columns:PRESSURE_ARRAYS"),
            "loads": File("contact/loads.npz", "facegear.contact.columns:LOAD_ARRAYS"),
            "vtu": File(
                "contact/pressure.vtu", view="facegear.contact.pattern:pressure_surface", of="pressure"
            ),
        },
        figures=Figures(
            draw="facegear.plots.contact:figures",
            names=("contact_curves", "contact_pattern"),
            chapter="contact",
            upstream={"ltca": LTCA, "pressure": From("contact", "pressure")},
        ),
        asked=asked.contact,
        memory_mb=4000,
        minutes=30,
        priority=80,
    ),
    Stage(
        name="root_stress",
        title="Root stress of both gears",
        upstream={**FLANKS, "loads": From("contact", "loads")},
        files={
            "summary": File("strength/root_stress.csv", "facegear.strength.columns:ROOT_STRESS_FINITE"),
            "passage": File("strength/passage.csv", "facegear.strength.columns:PASSAGE_COLUMNS"),
            "along_face": File("strength/along_face.csv", "facegear.strength.columns:ALONG_FACE_COLUMNS"),
            "by_flank": File(
                "strength/root_stress_by_flank.csv", "facegear.strength.columns:ROOT_STRESS_BY_FLANK_FINITE"
            ),
            "stress": File("strength/root_stress.npz", "facegear.strength.columns:ROOT_STRESS_ARRAYS"),
            "vtu": File(
                "strength/root_stress.vtu",
                view="facegear.strength.fillet_surface:stress_surface",
                of="stress",
            ),
        },
        figures=Figures(
            draw="facegear.plots.strength:root_figures",
            names=("root_stress_passage", "root_stress_along_face"),
            chapter="strength",
            upstream={name: From("root_stress", name) for name in ("passage", "along_face")},
        ),
        asked=asked.root_stress,
    ),
    Stage(
        name="stiffness",
        title="Mesh stiffness",
        needs={"mesh_stiffness": "mesh_stiffness"},
        upstream={"ltca": From("contact", "ltca", when=asked.computed_stiffness)},
        files={
            "tvms": File("stiffness/tvms.csv", ("position", "k_n_per_m", "k_series_n_per_m")),
            "harmonics": File("stiffness/harmonics.csv", "facegear.stiffness.tables:HARMONICS_COLUMNS"),
            "spectrum": File("stiffness/spectrum.csv", ("order", "amplitude_n_per_m")),
        },
        figures=Figures(
            draw="facegear.plots.stiffness:figures",
            names=("mesh_stiffness", "stiffness_harmonics"),
            chapter="mesh_stiffness",
            upstream={name: From("stiffness", name) for name in ("tvms", "spectrum")},
        ),
        asked=asked.always,
        local=True,
        priority=75,
    ),
    Stage(
        name="load_dependence",
        title="Stiffness against load",
        upstream={"ltca": LTCA},
        files={"table": File("stiffness/load_dependence.csv", ("definition", "torque_n_m", "mean_n_per_m"))},
        figures=Figures(
            draw="facegear.plots.stiffness:load_figures",
            names=("stiffness_load",),
            chapter="mesh_stiffness",
            upstream={"table": From("load_dependence", "table")},
        ),
        asked=asked.contact,
        local=True,
    ),
    Stage(
        name="contact_studies",
        title="Contact of the studies' cases side by side",
        needs={"points": CONTACT_POINTS},
        upstream=STUDIED_CONTACT,
        files={"table": File("contact/studies.csv")},
        figures=Figures(
            draw="facegear.plots.contact_study:figures",
            names=studies.contact_figures,
            chapter="contact",
            upstream=STUDIED_CONTACT,
            needs={
                "points": CONTACT_POINTS,
                "titles": Computed(studies.contact_titles, ("studies",)),
                "torque": Computed(studies.contact_torque, ("contact", "mesh_stiffness")),
            },
        ),
        asked=studies.contact_studied,
        local=True,
    ),
    Stage(
        name="ratings",
        title="Gear ratio, speeds, torques and powers",
        needs={**MACHINE, **SPEED},
        upstream=HARMONICS,
        files={name: File(f"machine/{name}.csv") for name in ("ratings", "bodies", "meshes")},
        asked=asked.machine,
        local=True,
    ),
    Stage(
        name="modal",
        title="Natural frequencies and mode shapes",
        needs={
            **MACHINE,
            "mean_stiffness": "mesh_stiffness.mean_n_per_m",
            "source": "mesh_stiffness.source",
            "definition": "modal.stiffness",
        },
        upstream={"harmonics": From("stiffness", "harmonics", when=asked.modes_from_contact)},
        files={
            "frequencies": File("modal/frequencies.csv", ("order", "frequency_hz", "symbols", "class")),
            "shapes": File("modal/shapes.csv", ("order", "body", "dof", "relative")),
            "contacts": File("modal/contacts.csv", ("contact", "state", "stiffness_n_per_m")),
        },
        figures=Figures(
            draw="facegear.plots.modal:figures",
            names=("mode_shapes",),
            chapter="modes",
            upstream={name: From("modal", name) for name in ("frequencies", "shapes")},
        ),
        asked=asked.machine,
        local=True,
    ),
    Stage(
        name="machine_code",
        title="Machine code of the time integration",
        folder="dynamics",
        asked=asked.machine,
        priority=100,
    ),
    Stage(
        name="dynamics_response",
        title="Response at the nominal speed",
        needs={**MACHINE, **ACCURACY, **SPEED},
        upstream=HARMONICS,
        files={
            "response": File(
                "dynamics/response.csv", ("mesh_cycle", "mesh", "deflection_um", "elastic_force_n")
            ),
            "spectrum": File("dynamics/spectrum.csv", ("mesh", "order", "amplitude_um")),
            "summary": File("dynamics/summary.csv"),
            "multipliers": File("dynamics/multipliers.csv", may_be_empty=True),
            "bearings": File("dynamics/bearings.csv", ("body", "direction", "static_n", "mean_n", "peak_n")),
        },
        asked=asked.machine,
    ),
    Stage(
        name="dynamics_sweep_chunk",
        title="Speed sweep, one chunk",
        needs={**MACHINE, **SWEEP},
        upstream=HARMONICS,
        files={
            "chunk": File(
                "dynamics/chunks/{direction}_{number}.npz", "facegear.dynamics.sweeps.stored:SHAPES"
            )
        },
        wildcards={"direction": "up|down", "number": NUMBER},
        minutes=60,
        priority=60,
    ),
    Stage(
        name="dynamics_sweep",
        title="Jumps and resonances",
        needs={**MACHINE, **SWEEP},
        upstream={**HARMONICS, "chunks": From("dynamics_sweep_chunk", "chunk", each=asked.sweep_chunks)},
        files={
            "sweep": File(
                "dynamics/sweep.csv",
                ("direction", "speed_rpm", "quantity", "body_or_mesh", "value", "class"),
            ),
            "jumps": File(
                "dynamics/jumps.csv",
                ("direction", "speed_before_rpm", "speed_after_rpm", "class_before", "order"),
                may_be_empty=True,
            ),
            "resonances": File(
                "dynamics/resonances.csv", ("speed_rpm", "resonance", "order"), may_be_empty=True
            ),
            "seams": File("dynamics/seams.csv", may_be_empty=True),
            "waterfall": File("dynamics/waterfall.npz", {"orders": (None,)}),
        },
        figures=Figures(
            draw="facegear.plots.dynamics:figures",
            names=("mesh_deflections", "pinion_sweep", "gear_sweep", "mesh_sweep", "campbell", "waterfall"),
            chapter="dynamics",
            upstream={
                **{name: From("dynamics_response", name) for name in ("response", "spectrum")},
                **{
                    name: From("dynamics_sweep", name)
                    for name in ("sweep", "jumps", "resonances", "waterfall")
                },
                "frequencies": From("modal", "frequencies"),
            },
            needs={"transmission": "transmission", "pinion_teeth": "tooth_pair.pinion_teeth", **SPEED},
            memory_mb=1300,
        ),
        asked=asked.machine,
        memory_mb=1300,
        minutes=60,
        priority=60,
    ),
    Stage(
        name="branches_starts",
        title="Where random starts end at one speed",
        needs=BRANCHES,
        section="branches",
        upstream=HARMONICS,
        files={"found": File("branches/starts/{number}.npz", "facegear.dynamics.branches.stored:SHAPES")},
        wildcards={"number": NUMBER},
        minutes=30,
        priority=50,
    ),
    Stage(
        name="branches",
        title="Branches of periodic motions",
        needs={**BRANCHES, **SWEEP},
        section="branches",
        upstream={
            **HARMONICS,
            "starts": From("branches_starts", "found", each=asked.random_starts),
            "chunks": From("dynamics_sweep_chunk", "chunk", each=asked.sweep_chunks),
            "jumps": From("dynamics_sweep", "jumps"),
        },
        files={
            "branches": File("branches/branches.csv", "facegear.dynamics.branches.columns:BRANCH_FINITE"),
            "ends": File("branches/ends.csv", ("branch", "period", "points"), text=("tried",)),
            "unfollowed": File("branches/unfollowed.csv", ("period", "origin"), may_be_empty=True),
            "multipliers": File("branches/multipliers.csv", ("branch", "speed_rpm", "real", "imaginary")),
            "special": File(
                "branches/special_points.csv",
                ("branch", "period", "kind", "speed_rpm", "arc"),
                may_be_empty=True,
                text=("meshes", "edge", "proof"),
            ),
            "coexistence": File(
                "branches/coexistence.csv", ("speed_rpm", "share", "error"), text=("branch", "motion")
            ),
            "ranges": File(
                "branches/ranges.csv", ("from_rpm", "to_rpm"), may_be_empty=True, text=("branches",)
            ),
            "margins": File("branches/margins.csv", ("branch", "parameter", "margin"), may_be_empty=True),
            "swept": File(
                "branches/swept.csv", ("direction", "period"), may_be_empty=True, text=("branch", "note")
            ),
            "jumps": File(
                "branches/jumps.csv",
                ("direction", "speed_before_rpm", "speed_after_rpm"),
                may_be_empty=True,
                text=("class_before", "branch", "kind", "note"),
            ),
            "orbits": File("branches/special_points.npz", "facegear.dynamics.branches.stored:SPECIAL_SHAPES"),
        },
        asked=asked.branches,
        memory_mb=1300,
        minutes=60,
        priority=50,
    ),
    Stage(
        name="branches_loci",
        title="Loci of folds and period doublings",
        needs=BRANCHES,
        section="branches",
        upstream={**HARMONICS, "orbits": From("branches", "orbits")},
        files={
            "loci": File(
                "branches/loci.csv",
                ("locus", "kind", "factor", "speed_rpm"),
                may_be_empty=True,
                text=("corner",),
            )
        },
        figures=Figures(
            draw="facegear.plots.branches:figures",
            names=("branches", "branch_loci", "branch_shares", "branch_multipliers"),
            chapter="branches",
            upstream={
                **{name: From("branches", name) for name in ("branches", "special", "coexistence")},
                "circle": From("branches", "multipliers"),
                "curves": From("branches_loci", "loci"),
                "sweep": From("dynamics_sweep", "sweep"),
            },
            needs={**SPEED, "pinions": "transmission.pinions"},
        ),
        asked=asked.branches,
        minutes=60,
    ),
    Stage(
        name="load_sharing",
        title="Load sharing at the nominal speed",
        needs=SHARING,
        upstream=HARMONICS,
        files={
            "curve": File("load_sharing/nominal.csv", ("cycle_fraction",), may_be_empty=True),
            "summary": File("load_sharing/nominal_summary.csv", ("group", "kind"), may_be_empty=True),
        },
        asked=asked.shares_load,
    ),
    Stage(
        name="load_sharing_summary",
        title="Load sharing of all studies",
        needs={"points": Computed(studies.points, ("studies",))},
        upstream={
            "summaries": From("load_sharing", "summary", each=studies.nominal_and_every_point),
            "curves": From("load_sharing", "curve", each=studies.every_point),
        },
        files={
            "summary": File("load_sharing/summary.csv", ("group", "kind"), text=CASE_COLUMNS),
            "studies": File(
                "load_sharing/{each}.csv", ("cycle_fraction",), text=CASE_COLUMNS, each=studies.names
            ),
        },
        figures=Figures(
            draw="facegear.plots.load_sharing:figures",
            names=studies.sharing_figures,
            chapter="load_sharing",
            upstream={name: From("load_sharing_summary", name) for name in ("studies", "summary")},
            needs={
                "titles": Computed(studies.titles, ("studies",)),
                "captions": Computed(
                    studies.captions, ("studies", "tooth_pair", "transmission", "mesh_stiffness")
                ),
                "kinds": Computed(studies.kinds, ("transmission", "tooth_pair")),
            },
        ),
        asked=asked.shares_load,
        local=True,
    ),
    Stage(
        name="load_sharing_reference",
        title="Load sharing at rest, running slowly and over a range of speeds",
        needs={
            **MACHINE,
            **ACCURACY,
            "range_accuracy": "dynamics.sweep.accuracy",
            "options": "load_sharing",
        },
        upstream=HARMONICS,
        files={
            "reference": File("load_sharing/reference.csv"),
            "speeds": File("load_sharing/speed_range.csv"),
        },
        asked=asked.shares_load,
        minutes=15,
    ),
    Stage(
        name="hunting",
        title="Quasi-static load sharing over the hunting cycle",
        needs={**MACHINE, "positions": "load_sharing.hunting_positions"},
        upstream=HARMONICS,
        files={
            "meshes": File(
                "load_sharing/hunting_meshes.csv",
                ("mean_n", "drive_share", "back_share"),
                text=("mesh", "group"),
            ),
            "groups": File("load_sharing/hunting_groups.csv", ("torque_n_m",), text=("group", "kind")),
            "bearings": File(
                "load_sharing/bearings.csv", ("body", "mean_x_n", "mean_y_n", "mean_z_n"), text=("body",)
            ),
            "cycles": File("load_sharing/hunting_cycles.csv", ("cycle",)),
            "scan": File(
                "load_sharing/bearing_stiffness.csv",
                ("stiffness_n_per_m", "k_gamma"),
                text=("kinematics", "varied", "kind"),
            ),
            "sensitivity": File("load_sharing/sensitivity.csv", ("per_um",), text=("error", "group")),
        },
        figures=Figures(
            draw="facegear.plots.hunting:figures",
            names=("layout", "hunting", "bearing_stiffness", "sensitivity"),
            chapter="load_sharing",
            upstream={
                name: From("hunting", name)
                for name in ("meshes", "groups", "bearings", "cycles", "scan", "sensitivity")
            },
            needs=MACHINE,
        ),
        asked=asked.hunting,
    ),
    Stage(
        name="following",
        title="Load sharing of the running machine while its runouts turn",
        needs={
            **MACHINE,
            **ACCURACY,
            **SPEED,
            "positions": "load_sharing.hunting_positions",
            "cycles": "load_sharing.followed_cycles",
        },
        upstream=HARMONICS,
        files={
            "groups": File("load_sharing/following_groups.csv"),
            "meshes": File("load_sharing/following_meshes.csv"),
        },
        asked=asked.following,
    ),
    Stage(
        name="duty_loads",
        title="Loads of the running machine in every bin of the duty cycle",
        needs={**MACHINE, **ACCURACY, "strength": "strength"},
        section="strength",
        upstream=HARMONICS,
        files={
            "duty_loads": File("strength/duty_loads.csv"),
            "duty_spectrum": File(
                "strength/duty_spectrum.csv", "facegear.strength.columns:DUTY_SPECTRUM_COLUMNS"
            ),
        },
    ),
    Stage(
        name="lubrication",
        title="Sliding, friction, heat and film of the pair",
        needs={**PAIR, **SPEED, "lubrication": "lubrication"},
        section="lubrication",
        upstream=PRESSED,
        files={
            "by_torque": File("lubrication/friction.csv", "facegear.lubrication.columns:BY_TORQUE_FINITE"),
            "positions": File("lubrication/positions.csv", "facegear.lubrication.columns:POSITION_FINITE"),
            "limits": File(
                "lubrication/limits.csv", "facegear.lubrication.columns:LIMIT_COLUMNS", may_be_empty=True
            ),
            "map": File("lubrication/map.csv", "facegear.lubrication.columns:MAP_FINITE"),
            "local": File("lubrication/local.npz", "facegear.lubrication.columns:LOCAL_ARRAYS"),
        },
        figures=Figures(
            draw="facegear.plots.friction:figures",
            names=("friction_path", "friction_flank", "efficiency_map"),
            chapter="friction",
            upstream={
                "local": From("lubrication", "local"),
                "pressure": From("contact", "pressure"),
                "map_table": From("lubrication", "map"),
            },
        ),
        asked=asked.friction,
        local=True,
    ),
    Stage(
        name="machine_loss",
        title="Loss and heat of the machine",
        needs={**PAIR, **MACHINE, **SPEED, "lubrication": "lubrication", "strength": "strength"},
        section="lubrication",
        upstream={
            **PRESSED,
            **HARMONICS,
            "duty_loads": From("duty_loads", "duty_loads", when=asked.machine_loads),
        },
        files={
            "meshes": File("lubrication/mesh_losses.csv", "facegear.lubrication.columns:MESH_FINITE"),
            "bodies": File("lubrication/body_heat.csv", ("bin", "speed_rpm", "heat_w"), text=("body",)),
            "machine": File("lubrication/machine_loss.csv", ("bin", "speed_rpm", "power_in_w", "loss_w")),
        },
        asked=asked.machine_friction,
        local=True,
    ),
    Stage(
        name="rating",
        title="Safety and life of the tooth pair",
        needs={
            **PAIR,
            "strength": "strength",
            **GEARS,
        },
        section="strength",
        upstream={
            **STRESS,
            "duty_spectrum": From("duty_loads", "duty_spectrum", when=asked.machine_loads),
        },
        files={
            "safety": File("strength/safety.csv", "facegear.strength.columns:SAFETY_FINITE"),
            "rating": File("strength/rating.csv", "facegear.strength.columns:RATING_FINITE"),
            "damage": File("strength/damage.csv", "facegear.strength.columns:DAMAGE_FINITE"),
            "curves": File("strength/curves.csv", "facegear.strength.columns:CURVE_COLUMNS"),
        },
        figures=Figures(
            draw="facegear.plots.strength:rating_figures",
            names=("life", "damage"),
            chapter="strength",
            upstream={name: From("rating", name) for name in ("rating", "damage", "curves")},
        ),
        asked=asked.strength,
    ),
    Stage(
        name="dynamic_root_stress",
        title="Root stress of the running machine",
        needs={**PAIR, "transmission": "transmission", **GEARS},
        upstream={"response": From("dynamics_response", "response"), **STRESS},
        files={
            "dynamic_stress": File(
                "strength/dynamic_stress.csv", "facegear.strength.columns:DYNAMIC_STRESS_FINITE"
            )
        },
        asked=asked.machine_stress,
    ),
    Stage(
        name="stress_over_speed",
        title="Root stress and pressure over the speed range",
        needs={**MACHINE, **PAIR, **GEARS},
        upstream={
            "sweep": From("dynamics_sweep", "sweep"),
            "branches": From("branches", "branches", when=asked.branches),
            **STRESS,
            **HARMONICS,
        },
        files={
            "stress_over_speed": File(
                "strength/stress_over_speed.csv", "facegear.strength.columns:STRESS_OVER_SPEED_FINITE"
            )
        },
        figures=Figures(
            draw="facegear.plots.stress_over_speed:figures",
            names=("stress_over_speed",),
            chapter="strength",
            upstream={"table": From("stress_over_speed", "stress_over_speed")},
            needs=SPEED,
        ),
        asked=asked.machine_stress,
    ),
    Stage(
        name="tolerances_chunk",
        title="Samples of the machine with its tolerances",
        needs=SAMPLED,
        section="tolerances",
        upstream=SAMPLED_FROM,
        files={"chunk": File("tolerances/chunks/{design}_{first}_{last}.parquet")},
        wildcards={"design": "samples|indices", "first": NUMBER, "last": NUMBER},
        resumable="chunk",
    ),
    Stage(
        name="tolerances",
        title="Percentiles, shares and Sobol indices",
        needs={"tolerances": "tolerances"},
        section="tolerances",
        upstream={
            design: From("tolerances_chunk", "chunk", each=asked.tolerance_chunks(design))
            for design in ("samples", "indices")
        },
        files={
            "samples": File("tolerances/samples.parquet", ("sample", "error")),
            "percentiles": File(
                "tolerances/percentiles.csv",
                ("percentile", "value"),
                may_be_empty=True,
                text=("quantity",),
            ),
            "shares": File("tolerances/shares.csv", ("share",)),
            "importance": File("tolerances/importance.csv", text=("quantity", "cause")),
            "indices": File("tolerances/indices.csv", may_be_empty=True, text=("quantity", "cause")),
            "sampling": File("tolerances/sampling.csv", may_be_empty=True),
        },
        figures=Figures(
            draw="facegear.plots.tolerances:figures",
            names=("tolerance_distributions", "tolerance_importance", "tolerance_scatter"),
            chapter="tolerances",
            upstream={
                name: From("tolerances", name) for name in ("samples", "percentiles", "importance", "indices")
            },
        ),
        asked=asked.tolerances,
        local=True,
    ),
    Stage(
        name="tolerances_map",
        title="Percentiles over torque and speed",
        needs={**SAMPLED, "tolerances": (*CAUSES, "tolerances.confidence", "tolerances.load_map")},
        section="tolerances",
        upstream=SAMPLED_FROM,
        files={
            "load_map": File(
                "tolerances/load_map.csv",
                ("torque_factor", "speed_rpm", "percentile", "value"),
                may_be_empty=True,
                text=("quantity",),
            ),
            "load_shares": File("tolerances/load_shares.csv", ("torque_factor", "speed_rpm", "share")),
        },
        figures=Figures(
            draw="facegear.plots.tolerances:map_figures",
            names=("tolerance_map",),
            chapter="tolerances",
            upstream={"load_map": From("tolerances_map", "load_map")},
        ),
        asked=asked.load_map,
        resumable="load_map",
        minutes=240,
    ),
    Stage(
        name="search_island",
        title="Evolution of designs from one seed",
        needs=SEARCHED,
        section="search",
        upstream=SEARCHED_FROM,
        files={"designs": File("search/islands/{seed}.parquet")},
        wildcards={"seed": NUMBER},
        resumable="designs",
        minutes=240,
    ),
    Stage(
        name="search",
        title="Front of all islands, and its winners at full accuracy",
        needs=SEARCHED,
        section="search",
        upstream={**SEARCHED_FROM, "islands": From("search_island", "designs", each=asked.islands)},
        files={
            "designs": File("search/designs.parquet", ("generation", "seed", "error")),
            "front": File("search/front.csv", may_be_empty=True),
            "hypervolume": File("search/hypervolume.csv", ("hypervolume",), may_be_empty=True),
            "winners": File("search/winners.csv", ("design",), text=("design",)),
        },
        figures=Figures(
            draw="facegear.plots.search:figures",
            names=("search_front", "search_hypervolume"),
            chapter="search",
            upstream={name: From("search", name) for name in ("designs", "front", "hypervolume", "winners")},
            needs={"objectives": "search.objectives"},
        ),
        asked=asked.search,
        minutes=60,
    ),
)

STAGES = {stage.name: stage for stage in ALL}
"""By name, in the order in which a case goes through them."""
