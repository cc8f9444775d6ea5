"""Layout of the machine with mean forces; quasi-static load sharing over the hunting cycle."""

from facegear.config.lumped_model import wired_layout
from facegear.io import tables
from facegear.plots.gearbox_layout import layout_figure
from facegear.plots.hunting import bearing_figure, hunting_figure, sensitivity_figure
from facegear.plots.style import save
from facegear.provenance.stage import stage

with stage(snakemake) as run:
    params, given = snakemake.params, snakemake.input
    shape = wired_layout(params.machine["transmission"], params.machine["teeth"])
    meshes = tables.read(given.meshes, ["mean_n", "drive_share", "back_share"], text=["mesh", "group"])
    bearings = tables.read(given.bearings, ["body", "mean_x_n", "mean_y_n", "mean_z_n"], text=["body"])
    groups = tables.read(given.groups, ["torque_n_m"], text=["group", "kind"])
    torque = float(groups["torque_n_m"].iloc[0])
    scan = tables.read(given.scan, ["stiffness_n_per_m", "k_gamma"], text=["kinematics", "varied", "kind"])
    errors = tables.read(given.sensitivity, ["per_um"], text=["error", "group"])
    figures = (
        layout_figure(shape, meshes, bearings),
        hunting_figure(tables.read(given.cycles, ["cycle"]), meshes, torque),
        bearing_figure(scan, torque),
        sensitivity_figure(errors, torque),
    )
    for figure, *paths in zip(figures, snakemake.output.svg, snakemake.output.png, strict=True):
        save(figure, *paths)
