def report_tables(wildcards):
    """Tables that the report of a case reads."""
    case = wildcards.case
    names = ["modal/frequencies", "stiffness/harmonics", "dynamics/jumps", "load_sharing/summary"]
    names += ["contact/ltca"] if has_contact(case) else []
    names += ["scorecard"] if scorecard_targets(case) else []
    return [f"results/{case}/{name}.csv" for name in names]


def report_pictures(wildcards):
    """Figures that the report of a case shows."""
    return [file for file in targets(wildcards.case) if file.endswith(".svg")]
