"""Root stress, loss and heat of the machine, and safety and life under a duty cycle."""

from facegear.pipeline import arguments, conditions, contact_studies, machine_conditions
from facegear.pipeline.rows.common_needs import (
    ACCURACY,
    BODIES,
    FLANKS,
    HARMONICS,
    MACHINE,
    MESHES,
    MOTION_INPUTS,
    PAIR,
    POSES,
    SPEED,
    STORED_CONTACT,
    TOOTH_ERRORS,
)
from facegear.pipeline.stage import ComputedValue, Figures, File, From, Stage, from_stage

GEARS = {"gears": ComputedValue(arguments.gears_met, ("transmission",))}
"""Gears of the machine that the rating meets."""
STRESS = {"stress": From("root_stress", "stress"), "by_flank": From("contact", "by_flank")}
"""Root stress and contact by flank."""

TEXT_OF_BEARINGS = ("pinion", "bearing", "bin")
"""Columns of text in tables of rolling bearings."""
POSED_CONTACT = {
    "posed_contacts": From("posed_stress", "contacts", when=conditions.poses),
    "posed_by_torque": From("posed_stress", "by_torque", when=conditions.poses),
}
"""Contact solved at the pose of every mesh."""

LOAD_ROWS = (
    Stage(
        name="root_stress",
        module="strength",
        title="Root stress of both gears",
        needs={**PAIR, "mesh": "mesh", "contact": "contact"},
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
                view="facegear.strength.root_tables:stress_surface",
                of="stress",
            ),
        },
        figures=Figures(
            draw="facegear.report.figures.strength:root_figures",
            names=("root_stress_passage", "root_stress_along_face"),
            chapter="strength",
            upstream=from_stage("root_stress", "passage", "along_face"),
        ),
        condition=conditions.root_stress,
    ),
    Stage(
        name="posed_stress",
        title="Pressure and root stress of every mesh where its teeth stand",
        machine="machine",
        needs={**MACHINE, **PAIR, "contact": "contact", **GEARS},
        upstream={"surface": From("pose_surface", "surface"), **FLANKS, **STRESS, **MESHES, **BODIES},
        files={
            "by_mesh": File("strength/posed_stress.csv", ("torque_n_m",), text=("mesh", "flank")),
            "by_torque": File(
                "strength/posed_contacts.csv", ("contact", "torque_n_m"), text=("mesh", "flank")
            ),
            "contacts": File("strength/posed_contacts.npz"),
        },
        condition=conditions.posed_stress,
        memory_mb=4000,
        minutes=30,
    ),
    Stage(
        name="duty_poses",
        module="duty",
        title="Where the load of every bin of the duty cycle puts the teeth",
        machine="inputs",
        needs={**MACHINE, "strength": "strength"},
        section="strength.pinion",
        upstream={"surface": From("pose_surface", "surface"), **MESHES, **BODIES},
        files={
            "duty_poses": File(
                "strength/duty_poses.csv", "facegear.pipeline.stages.duty:COLUMNS", text=("mesh", "flank")
            )
        },
        condition=conditions.posed_rating,
        local=True,
    ),
    Stage(
        name="duty_loads",
        module="duty",
        title="Loads of the running machine in every bin of the duty cycle",
        machine="inputs",
        needs={**MACHINE, **ACCURACY, "strength": "strength"},
        section="strength",
        upstream={**MOTION_INPUTS, **TOOTH_ERRORS},
        files={
            "duty_loads": File("strength/duty_loads.csv"),
            "duty_spectrum": File(
                "strength/duty_spectrum.csv", "facegear.strength.columns:DUTY_SPECTRUM_COLUMNS"
            ),
        },
    ),
    Stage(
        name="bearing_life",
        title="Loads, stiffness and life of the rolling bearings",
        machine="inputs",
        needs={**MACHINE, **SPEED, "strength": "strength"},
        upstream={**HARMONICS, **BODIES},
        files={
            "loads": File(
                "bearings/loads.csv", "facegear.strength.bearing_rating:LOAD_FINITE", text=TEXT_OF_BEARINGS
            ),
            "stiffness": File(
                "bearings/stiffness.csv", ("torque_n_m", *"xyz"), text=(*TEXT_OF_BEARINGS, "motion")
            ),
            "life": File("bearings/life.csv", ("hours",), text=("pinion", "bin", "basis")),
            "over_torque": File(
                "bearings/over_torque.csv",
                "facegear.strength.bearing_rating:CURVE_FINITE",
                text=("pinion", "bearing"),
            ),
        },
        figures=Figures(
            draw="facegear.report.figures.bearings:bearing_figures",
            names=("bearings",),
            chapter="load_sharing",
            upstream=from_stage("bearing_life", "over_torque"),
        ),
        condition=machine_conditions.rolling_bearings,
        local=True,
    ),
    Stage(
        name="machine_loss",
        module="friction",
        title="Loss and heat of the machine",
        machine="inputs",
        needs={**PAIR, **MACHINE, **SPEED, "lubrication": "lubrication", "strength": "strength"},
        section="lubrication",
        upstream={
            **STORED_CONTACT,
            **MOTION_INPUTS,
            "response": From("dynamics_response", "response", when=machine_conditions.friction_in_motion),
            "duty_loads": From("duty_loads", "duty_loads", when=machine_conditions.machine_loads),
        },
        files={
            "meshes": File("lubrication/mesh_losses.csv", "facegear.lubrication.columns:MESH_FINITE"),
            "bodies": File("lubrication/body_heat.csv", ("bin", "speed_rpm", "heat_w"), text=("body",)),
            "machine": File("lubrication/machine_loss.csv", ("bin", "speed_rpm", "power_in_w", "loss_w")),
        },
        condition=machine_conditions.machine_friction,
        local=True,
        together=8,
    ),
    Stage(
        name="friction_studies",
        module="friction",
        title="Loss and heat of the studies' cases side by side",
        needs={"points": ComputedValue(contact_studies.friction_points, ("studies",))},
        upstream={
            name: From("machine_loss", name, each_wildcards=contact_studies.friction_cases)
            for name in ("meshes", "machine")
        },
        files={
            "table": File(
                "lubrication/friction_studies.csv",
                ("loss_w", "loss_percent", "contact_temperature_c"),
                text=("study", "point", "label", "hottest_mesh"),
            )
        },
        condition=contact_studies.friction_studied,
        local=True,
    ),
)
"""Stages on root stress, also at the operating pose, loads of the duty cycle, and loss of the machine."""

ROWS = (
    Stage(
        name="rating",
        module="strength",
        title="Safety and life of the tooth pair",
        needs={**PAIR, "strength": "strength", **GEARS},
        section="strength.pinion",
        upstream={
            **STRESS,
            "duty_spectrum": From("duty_loads", "duty_spectrum", when=machine_conditions.machine_loads),
            "mesh_losses": From("machine_loss", "meshes", when=machine_conditions.scuffed_loads),
            **POSED_CONTACT,
            **POSES,
            "duty_poses": From("duty_poses", "duty_poses", when=conditions.poses),
        },
        files={
            "safety": File("strength/safety.csv", "facegear.strength.columns:SAFETY_FINITE"),
            "rating": File("strength/rating.csv", "facegear.strength.columns:RATING_FINITE"),
            "damage": File("strength/damage.csv", "facegear.strength.columns:DAMAGE_FINITE"),
            "curves": File("strength/curves.csv", "facegear.strength.columns:CURVE_COLUMNS"),
        },
        figures=Figures(
            draw="facegear.report.figures.strength:rating_figures",
            names=("life", "damage"),
            chapter="strength",
            upstream=from_stage("rating", "rating", "damage", "curves"),
        ),
        condition=conditions.strength,
    ),
    Stage(
        name="dynamic_root_stress",
        module="strength",
        title="Root stress of the running machine",
        needs={**MACHINE, **PAIR, **GEARS},
        upstream={
            **from_stage("dynamics_response", "response", "summary"),
            **STRESS,
            **POSED_CONTACT,
            **POSES,
        },
        files={
            "dynamic_stress": File(
                "strength/dynamic_stress.csv", "facegear.strength.columns:DYNAMIC_STRESS_FINITE"
            )
        },
        condition=machine_conditions.machine_stress,
    ),
    Stage(
        name="stress_over_speed",
        module="strength",
        title="Root stress and pressure over the speed range",
        machine="inputs",
        needs={**MACHINE, **PAIR, **GEARS},
        upstream={
            "sweep": From("dynamics_sweep", "sweep"),
            "branches": From("branches", "branches", when=machine_conditions.branches),
            **STRESS,
            **HARMONICS,
            **BODIES,
            **POSED_CONTACT,
        },
        files={
            "stress_over_speed": File(
                "strength/stress_over_speed.csv", "facegear.strength.columns:STRESS_OVER_SPEED_FINITE"
            )
        },
        figures=Figures(
            draw="facegear.report.figures.strength:stress_over_speed_figures",
            names=("stress_over_speed",),
            chapter="strength",
            upstream={"table": From("stress_over_speed", "stress_over_speed")},
            needs=SPEED,
        ),
        condition=machine_conditions.machine_stress,
    ),
)
"""Stages on safety, life and stress in motion."""
