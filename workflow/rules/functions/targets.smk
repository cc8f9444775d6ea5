def stages(case):
    """What a run of a case consists of: only what its config asks for."""
    found = [rules.stiffness, rules.stiffness_figures]
    if has_contact(case):
        found += [rules.geometry, rules.tooth_pair_figure, rules.mesh]
        found += [rules.contact, rules.contact_figures, rules.load_dependence, rules.load_dependence_figure]
    if CASES[case]["contact"]["root_stress"]:
        found += [rules.root_stress, rules.root_stress_figures]
    found += [rules.contact_studies, rules.contact_studies_figures] if CONTACT_STUDIES else []
    if CASES[case]["strength"]:
        found += [rules.rating, rules.rating_figures]
    if CASES[case]["transmission"] is None:
        return found
    found += [rules.machine_code, rules.ratings, rules.modal, rules.modal_figure]
    found += [rules.dynamics_response, rules.dynamics_sweep, rules.dynamics_figures]
    if CASES[case]["contact"]["root_stress"]:
        found += [rules.dynamic_root_stress, rules.stress_over_speed, rules.stress_over_speed_figure]
    if CASES[case]["branches"]:
        found += [rules.branches, rules.branches_loci, rules.branches_figures]
    if SHARING_KINDS:
        found += [rules.load_sharing, rules.load_sharing_summary, rules.load_sharing_reference]
        found += [rules.load_sharing_figures] if STUDIES else []
    if SHARING_KINDS and CASES[case]["transmission"]["mesh_kinematics"] == "geometric":
        found += [rules.hunting, rules.hunting_figures]
        found += [rules.following] if turns(CASES[case]["transmission"]) else []
    if CASES[case]["tolerances"]:
        found += [rules.tolerances, rules.tolerances_figures]
        if CASES[case]["tolerances"]["load_map"]:
            found += [rules.tolerances_map, rules.tolerances_map_figure]
    if CASES[case]["search"]:
        found += [rules.search, rules.search_figures]
    return found + ([rules.scorecard] if REPRODUCTION else [])


def targets(case):
    """All files of a case, its report excepted."""
    return [path.format(case=case) for stage in stages(case) for path in stage.output]


def report_tables(wildcards):
    """Tables that the report of a case reads."""
    tables = [rules.stiffness.output.harmonics]
    if CASES[wildcards.case]["transmission"]:
        tables += [rules.ratings.output[name] for name in ("ratings", "bodies", "meshes")]
        tables += [rules.modal.output.frequencies, rules.modal.output.contacts]
        tables += [rules.dynamics_sweep.output[name] for name in ("jumps", "sweep")]
        tables += [rules.dynamics_response.output.bearings]
    tables += [rules.load_sharing_summary.output.summary] if SHARING_KINDS else []
    tables += [rules.following.output.groups] if rules.following in stages(wildcards.case) else []
    tables += (
        [rules.contact.output.ltca, rules.contact.output.by_torque] if has_contact(wildcards.case) else []
    )
    if CASES[wildcards.case]["contact"]["root_stress"]:
        tables += [rules.root_stress.output.summary]
    tables += [rules.contact_studies.output.table] if CONTACT_STUDIES else []
    if CASES[wildcards.case]["tolerances"]:
        tables += [rules.tolerances.output[name] for name in ("percentiles", "shares")]
    if CASES[wildcards.case]["strength"]:
        tables += [rules.rating.output.safety, rules.rating.output.rating]
        tables += machine_loads("duty_loads")(wildcards)
    if rules.dynamic_root_stress in stages(wildcards.case):
        tables += [rules.dynamic_root_stress.output.dynamic_stress]
        tables += [rules.stress_over_speed.output.stress_over_speed]
    tables += [rules.scorecard.output.csv] if REPRODUCTION else []
    return [path.format(case=wildcards.case) for path in tables]


def report_values(wildcards):
    """All plain values of a case; `reproduction` says whether it is the machine of a publication."""
    case = wildcards.case
    return {**CASES[case], "reproduction": case == CASE and REPRODUCTION is not None}


def report_pair(wildcards):
    """Record of the tooth geometry, where a case computes it."""
    return [shared("geometry", "pair")(wildcards)] if has_contact(wildcards.case) else []


def report_loads(wildcards):
    """What each contact carries, where a case computes it."""
    return [shared("contact", "pressure")(wildcards)] if has_contact(wildcards.case) else []


def report_stress(wildcards):
    """Root stress of every tooth, where a case computes it."""
    return [rules.root_stress.output.stress] if CASES[wildcards.case]["contact"]["root_stress"] else []


def report_pictures(wildcards):
    """Figures that the report of a case shows."""
    return [file for file in targets(wildcards.case) if file.endswith(".svg")]
