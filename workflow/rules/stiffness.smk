include: "functions/stiffness.smk"


rule stiffness:
    input:
        unpack(stiffness_input),
    output:
        tvms="results/{case}/stiffness/tvms.csv",
        harmonics="results/{case}/stiffness/harmonics.csv",
        spectrum="results/{case}/stiffness/spectrum.csv",
        manifest="results/{case}/stiffness/stiffness.provenance.json",
    log:
        "results/{case}/logs/stiffness.log",
    benchmark:
        "results/{case}/benchmarks/rules/stiffness.tsv"
    conda:
        "../envs/facegear.yaml"
    threads: 1
    resources:
        mem_mb=500,
        runtime=5,
    params:
        section=config_slice("mesh_stiffness"),
        code=fingerprint("stiffness.py"),
    message:
        "mesh stiffness of {wildcards.case}"
    script:
        "../scripts/stiffness.py"


rule load_dependence:
    input:
        ltca=upstream("contact", "contact/ltca.csv"),
    output:
        table="results/{case}/stiffness/load_dependence.csv",
        manifest="results/{case}/stiffness/load_dependence.provenance.json",
    log:
        "results/{case}/logs/load_dependence.log",
    benchmark:
        "results/{case}/benchmarks/rules/load_dependence.tsv"
    conda:
        "../envs/facegear.yaml"
    threads: 1
    resources:
        mem_mb=500,
        runtime=5,
    params:
        code=fingerprint("load_dependence.py"),
    message:
        "stiffness against load of {wildcards.case}"
    script:
        "../scripts/load_dependence.py"


rule stiffness_figures:
    input:
        tvms=upstream("stiffness", "stiffness/tvms.csv"),
        spectrum=upstream("stiffness", "stiffness/spectrum.csv"),
    output:
        tvms_svg=report(
            "results/{case}/figures/fig07.svg",
            caption="../report/stiffness.rst",
            category="Mesh stiffness",
            labels={"figure": "fig07"},
        ),
        tvms_png="results/{case}/figures/fig07.png",
        harmonics_svg=report(
            "results/{case}/figures/fig08.svg",
            caption="../report/stiffness.rst",
            category="Mesh stiffness",
            labels={"figure": "fig08"},
        ),
        harmonics_png="results/{case}/figures/fig08.png",
        manifest="results/{case}/figures/stiffness.provenance.json",
    log:
        "results/{case}/logs/stiffness_figures.log",
    benchmark:
        "results/{case}/benchmarks/rules/stiffness_figures.tsv"
    conda:
        "../envs/facegear.yaml"
    threads: 1
    resources:
        mem_mb=700,
        runtime=5,
    params:
        code=fingerprint("stiffness_figures.py"),
    message:
        "figures 7 and 8 of {wildcards.case}"
    script:
        "../scripts/stiffness_figures.py"


rule load_dependence_figure:
    input:
        table="results/{case}/stiffness/load_dependence.csv",
    output:
        svg=report(
            "results/{case}/figures/stiffness_load.svg",
            caption="../report/stiffness.rst",
            category="Mesh stiffness",
            labels={"figure": "stiffness_load"},
        ),
        png="results/{case}/figures/stiffness_load.png",
        manifest="results/{case}/figures/stiffness_load.provenance.json",
    log:
        "results/{case}/logs/load_dependence_figure.log",
    benchmark:
        "results/{case}/benchmarks/rules/load_dependence_figure.tsv"
    conda:
        "../envs/facegear.yaml"
    threads: 1
    resources:
        mem_mb=700,
        runtime=5,
    params:
        code=fingerprint("load_dependence_figure.py"),
    message:
        "stiffness against load of {wildcards.case}, drawn"
    script:
        "../scripts/load_dependence_figure.py"
