include: "functions/figures.smk"


rule paper_figures_page:
    "Figures of the paper"
    input:
        claims=REPRODUCTION.claims if REPRODUCTION else [],
        scorecard=rules.scorecard.output.csv,
        frequencies=rules.modal.output.frequencies,
        shapes=rules.modal.output.shapes,
        tvms=rules.stiffness.output.tvms,
        harmonics=rules.stiffness.output.harmonics,
        response=rules.dynamics_response.output.response,
        spectrum=rules.dynamics_response.output.spectrum,
        sweep=rules.dynamics_sweep.output.sweep,
        sharing=rules.load_sharing_summary.output.summary,
        studies=rules.load_sharing_summary.output.studies,
    output:
        html="results/{case}/paper_figures/index.html",
        svg=paper_figures("svg"),
        png=paper_figures("png"),
        csv=paper_figures("csv"),
        manifest="results/{case}/paper_figures/paper_figures_page.provenance.json",
    log:
        "results/{case}/logs/paper_figures_page.log",
    benchmark:
        "results/{case}/benchmarks/rules/paper_figures_page.tsv"
    localrule: True
    conda:
        ENVIRONMENT
    params:
        values=sections("tooth_pair", "transmission", "mesh_stiffness"),
        inputs=[one.model_dump() for one in REPRODUCTION.inputs] if REPRODUCTION else [],
        code=code("paper/scripts/paper_figures_page.py"),
    script:
        "../scripts/paper_figures_page.py"


rule paper_figures:
    "Figures of the paper, each beside its claims."
    input:
        rules.paper_figures_page.output.html.format(case=CASE),
    localrule: True
