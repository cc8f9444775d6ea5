"""The machine in motion: response at one speed, and the speed sweep."""

from facegear.pipeline import arguments, conditions, contact_studies
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
from facegear.pipeline.stage import NUMBER, ComputedValue, Figures, File, From, Stage, from_stage

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
)
"""Stages on response, sweep, orders of the turns and the loads of mesh laws."""
