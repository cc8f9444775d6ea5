"""Friction, heat and film."""

from facegear.pipeline import conditions, contact_studies, machine_conditions
from facegear.pipeline.rows.common_needs import MACHINE, MOTION_INPUTS, PAIR, SPEED
from facegear.pipeline.stage import ComputedValue, Figures, File, From, Stage, from_stage

STORED_CONTACT = from_stage("contact", "ltca", "pressure")
"""Tables and arrays of the contact analysis that friction takes."""

PAIR_ROWS = (
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
"""Stages on friction of the pair alone."""

ROWS = (
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
"""Stages on friction and loss of the machine."""
