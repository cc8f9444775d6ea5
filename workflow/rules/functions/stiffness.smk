def stiffness_input(wildcards):
    """Contact results, or nothing when the harmonics stand in the config."""
    given = value_of("mesh_stiffness.source")(wildcards) == "harmonics"
    return {} if given else {"ltca": shared("contact", "ltca")(wildcards)}
