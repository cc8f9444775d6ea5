"""The machine at rest: ratings and modes."""

from facegear.pipeline import conditions, machine_conditions
from facegear.pipeline.rows.common_needs import (
    BODIES,
    FLANKS,
    HARMONICS,
    LAW,
    MACHINE,
    MESHES,
    PAIR,
    POSES,
    SPEED,
)
from facegear.pipeline.stage import ComputedValue, Figures, File, From, Stage, from_stage

ROWS = (
    Stage(
        name="casing",
        title="The casing reduced to the seats of the machine",
        needs={"section": "transmission.casing"},
        files={
            "seats": File("casing/seats.csv", ("x_mm", "x_n_per_m"), text=("seat",)),
            "modes": File("casing/modes.csv", ("mode", "frequency_hz"), may_be_empty=True, text=("held",)),
            "reduced": File("casing/reduced.npz"),
        },
        condition=machine_conditions.casing,
        memory_mb=2000,
    ),
    Stage(
        name="gear_bodies",
        title="Face gears that bend: modes and compliance with their hubs held",
        needs={
            "transmission": "transmission",
            "tooth_pair": "tooth_pair",
            **SPEED,
            "last_rpm": "dynamics.sweep.to_rpm",
        },
        files={
            "bodies": File("bodies/bodies.csv", ("gear", "mass_kg", "frequency_change")),
            "modes": File("bodies/modes.csv", ("gear", "nodal_diameters", "frequency_hz"), may_be_empty=True),
            "crossings": File("bodies/crossings.csv", ("gear", "speed_rpm"), may_be_empty=True),
            "compliance": File("bodies/compliance.csv", ("gear", "order", "axial_m_per_n")),
            "influence": File("bodies/influence.csv", ("gear", "first", "second", "compliance_m_per_n")),
            "reduced": File("bodies/reduced.npz"),
            "shapes": File("bodies/shapes.npz"),
        },
        figures=Figures(
            draw="facegear.report.figures.turning_machine:gear_bodies_figures",
            names=("body_shapes", "body_waves", "body_campbell"),
            chapter="modes",
            upstream=from_stage("gear_bodies", "modes", "crossings", "shapes"),
            needs={"last_rpm": "dynamics.sweep.to_rpm", "teeth": "tooth_pair.pinion_teeth"},
        ),
        condition=machine_conditions.elastic_gears,
        memory_mb=500,
        local=True,
    ),
    Stage(
        name="ratings",
        module="machine",
        title="Gear ratio, speeds, torques and powers",
        machine="machine",
        needs={**MACHINE, **SPEED},
        upstream={**HARMONICS, **BODIES},
        files={name: File(f"machine/{name}.csv") for name in ("ratings", "bodies", "meshes")},
        figures=Figures(
            draw="facegear.report.figures.machine:gearbox_layout_figures",
            names=("machine",),
            chapter="load_sharing",
            upstream=from_stage("ratings", "meshes"),
            needs=MACHINE,
        ),
        condition=conditions.machine,
        local=True,
    ),
    Stage(
        name="shafts",
        module="machine",
        title="Shafts of pinions, engines and rotors under load",
        machine="inputs",
        needs=MACHINE,
        upstream={**HARMONICS, **BODIES},
        files={
            "seats": File("shafts/seats.csv", ("pinion", "x_um", "tilt_y_urad"), may_be_empty=True),
            "stiffness": File("shafts/stiffness.csv", ("pinion", "motion", "x"), may_be_empty=True),
            "bearings": File("shafts/bearings.csv", ("pinion", "bearing", "radial_n"), may_be_empty=True),
            "deflections": File(
                "shafts/deflections.csv", ("at_mm", "x_um", "y_um"), may_be_empty=True, text=("pinion",)
            ),
            "torsion": File("shafts/torsion.csv", ("body", "mass", "windup_deg"), may_be_empty=True),
        },
        figures=Figures(
            draw="facegear.report.figures.shafts:shafts_figures",
            names=machine_conditions.shaft_figures,
            chapter="load_sharing",
            upstream=from_stage("shafts", "bearings", "deflections"),
            needs={**MACHINE, "width_mm": ComputedValue(machine_conditions.pinion_width, ("tooth_pair",))},
        ),
        condition=machine_conditions.drive_line,
        local=True,
    ),
    Stage(
        name="casing_loads",
        module="casing",
        title="Seats, feet, mesh forces and modes of the machine on its casing",
        machine="machine",
        needs={**MACHINE, "first_rpm": "dynamics.sweep.from_rpm", "last_rpm": "dynamics.sweep.to_rpm"},
        upstream={**HARMONICS, **BODIES},
        files={
            "seats": File("casing/seat_motions.csv", ("x_um", "tilt_x_urad"), text=("seat",)),
            "feet": File("casing/feet.csv", ("x_n", "tilt_x_n_m"), text=("foot",)),
            "sharing": File("casing/load_sharing.csv", ("force_n", "force_on_fixed_seats_n"), text=("mesh",)),
            "modes": File("casing/machine_modes.csv", ("frequency_hz", "casing_energy_fraction")),
            "campbell": File("casing/campbell.csv", ("line", "speed_rpm", "frequency_hz")),
            "crossings": File("casing/crossings.csv", ("order", "speed_rpm"), may_be_empty=True),
        },
        figures=Figures(
            draw="facegear.report.figures.casing:casing_figures",
            names=("casing_sharing", "casing_campbell"),
            chapter="load_sharing",
            upstream=from_stage("casing_loads", "sharing", "campbell", "crossings"),
        ),
        condition=machine_conditions.casing,
        local=True,
    ),
    Stage(
        name="casing_response",
        module="casing",
        title="Acceleration of the casing's sensors over speed by orders of the mesh",
        machine="machine",
        needs={**MACHINE, "first_rpm": "dynamics.sweep.from_rpm", "last_rpm": "dynamics.sweep.to_rpm"},
        upstream={**HARMONICS, **BODIES},
        files={
            "sensors": File(
                "casing/sensors.csv", ("speed_rpm", "order", "acceleration_m_per_s2"), text=("sensor",)
            )
        },
        figures=Figures(
            draw="facegear.report.figures.casing:sensor_figures",
            names=("casing_acceleration",),
            chapter="load_sharing",
            upstream=from_stage("casing_response", "sensors"),
        ),
        condition=machine_conditions.casing_sensors,
        local=True,
    ),
    Stage(
        name="operating_pose",
        module="poses",
        title="Teeth where the machine's own forces put them",
        machine="machine",
        needs={**MACHINE, **PAIR, "contact": "contact"},
        upstream={"surface": From("pose_surface", "surface"), **FLANKS, **MESHES, **BODIES},
        files={
            "meshes": File(
                "poses/meshes.csv", "facegear.machine.poses.tables:FINITE", text=("mesh", "flank")
            ),
            "loads": File("poses/loads.csv", ("load_fraction", "unloaded_path_mm"), text=("mesh", "flank")),
            "leaving": File("poses/leaving.csv", ("load_fraction",), may_be_empty=True, text=("mesh", "end")),
            "check": File("poses/check.csv", ("surface", "direct"), text=("quantity",)),
            "as_assembled": File("poses/as_assembled.npz", "facegear.contact.pattern:PRESSURE_ARRAYS"),
            "running": File("poses/running.npz", "facegear.contact.pattern:PRESSURE_ARRAYS"),
        },
        figures=Figures(
            draw="facegear.report.figures.contact:operating_pose_figures",
            names=("pose_pattern", "pose_paths"),
            chapter="load_sharing",
            upstream=from_stage("operating_pose", "meshes", "loads", "as_assembled", "running"),
        ),
        condition=conditions.poses,
        memory_mb=2000,
    ),
    Stage(
        name="gear_waves",
        module="gear_bodies",
        title="Modes at the nominal speed and the waves of face gears that bend",
        machine="machine",
        needs={**MACHINE, **SPEED, "last_rpm": "dynamics.sweep.to_rpm"},
        upstream={**HARMONICS, **BODIES},
        files={
            "waves": File("bodies/waves.csv", ("order", "frequency_hz", "damping_ratio"), may_be_empty=True),
            "campbell": File("bodies/campbell.csv", ("speed_rpm", "line", "frequency_hz")),
            "campbell_crossings": File(
                "bodies/campbell_crossings.csv", ("line", "speed_rpm", "phase_factor"), may_be_empty=True
            ),
        },
        figures=Figures(
            draw="facegear.report.figures.turning_machine:gear_waves_figures",
            names=("machine_campbell",),
            chapter="modes",
            upstream=from_stage("gear_waves", "campbell", "campbell_crossings"),
            needs={"last_rpm": "dynamics.sweep.to_rpm", "teeth": "tooth_pair.pinion_teeth"},
        ),
        condition=machine_conditions.elastic_gears,
        local=True,
    ),
    Stage(
        name="modal",
        module="machine",
        title="Natural frequencies and mode shapes",
        machine="inputs",
        needs={
            **MACHINE,
            "mean_stiffness": "mesh_stiffness.mean_n_per_m",
            "source": "mesh_stiffness.source",
            "definition": "modal.stiffness",
        },
        upstream={
            "harmonics": From("stiffness", "harmonics", when=conditions.modes_from_contact),
            **LAW,
            **POSES,
            **BODIES,
        },
        files={
            "frequencies": File("modal/frequencies.csv", ("order", "frequency_hz", "symbols", "class")),
            "shapes": File("modal/shapes.csv", ("order", "body", "dof", "relative")),
            "contacts": File("modal/contacts.csv", ("contact", "state", "stiffness_n_per_m")),
        },
        figures=Figures(
            draw="facegear.report.figures.machine:modal_figures",
            names=("mode_shapes",),
            chapter="modes",
            upstream=from_stage("modal", "frequencies", "shapes"),
        ),
        condition=conditions.machine,
        local=True,
    ),
)
"""Stages on gears that bend, ratings, shafts, operating pose and modes."""
