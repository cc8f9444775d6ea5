from facegear.pipeline import asked, studies


def files_of(rule, case):
    """Files that a rule writes for a case."""
    return [path.format(case=case) for path in rule.output]


def targets(case):
    """All files of a case but its report: only what its config asks for."""
    made = [stage for stage in STAGES.values() if stage.asked and stage.asked(case_of(case))]
    names = [stage.name for stage in made] + [f"{stage.name}{FIGURES}" for stage in made if stage in DRAWN]
    found = [getattr(rules, name) for name in names] + ([rules.scorecard] if REPRODUCTION else [])
    return [path for rule in found for path in files_of(rule, case)]


REPORTED = {
    "stiffness": ["harmonics"],
    "ratings": ["ratings", "bodies", "meshes"],
    "modal": ["frequencies", "contacts"],
    "dynamics_sweep": ["jumps", "sweep"],
    "dynamics_response": ["bearings"],
    "load_sharing_summary": ["summary"],
    "following": ["groups"],
    "contact": ["ltca", "by_torque"],
    "root_stress": ["summary"],
    "contact_studies": ["table"],
    "tolerances": ["percentiles", "shares"],
    "lubrication": ["by_torque", "limits"],
    "machine_loss": ["machine", "meshes", "bodies"],
    "rating": ["safety", "rating"],
    "dynamic_root_stress": ["dynamic_stress"],
    "stress_over_speed": ["stress_over_speed"],
}
"""Tables of each stage that the report reads."""


def report_tables(wildcards):
    """Tables that the report of a case reads."""
    case = case_of(wildcards.case)
    made = [name for name in REPORTED if STAGES[name].asked(case)]
    tables = [shared(name, file)(wildcards) for name in made for file in REPORTED[name]]
    tables += [shared("duty_loads", "duty_loads")(wildcards)] if asked.machine_loads(case) else []
    return tables + (files_of(rules.scorecard, wildcards.case)[:1] if REPRODUCTION else [])


def report_values(wildcards):
    """All plain values of a case; `reproduction` says whether it is the machine of a publication."""
    case = wildcards.case
    return {**CASES[case], "reproduction": case == CASE and REPRODUCTION is not None}


def report_pair(wildcards):
    """Record of the tooth geometry, where a case computes it."""
    return [shared("geometry", "pair")(wildcards)] if asked.contact(case_of(wildcards.case)) else []


def report_loads(wildcards):
    """What each contact carries, where a case computes it."""
    return [shared("contact", "pressure")(wildcards)] if asked.contact(case_of(wildcards.case)) else []


def report_stress(wildcards):
    """Root stress of every tooth, where a case computes it."""
    return [shared("root_stress", "stress")(wildcards)] if asked.root_stress(case_of(wildcards.case)) else []


def report_pictures(wildcards):
    """Figures that the report of a case shows."""
    return [file for file in targets(wildcards.case) if file.endswith(".svg")]
