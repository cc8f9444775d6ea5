def modal_input(wildcards):
    """The computed stiffness where the config gives no mean of its own."""
    given = value_of("mesh_stiffness.mean_n_per_m")(wildcards) is not None
    return {} if given else {"harmonics": shared("stiffness", "harmonics")(wildcards)}
