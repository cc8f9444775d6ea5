TEETH = ("pinion_teeth", "face_gear_teeth", "module_mm", "pressure_angle_deg")


def branch_values(**renamed):
    """What a job needs to build the machine and follow its branches, and further config values."""

    def teeth(wildcards):
        return {name: value_of(f"tooth_pair.{name}")(wildcards) for name in TEETH}

    values = values_of("transmission", "branches", speed_rpm="dynamics.speed_rpm", **renamed)
    return {"teeth": teeth, **values}


def branch_starts(wildcards):
    """Files of the random starts of a case, one for each speed."""
    explore = CASES[wildcards.case]["branches"]["explore"]
    return expand(
        rules.branches_starts.output.found,
        case=wildcards.case,
        number=range(max(len(explore["speeds_rpm"]), 1)),
    )
