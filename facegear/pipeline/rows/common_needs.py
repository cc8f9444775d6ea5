"""Needs and sources that several chapters share: slices of the config, and files of earlier stages."""

from facegear.pipeline import arguments, conditions, machine_conditions
from facegear.pipeline.stage import ComputedValue, From, Needs, from_stage
from facegear.schema.changes import TEETH

PAIR: Needs = {"tooth_pair": "tooth_pair"}
"""Need of the tooth pair."""
TEETH_OF_MACHINE = ComputedValue(
    arguments.teeth_of_machine, (*(f"tooth_pair.{key}" for key in TEETH), "tooth_pair.pinion.middle_mm")
)
"""Values of the tooth pair that the machine takes."""
MACHINE: Needs = {"transmission": "transmission", "teeth": TEETH_OF_MACHINE}
"""Needs of the machine: its section, and what it takes of the teeth."""
SPEED: Needs = {"speed_rpm": "dynamics.speed_rpm"}
"""Need of the operating speed."""
ACCURACY: Needs = {"accuracy": "dynamics.accuracy"}
"""Need of the accuracy of motions."""
SWEEP: Needs = {"sweep": "dynamics.sweep"}
"""Need of the range of speeds."""
OPTIONS = ComputedValue(arguments.load_sharing_options, ("load_sharing",))
"""Settings by which load sharing is averaged."""
SHARING: Needs = {**MACHINE, **ACCURACY, **SPEED, "options": OPTIONS}
"""Needs of load sharing at the operating speed."""

FLANKS = {name: From("compliance", "arrays", wildcards={"body": name}) for name in conditions.BODIES}
"""Compliance of both bodies' flanks."""
STORED_CONTACT = from_stage("contact", "ltca", "pressure")
"""Tables and arrays of the contact analysis that friction takes."""
LAW = {"law": From("mesh_law", "law", when=conditions.load_dependent)}
"""Load-dependent mesh law, where the config asks for it."""
POSES = {"poses": From("pose_surface", "surface", when=conditions.poses)}
"""Contact over pose, where meshes stand where the machine's own forces put them."""
MESHES = {**from_stage("stiffness", "harmonics"), **LAW}
"""Mesh stiffness, and the mesh law where the config asks for it."""
HARMONICS = {**MESHES, **POSES}
"""Sources of the mesh stiffness and of its contact over pose."""
ELASTIC_GEARS = {"bodies": From("gear_bodies", "reduced", when=machine_conditions.elastic_gears)}
"""Face gears that bend."""
BODIES = {
    **ELASTIC_GEARS,
    "casing": From("casing", "reduced", when=machine_conditions.casing),
}
"""Sources of what every stage of the machine takes, at rest and in motion: face gears that bend, and a
casing.
"""
TOOTH_ERRORS = {"tooth_errors": From("tooth_errors", "curves", when=conditions.single_teeth)}
"""Teeth that deviate from the others."""
MOTION_INPUTS = {
    **HARMONICS,
    **BODIES,
    "friction": From("lubrication", "excitation", when=machine_conditions.friction_in_motion),
}
"""Sources of everything that stages take that compute the motion of the machine."""
