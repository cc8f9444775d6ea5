include: "functions/figures.smk"


for chapter, stages in CHAPTERS.items():

    rule:
        "All figures of one chapter of the report, from stored files alone."
        name:
            f"{chapter}{FIGURES}"
        input:
            **drawn_inputs(stages),
        output:
            svg=[shown(name, chapter) for name in drawn_names(stages)],
            json=[f"results/{{case}}/figures/{name}.json" for name in drawn_names(stages)],
            manifest=f"results/{{case}}/figures/{chapter}{FIGURES}.provenance.json",
        log:
            f"results/{{case}}/logs/{chapter}{FIGURES}.log",
        benchmark:
            f"results/{{case}}/benchmarks/rules/{chapter}{FIGURES}.tsv"
        localrule: True
        conda:
            ENVIRONMENT
        resources:
            **most_memory(stages),
        params:
            stages=[stage.name for stage in stages],
            needs=drawn_needs(stages),
            code=code("workflow/scripts/figures.py", *drawing_functions(stages)),
        message:
            f"Figures of chapter {chapter}: {{wildcards}}"
        script:
            "../scripts/figures.py"
