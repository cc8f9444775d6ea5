include: "functions/load_sharing.smk"


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
        labels=list(STUDY_LABELS.values()),
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
        svg=report(figure_files("svg"), caption="../report/load_sharing.rst", category="Load sharing"),
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
        titles=[(study.title, study.figures is not None) for study in STUDIES],
        kinds=SHARING_KINDS,
        values=lambda wildcards: CASES[wildcards.case],
        code=fingerprint("load_sharing_figures.py"),
    message:
        "load-sharing figures of {wildcards.case}"
    script:
        "../scripts/load_sharing_figures.py"
