def stiffness_input(wildcards):
    """Contact results, or the user's own file, or nothing when the harmonics stand in the config."""
    section = value_of("mesh_stiffness")(wildcards)
    if section["source"] != "harmonics":
        return {"ltca": shared("contact", "ltca")(wildcards)}
    return {"given": section["csv"]} if section["csv"] else {}
