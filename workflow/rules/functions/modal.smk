TEETH_KEYS = {
    "pinion_teeth": "tooth_pair.pinion_teeth",
    "face_gear_teeth": "tooth_pair.face_gear_teeth",
    "module_mm": "tooth_pair.module_mm",
    "pressure_angle_deg": "tooth_pair.pressure_angle_deg",
}


def teeth_slice(wildcards):
    """The tooth pair's numbers that the lumped model needs; its other data must not rerun modes or dynamics."""
    return {name: value_of(key)(wildcards) for name, key in TEETH_KEYS.items()}


def machine_section(wildcards):
    """The section `transmission`, which a config of tooth contact alone lacks."""
    section = value_of("transmission")(wildcards)
    if section is None:
        stop(f"transmission = null: required for modes, dynamics and load sharing of {wildcards.case}")
    return section


def machine_values(**renamed):
    """What a job needs to build the machine, and further config values under the names given."""
    return {"teeth": teeth_slice, "section": machine_section, **values_of(**renamed)}


def modal_input(wildcards):
    """The computed stiffness where the config gives no mean of its own."""
    given = value_of("mesh_stiffness.mean_n_per_m")(wildcards) is not None
    return {} if given else {"harmonics": shared("stiffness", "harmonics")(wildcards)}
