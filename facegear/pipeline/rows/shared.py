"""Needs and sources that several chapters share: slices of the config, and files of earlier stages."""

from facegear.pipeline import arguments, asked, machine_conditions
from facegear.pipeline.stage import ComputedValue, From, Needs, from_stage
from facegear.schema.changes import TEETH

PAIR: Needs = {"tooth_pair": "tooth_pair"}
MACHINE: Needs = {"transmission": "transmission", "teeth": tuple(f"tooth_pair.{key}" for key in TEETH)}
SPEED: Needs = {"speed_rpm": "dynamics.speed_rpm"}
ACCURACY: Needs = {"accuracy": "dynamics.accuracy"}
SWEEP: Needs = {"sweep": "dynamics.sweep"}
OPTIONS = ComputedValue(arguments.load_sharing_options, ("load_sharing",))
"""Settings by which load sharing is averaged."""
SHARING: Needs = {**MACHINE, **ACCURACY, **SPEED, "options": OPTIONS}

FLANKS = {name: From("compliance", "arrays", wildcards={"body": name}) for name in asked.BODIES}
LAW = {"law": From("mesh_law", "law", when=asked.load_dependent)}
POSES = {"poses": From("pose_surface", "surface", when=asked.poses)}
"""Contact over pose, where meshes stand where the machine's own forces put them."""
MESHES = {**from_stage("stiffness", "harmonics"), **LAW}
HARMONICS = {**MESHES, **POSES}
"""Sources of the mesh stiffness and of its contact over pose."""
BODIES = {
    "bodies": From("gear_bodies", "reduced", when=machine_conditions.elastic_gears),
}
"""Sources of what every stage of the machine takes, at rest and in motion: face gears that bend."""
TOOTH_ERRORS = {"tooth_errors": From("tooth_errors", "curves", when=asked.single_teeth)}
"""Teeth that deviate from the others."""
MOTION_INPUTS = {
    **HARMONICS,
    **BODIES,
    "friction": From("lubrication", "excitation", when=machine_conditions.friction_in_motion),
}
"""Sources of everything that stages take that compute the motion of the machine."""
