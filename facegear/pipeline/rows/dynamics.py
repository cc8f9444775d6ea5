"""The machine in motion: response at one speed, the speed sweep, and branches of periodic motions."""

from facegear.pipeline import arguments, conditions, contact_studies, machine_conditions
from facegear.pipeline.rows.common_needs import (
    ACCURACY,
    BODIES,
    HARMONICS,
    MACHINE,
    MOTION_INPUTS,
    SPEED,
    SWEEP,
    TOOTH_ERRORS,
)
from facegear.pipeline.stage import NUMBER, ComputedValue, Figures, File, From, Needs, Stage, from_stage

BRANCHES: Needs = {**MACHINE, **SPEED, "branches": "branches"}
"""Needs of the stages that follow branches."""

ROWS = (
    Stage(
        name="dynamics_response",
        module="motion",
        title="Response at the nominal speed",
        machine="machine",
        needs={**MACHINE, **ACCURACY, **SPEED},
        upstream=MOTION_INPUTS,
        files={
            "response": File(
                "dynamics/response.csv", ("mesh_cycle", "mesh", "deflection_um", "elastic_force_n")
            ),
            "spectrum": File("dynamics/spectrum.csv", ("mesh", "order", "amplitude_um")),
            "summary": File("dynamics/summary.csv"),
            "multipliers": File("dynamics/multipliers.csv", may_be_empty=True),
            "bearings": File("dynamics/bearings.csv", ("body", "direction", "static_n", "mean_n", "peak_n")),
        },
        condition=conditions.machine,
    ),
    Stage(
        name="shaft_orders",
        module="machine",
        title="Vibration at the orders of the gears' turns",
        machine="machine",
        needs={
            **MACHINE,
            **SPEED,
            "first_rpm": "dynamics.sweep.from_rpm",
            "last_rpm": "dynamics.sweep.to_rpm",
        },
        upstream={**HARMONICS, **BODIES, **TOOTH_ERRORS},
        files={
            "orders": File(
                "dynamics/shaft_orders.csv",
                "facegear.pipeline.stages.machine:COLUMNS",
                may_be_empty=True,
                text=("turning", "mesh"),
            ),
            "over_speed": File(
                "dynamics/shaft_orders_over_speed.csv",
                "facegear.pipeline.stages.machine:OVER_SPEED",
                may_be_empty=True,
                text=("turning", "mesh"),
            ),
            "excited": File(
                "dynamics/excited.csv",
                ("speed_rpm", "order", "of_mesh", "frequency_hz"),
                may_be_empty=True,
                text=("body", "part"),
            ),
        },
        figures=Figures(
            draw="facegear.report.figures.turning_machine:shaft_orders_figures",
            names=("shaft_orders",),
            chapter="dynamics",
            upstream=from_stage("shaft_orders", "orders", "over_speed"),
        ),
        condition=arguments.turning_errors,
        local=True,
    ),
    Stage(
        name="dynamics_sweep_chunk",
        module="motion",
        title="Speed sweep, one chunk",
        machine="machine",
        needs={**MACHINE, **SWEEP},
        upstream=MOTION_INPUTS,
        files={
            "chunk": File(
                "dynamics/chunks/{direction}_{number}.npz", "facegear.motion.sweeps.whole_sweep:SHAPES"
            )
        },
        wildcards={"direction": "up|down", "number": NUMBER},
        minutes=60,
        priority=60,
    ),
    Stage(
        name="dynamics_sweep",
        module="motion",
        title="Jumps and resonances",
        machine="machine",
        needs={**MACHINE, **SWEEP},
        upstream={
            **MOTION_INPUTS,
            "chunks": From("dynamics_sweep_chunk", "chunk", each_wildcards=arguments.sweep_chunks),
        },
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
            draw="facegear.report.figures.motion:dynamics_figures",
            names=("mesh_deflections", "pinion_sweep", "gear_sweep", "mesh_sweep", "campbell", "waterfall"),
            chapter="dynamics",
            upstream={
                **from_stage("dynamics_response", "response", "spectrum"),
                **from_stage("dynamics_sweep", "sweep", "jumps", "resonances", "waterfall"),
                "frequencies": From("modal", "frequencies"),
            },
            needs={"transmission": "transmission", "pinion_teeth": "tooth_pair.pinion_teeth"},
            memory_mb=1300,
        ),
        condition=conditions.machine,
        memory_mb=1300,
        minutes=60,
        priority=60,
    ),
    Stage(
        name="law_loads",
        module="motion",
        title="Loads in the table of the mesh law",
        upstream={
            **from_stage("mesh_law", "levels"),
            **from_stage("dynamics_response", "response", "summary"),
            **from_stage("dynamics_sweep", "sweep"),
        },
        files={"loads": File("dynamics/law_loads.csv", "facegear.motion.response_tables:LAW_LOAD_COLUMNS")},
        figures=Figures(
            draw="facegear.report.figures.stiffness:law_load_figures",
            names=contact_studies.law_figures,
            chapter="dynamics",
            upstream={
                **from_stage("law_loads", "loads"),
                **from_stage("dynamics_sweep", "sweep"),
                "other_sweeps": From("dynamics_sweep", "sweep", each_wildcards=contact_studies.other_laws),
            },
            needs={"labels": ComputedValue(contact_studies.law_labels, ("studies", "mesh_stiffness"))},
        ),
        condition=conditions.load_dependent_machine,
        local=True,
    ),
    Stage(
        name="branches_starts",
        module="motion",
        title="Where random starts end at one speed",
        machine="machine",
        needs=BRANCHES,
        section="branches",
        upstream=MOTION_INPUTS,
        files={
            "motions": File("branches/starts/{number}.npz", "facegear.motion.branches.motion_arrays:SHAPES")
        },
        wildcards={"number": NUMBER},
        minutes=30,
        priority=50,
    ),
    Stage(
        name="branches",
        module="motion",
        title="Branches of periodic motions",
        machine="machine",
        needs={**BRANCHES, **SWEEP},
        section="branches",
        upstream={
            **MOTION_INPUTS,
            "starts": From("branches_starts", "motions", each_wildcards=arguments.random_starts),
            "chunks": From("dynamics_sweep_chunk", "chunk", each_wildcards=arguments.sweep_chunks),
            "jumps": From("dynamics_sweep", "jumps"),
        },
        files={
            "branches": File("branches/branches.csv", "facegear.motion.branches.tables:BRANCH_FINITE"),
            "ends": File("branches/ends.csv", ("branch", "period", "points"), text=("image_of", "tried")),
            "unfollowed": File("branches/unfollowed.csv", ("period", "origin"), may_be_empty=True),
            "multipliers": File("branches/multipliers.csv", ("branch", "speed_rpm", "real", "imaginary")),
            "special": File(
                "branches/special_points.csv",
                ("branch", "period", "kind", "speed_rpm", "arc"),
                may_be_empty=True,
                text=("meshes", "edge", "proof"),
            ),
            "coexistence": File(
                "branches/coexistence.csv", ("speed_rpm", "fraction", "error"), text=("branch", "motion")
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
            "orbits": File(
                "branches/special_points.npz", "facegear.motion.branches.motion_arrays:SPECIAL_SHAPES"
            ),
        },
        condition=machine_conditions.branches,
        memory_mb=1300,
        minutes=60,
        priority=50,
    ),
    Stage(
        name="branches_loci",
        module="motion",
        title="Loci of folds and period doublings",
        machine="machine",
        needs=BRANCHES,
        section="branches",
        upstream={**MOTION_INPUTS, "orbits": From("branches", "orbits")},
        files={
            "loci": File(
                "branches/loci.csv",
                ("locus", "kind", "factor", "speed_rpm"),
                may_be_empty=True,
                text=("corner",),
            )
        },
        figures=Figures(
            draw="facegear.report.figures.branches:figures",
            names=("branches", "branch_loci", "branch_fractions", "branch_multipliers"),
            chapter="branches",
            upstream={
                **from_stage("branches", "branches", "special", "coexistence"),
                "circle": From("branches", "multipliers"),
                "curves": From("branches_loci", "loci"),
                "sweep": From("dynamics_sweep", "sweep"),
            },
            needs={**SPEED, "pinions": "transmission.pinions"},
        ),
        condition=machine_conditions.branches,
        minutes=60,
    ),
)
"""Stages on response, sweep, orders of the turns, loads of mesh laws, and branches of periodic motions."""
