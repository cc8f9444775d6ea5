def changes_contact(case):
    """Whether a study's case solves a loaded contact of its own."""
    return has_contact(case) and sources("contact")[case] != CASE


def contact_cases(study):
    """The cases of a study that stand side by side: those with a contact, if one of them changes it."""
    cases = [f"{CASE}/studies/{study}/{point}" for name, point in STUDY_POINTS if name == study]
    solved = [case for case in cases if has_contact(case)]
    return solved if has_contact(CASE) and any(changes_contact(case) for case in solved) else []


CONTACT_STUDIES = {study.name: study.title for study in STUDIES if contact_cases(study.name)}
CONTACT_CASES = [case for study in CONTACT_STUDIES for case in contact_cases(study)]
CONTACT_STUDY_FIGURES = [
    f"contact_{kind}{study}" for study in CONTACT_STUDIES for kind in ("study_", "pattern_study_")
]


def studied(rule, output):
    """A file of the machine itself and of every case that a study of the contact shows."""
    path = str(getattr(rules, rule).output[output])
    return [path.format(case=sources(rule)[case]) for case in [CASE, *CONTACT_CASES]]


def studied_contacts():
    """All that is known of the contact of those cases."""
    files = {kind: studied("contact", kind) for kind in ("ltca", "by_torque", "pressure")}
    return {"pair": studied("geometry", "pair"), **files}


def studied_names():
    """Study, point and label of those cases; the machine itself is nominal."""
    keys = [tuple(case.split("/")[-2:]) for case in CONTACT_CASES]
    return [("nominal", "nominal", "as configured"), *((*key, STUDY_LABELS[key]) for key in keys)]


def studied_torque():
    """The torque that the figures show: that of the mesh stiffness, else the largest solved."""
    return CASES[CASE]["mesh_stiffness"]["torque_n_m"] or max(CASES[CASE]["contact"]["torques_n_m"])
