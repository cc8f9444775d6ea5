def figure(case, *names):
    """The svg of each named figure of a case."""
    return [f"results/{case}/figures/{name}.svg" for name in names]


def has_contact(case):
    """Whether the case solves the loaded contact itself."""
    return CASES[case]["mesh_stiffness"]["source"] != "harmonics"


def targets(case):
    """Results and figures of a case: only the stages that its config asks for."""
    files = [f"results/{case}/{name}" for name in ("modal/frequencies.csv", "stiffness/harmonics.csv")]
    files += figure(case, "fig06", "fig07", "fig08")
    if has_contact(case):
        files += [f"results/{case}/{name}" for name in ("mesh/quality.csv", "contact/ltca.csv")]
        files += figure(case, "tooth_pair", "contact_curves", "contact_pattern", "stiffness_load")
    return files + dynamics_targets(case) + load_sharing_targets(case) + scorecard_targets(case)
