from facegear.config.modal import modes_need_contact


def modal_input(wildcards):
    """The computed stiffness where modes need more than the mean that the config gives."""
    values = {
        "mesh_stiffness": {
            key: value_of(f"mesh_stiffness.{key}")(wildcards) for key in ("source", "mean_n_per_m")
        },
        "modal": {"stiffness": value_of("modal.stiffness")(wildcards)},
    }
    asks = modes_need_contact(values)
    return {"harmonics": shared("stiffness", "harmonics")(wildcards)} if asks else {}
