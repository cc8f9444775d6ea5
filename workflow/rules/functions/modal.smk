TEETH_KEYS = {
    "pinion_teeth": "tooth_pair.pinion_teeth",
    "face_gear_teeth": "tooth_pair.face_gear_teeth",
    "module_mm": "tooth_pair.module_mm",
    "pressure_angle_deg": "tooth_pair.pressure_angle_deg",
}


def teeth_slice(wildcards):
    """The tooth pair's numbers that the lumped model needs; its other data must not rerun modes or dynamics."""
    return {name: config_slice(key)(wildcards) for name, key in TEETH_KEYS.items()}
