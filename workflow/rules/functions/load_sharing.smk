from facegear.config.cases import study_points
from facegear.config.sharing_groups import group_kinds
from facegear.config.studies import Study

STUDIES = [parse_section(Study, study) for study in CONFIG["studies"]]
STUDY_LABELS = {
    (study.name, name): point.label for study in STUDIES for name, point in study_points(study).items()
}
STUDY_POINTS = list(STUDY_LABELS)
SHARING_KINDS = group_kinds(CONFIG) if CONFIG["transmission"] else []


SHARING_FIGURES = [f"study_{study.name}_{kind}" for study in STUDIES for kind in SHARING_KINDS]


def sharing_files(output, nominal=False):
    """Function of the wildcards giving a file of every study's point, after the nominal case's if asked for.

    Points that are the same machine, the nominal one mostly, have one file.
    """

    def files(wildcards):
        points = [f"{wildcards.case}/studies/{study}/{point}" for study, point in STUDY_POINTS]
        cases = [wildcards.case] * nominal + points
        alike = [sources("load_sharing")[case] for case in cases]
        return [rules.load_sharing.output[output].format(case=case) for case in alike]

    return files
