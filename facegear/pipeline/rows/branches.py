"""Branches of periodic motions."""

from facegear.pipeline import arguments, machine_conditions
from facegear.pipeline.rows.common_needs import MACHINE, MOTION_INPUTS, SPEED, SWEEP
from facegear.pipeline.stage import NUMBER, Figures, File, From, Needs, Stage, from_stage

BRANCHES: Needs = {**MACHINE, **SPEED, "branches": "branches"}
"""Needs of the stages that follow branches."""

ROWS = (
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
"""Stages that follow branches of periodic motions."""
