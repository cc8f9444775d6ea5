from facegear.config.cases import study_points
from facegear.config.base import parse as parse_section  # `parse` is a name of Snakemake
from facegear.config.studies import Study
from facegear.config.machines import group_kinds

STUDIES = [parse_section(Study, study) for study in CONFIG["studies"]]
STUDY_POINTS = [(study.name, point) for study in STUDIES for point in study_points(study)]


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


rule load_sharing:
    input:
        harmonics=upstream("stiffness", "stiffness/harmonics.csv"),
    output:
        curve="results/{case}/load_sharing/nominal.csv",
        summary="results/{case}/load_sharing/nominal_summary.csv",
        manifest="results/{case}/load_sharing/load_sharing.provenance.json",
    log:
        "results/{case}/logs/load_sharing.log",
    benchmark:
        "results/{case}/benchmarks/rules/load_sharing.tsv"
    conda:
        "../envs/facegear.yaml"
    threads: 1
    resources:
        mem_mb=700,
        runtime=10,
    params:
        section=config_slice("transmission"),
        teeth=teeth_slice,
        speed_rpm=config_slice("dynamics.speed_rpm"),
        accuracy=config_slice("dynamics.accuracy"),
        options=config_slice("load_sharing"),
        code=fingerprint("load_sharing.py"),
    message:
        "load sharing of {wildcards.case}"
    script:
        "../scripts/load_sharing.py"


rule load_sharing_reference:
    input:
        harmonics=upstream("stiffness", "stiffness/harmonics.csv"),
    output:
        reference="results/{case}/load_sharing/reference.csv",
        speeds="results/{case}/load_sharing/speed_range.csv",
        manifest="results/{case}/load_sharing/reference.provenance.json",
    log:
        "results/{case}/logs/load_sharing_reference.log",
    benchmark:
        "results/{case}/benchmarks/rules/load_sharing_reference.tsv"
    conda:
        "../envs/facegear.yaml"
    threads: 1
    resources:
        mem_mb=700,
        runtime=15,
    params:
        section=config_slice("transmission"),
        teeth=teeth_slice,
        accuracy=config_slice("dynamics.accuracy"),
        range_accuracy=config_slice("dynamics.sweep.accuracy"),
        options=config_slice("load_sharing"),
        code=fingerprint("load_sharing_reference.py"),
    message:
        "static and slow load sharing of {wildcards.case}, and its maximum over speed"
    script:
        "../scripts/load_sharing_reference.py"


rule load_sharing_summary:
    input:
        summaries=lambda wildcards: [
            f"results/{wildcards.case}/load_sharing/nominal_summary.csv",
            *point_files("nominal_summary.csv")(wildcards),
        ],
        curves=point_files("nominal.csv"),
    output:
        summary="results/{case}/load_sharing/summary.csv",
        studies=[f"results/{{case}}/load_sharing/{study.name}.csv" for study in STUDIES],
        manifest="results/{case}/load_sharing/summary.provenance.json",
    log:
        "results/{case}/logs/load_sharing_summary.log",
    benchmark:
        "results/{case}/benchmarks/rules/load_sharing_summary.tsv"
    conda:
        "../envs/facegear.yaml"
    threads: 1
    resources:
        mem_mb=500,
        runtime=5,
    params:
        points=STUDY_POINTS,
        studies=[study.name for study in STUDIES],
        code=fingerprint("load_sharing_summary.py"),
    message:
        "load sharing of all studies of {wildcards.case}"
    script:
        "../scripts/load_sharing_summary.py"


rule load_sharing_figures:
    input:
        studies=[f"results/{{case}}/load_sharing/{study.name}.csv" for study in STUDIES],
        summary="results/{case}/load_sharing/summary.csv",
    output:
        svg=figure_files("svg"),
        png=figure_files("png"),
        manifest="results/{case}/figures/load_sharing_figures.provenance.json",
    log:
        "results/{case}/logs/load_sharing_figures.log",
    benchmark:
        "results/{case}/benchmarks/rules/load_sharing_figures.tsv"
    conda:
        "../envs/facegear.yaml"
    threads: 1
    resources:
        mem_mb=700,
        runtime=5,
    params:
        titles=[study.title for study in STUDIES],
        kinds=SHARING_KINDS,
        values=lambda wildcards: CASES[wildcards.case],
        code=fingerprint("load_sharing_figures.py"),
    message:
        "load-sharing figures of {wildcards.case}"
    script:
        "../scripts/load_sharing_figures.py"
