"""The machine at rest: ratings and modes."""

from facegear.pipeline import asked
from facegear.pipeline.rows.shared import HARMONICS, LAW, MACHINE, SPEED
from facegear.pipeline.stage import Figures, File, From, Stage, from_stage

ROWS = (
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
        upstream={"harmonics": From("stiffness", "harmonics", when=asked.modes_from_contact), **LAW},
        files={
            "frequencies": File("modal/frequencies.csv", ("order", "frequency_hz", "symbols", "class")),
            "shapes": File("modal/shapes.csv", ("order", "body", "dof", "relative")),
            "contacts": File("modal/contacts.csv", ("contact", "state", "stiffness_n_per_m")),
        },
        figures=Figures(
            draw="facegear.plots.modal:figures",
            names=("mode_shapes",),
            chapter="modes",
            upstream=from_stage("modal", "frequencies", "shapes"),
        ),
        asked=asked.machine,
        local=True,
    ),
)
