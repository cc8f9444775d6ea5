def stiffness_input(wildcards):
    """Contact results, or the user's own file, or nothing when the harmonics stand in the config."""
    section = config_slice("mesh_stiffness")(wildcards)
    if section["source"] != "harmonics":
        return {"ltca": upstream("contact", "contact/ltca.csv")(wildcards)}
    return {"given": section["csv"]} if section["csv"] else {}
