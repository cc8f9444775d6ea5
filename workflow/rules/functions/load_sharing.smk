from facegear.config.cases import study_points
from facegear.config.base import parse as parse_section  # `parse` is a name of Snakemake
from facegear.config.studies import Study
from facegear.config.machines import group_kinds

STUDIES = [parse_section(Study, study) for study in CONFIG["studies"]]
STUDY_LABELS = {
    (study.name, name): point.label for study in STUDIES for name, point in study_points(study).items()
}
STUDY_POINTS = list(STUDY_LABELS)


SHARING_KINDS = group_kinds(CONFIG)


def load_sharing_targets(case):
    """Final outputs of this stage for a case, its studies and figures included."""
    if not SHARING_KINDS:
        return []
    names = ["nominal.csv", "summary.csv", "reference.csv", "speed_range.csv"]
    files = [f"results/{case}/load_sharing/{name}" for name in names]
    files += [f"results/{case}/load_sharing/{study.name}.csv" for study in STUDIES]
    return files + [file.format(case=case) for file in figure_files("svg")]


def sharing_figures(study):
    """Names of a study's figures, one for each kind of group."""
    if study.figures and len(SHARING_KINDS) == 2:
        return [f"fig{number:02d}" for number in study.figures]
    return [f"study_{study.name}_{kind}" for kind in SHARING_KINDS]


def point_files(name):
    """Function of the wildcards giving a file of every study's point."""
    return lambda wildcards: [
        f"results/{wildcards.case}/studies/{study}/{point}/load_sharing/{name}"
        for study, point in STUDY_POINTS
    ]


def figure_files(ending):
    """Load-sharing figures of all studies of a case."""
    return [
        f"results/{{case}}/figures/{name}.{ending}" for study in STUDIES for name in sharing_figures(study)
    ]
