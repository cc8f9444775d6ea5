include: "functions/stages.smk"


for stage in STAGES.values():

    rule:
        name:
            stage.name
        input:
            **inputs(stage.upstream, stage),
        output:
            **outputs(stage),
            manifest=f"results/{{case}}/{stage.manifest}",
        wildcard_constraints:
            **stage.wildcards,
        priority: stage.priority
        localrule: stage.local
        resources:
            **resources(stage.memory_mb, stage.minutes),
        params:
            needs=needed(stage.needs, stage.name),
        script:
            "../scripts/stage.py"


for stage in DRAWN:

    rule:
        name:
            f"{stage.name}{FIGURES}"
        input:
            **inputs(stage.figures.upstream, stage),
        output:
            **pictures(stage.figures),
            manifest=f"results/{{case}}/figures/{stage.name}{FIGURES}.provenance.json",
        localrule: True
        resources:
            **resources(stage.figures.memory_mb),
        params:
            needs=needed(stage.figures.needs, stage.name),
        script:
            "../scripts/figures.py"
