include: "functions/modal.smk"


rule modal:
    output:
        frequencies="results/{case}/modal/frequencies.csv",
        shapes="results/{case}/modal/shapes.csv",
        manifest="results/{case}/modal/modal.provenance.json",
    log:
        "results/{case}/logs/modal.log",
    benchmark:
        "results/{case}/benchmarks/rules/modal.tsv"
    conda:
        "../envs/facegear.yaml"
    threads: 1
    resources:
        mem_mb=500,
        runtime=5,
    params:
        section=config_slice("transmission"),
        teeth=teeth_slice,
        mean_stiffness=config_slice("mesh_stiffness.mean_n_per_m"),
        code=fingerprint("modal.py"),
    message:
        "natural frequencies and mode shapes of {wildcards.case}"
    script:
        "../scripts/modal.py"


rule modal_figure:
    input:
        frequencies="results/{case}/modal/frequencies.csv",
        shapes="results/{case}/modal/shapes.csv",
    output:
        svg=report(
            "results/{case}/figures/fig06.svg",
            caption="../report/modes.rst",
            category="Modes",
            labels={"figure": "fig06"},
        ),
        png="results/{case}/figures/fig06.png",
        manifest="results/{case}/figures/fig06.provenance.json",
    log:
        "results/{case}/logs/modal_figure.log",
    benchmark:
        "results/{case}/benchmarks/rules/modal_figure.tsv"
    conda:
        "../envs/facegear.yaml"
    threads: 1
    resources:
        mem_mb=700,
        runtime=5,
    params:
        code=fingerprint("modal_figure.py"),
    message:
        "figure 6 of {wildcards.case}"
    script:
        "../scripts/modal_figure.py"
