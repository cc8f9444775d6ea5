"""Stages of load sharing among meshes."""

from facegear.pipeline import arguments, machine_conditions, studies
from facegear.pipeline.rows.common_needs import (
    ACCURACY,
    BODIES,
    HARMONICS,
    MACHINE,
    MOTION_INPUTS,
    OPTIONS,
    SHARING,
    SPEED,
    TOOTH_ERRORS,
)
from facegear.pipeline.stage import ComputedValue, Figures, File, From, Stage, from_stage

CASE_COLUMNS = ("study", "point", "label")
"""Columns that identify a point of a study."""

ROWS = (
    Stage(
        name="load_sharing",
        module="sharing",
        title="Load sharing at the nominal speed",
        machine="machine",
        needs=SHARING,
        upstream=MOTION_INPUTS,
        files={
            "curve": File("load_sharing/nominal.csv", ("cycle_fraction",), may_be_empty=True),
            "summary": File("load_sharing/nominal_summary.csv", ("group", "kind"), may_be_empty=True),
            "forces": File("load_sharing/forces.csv", ("mean_n", "largest_n"), text=("mesh", "group")),
        },
        condition=machine_conditions.has_groups_of_pinions,
        together=8,
    ),
    Stage(
        name="load_sharing_summary",
        module="sharing",
        title="Load sharing of all studies",
        needs={"points": ComputedValue(studies.points, ("studies",))},
        upstream={
            "summaries": From("load_sharing", "summary", each_wildcards=studies.nominal_and_every_point),
            "curves": From("load_sharing", "curve", each_wildcards=studies.every_point),
        },
        files={
            "summary": File("load_sharing/summary.csv", ("group", "kind"), text=CASE_COLUMNS),
            "studies": File(
                "load_sharing/{each}.csv", ("cycle_fraction",), text=CASE_COLUMNS, each_text=studies.names
            ),
        },
        figures=Figures(
            draw="facegear.report.figures.sharing:load_sharing_figures",
            names=studies.sharing_figures,
            chapter="load_sharing",
            upstream=from_stage("load_sharing_summary", "studies", "summary"),
            needs={
                "titles": ComputedValue(studies.titles, ("studies",)),
                "groups": ComputedValue(studies.kinds_of_groups, ("transmission", "tooth_pair")),
            },
        ),
        condition=machine_conditions.shares_load,
        local=True,
    ),
    Stage(
        name="study_forces",
        module="sharing",
        title="Forces of meshes over the numbers of studies",
        needs={"points": ComputedValue(studies.numbered_points, ("studies",))},
        upstream={"tables": From("load_sharing", "forces", each_wildcards=studies.numbered_cases)},
        files={
            "forces": File(
                "load_sharing/study_forces.csv",
                ("number", "mean_n", "largest_n"),
                text=("study", "point", "axis", "beside", "key", "mesh", "group"),
            )
        },
        figures=Figures(
            draw="facegear.report.figures.sharing:study_forces_figures",
            names=studies.force_figures,
            chapter="load_sharing",
            upstream=from_stage("study_forces", "forces"),
            needs={"titles": ComputedValue(studies.titles_by_name, ("studies",))},
        ),
        condition=studies.over_numbers,
        local=True,
    ),
    Stage(
        name="load_sharing_reference",
        module="sharing",
        title="Load sharing at rest, running slowly and over a range of speeds",
        machine="machine",
        needs={
            **MACHINE,
            **ACCURACY,
            "range_accuracy": "dynamics.sweep.accuracy",
            "options": OPTIONS,
        },
        upstream=MOTION_INPUTS,
        files={
            "reference": File("load_sharing/reference.csv"),
            "speeds": File("load_sharing/speed_range.csv"),
        },
        condition=machine_conditions.shares_load,
        minutes=15,
        priority=58,
    ),
    Stage(
        name="hunting",
        module="sharing",
        title="Quasi-static load sharing over the hunting cycle",
        machine="machine",
        needs={**MACHINE, "positions": "load_sharing.hunting_positions"},
        upstream={**HARMONICS, **BODIES, **TOOTH_ERRORS},
        files={
            "meshes": File(
                "load_sharing/hunting_meshes.csv",
                ("mean_n", "drive_fraction", "back_fraction"),
                text=("mesh", "group"),
            ),
            "groups": File(
                "load_sharing/hunting_groups.csv", ("torque_n_m",), may_be_empty=True, text=("group", "kind")
            ),
            "bearings": File(
                "load_sharing/bearings.csv", ("body", "mean_x_n", "mean_y_n", "mean_z_n"), text=("body",)
            ),
            "cycles": File("load_sharing/hunting_cycles.csv", ("cycle",)),
            "scan": File(
                "load_sharing/bearing_stiffness.csv",
                ("stiffness_n_per_m", "k_gamma"),
                may_be_empty=True,
                text=("kinematics", "varied", "kind"),
            ),
            "sensitivity": File(
                "load_sharing/sensitivity.csv", ("per_um",), may_be_empty=True, text=("error", "group")
            ),
        },
        figures=Figures(
            draw="facegear.report.figures.sharing:hunting_figures",
            names=("layout", "hunting", "bearing_stiffness", "sensitivity"),
            chapter="load_sharing",
            upstream=from_stage("hunting", "meshes", "bearings", "cycles", "scan", "sensitivity"),
            needs=MACHINE,
        ),
        condition=machine_conditions.hunting,
    ),
    Stage(
        name="sharing_map",
        module="sharing",
        title="Map of load sharing, and what to change",
        machine="inputs",
        needs={
            **MACHINE,
            "sharing_map": "sharing_map",
            "torques": ComputedValue(arguments.duty_torques, ("strength",)),
        },
        section="sharing_map",
        upstream={**HARMONICS, **BODIES},
        files={
            "curves": File(
                "load_sharing/sharing_map_curves.csv",
                ("number", "k_gamma_p95"),
                may_be_empty=True,
                text=("group", "floating"),
            ),
            "inputs": File(
                "load_sharing/sharing_map_inputs.csv",
                ("number", "k_gamma"),
                may_be_empty=True,
                text=("group",),
            ),
            "points": File(
                "load_sharing/sharing_map_points.csv",
                ("number", "k_gamma_p95"),
                may_be_empty=True,
                text=("group", "kind"),
            ),
            "advice": File(
                "load_sharing/sharing_map_advice.csv",
                ("k_gamma", "found", "gain"),
                may_be_empty=True,
                text=("group", "kind", "change", "from_to"),
            ),
            "reasons": File("load_sharing/sharing_map_reasons.csv", (), may_be_empty=True, text=("reason",)),
        },
        figures=Figures(
            draw="facegear.report.figures.sharing_map:sharing_map_figures",
            names=("sharing_map",),
            chapter="load_sharing",
            upstream=from_stage("sharing_map", "curves", "inputs", "points"),
        ),
        condition=machine_conditions.sharing_map,
    ),
    Stage(
        name="following",
        module="sharing",
        title="Load sharing of the running machine while its runouts turn",
        machine="machine",
        needs={
            **MACHINE,
            **ACCURACY,
            **SPEED,
            "positions": "load_sharing.hunting_positions",
            "cycles": "load_sharing.followed_cycles",
        },
        upstream={**MOTION_INPUTS, **TOOTH_ERRORS},
        files={
            "groups": File("load_sharing/following_groups.csv", may_be_empty=True),
            "meshes": File("load_sharing/following_meshes.csv"),
        },
        condition=machine_conditions.follows_rotation,
    ),
)
"""Stages on load sharing."""
