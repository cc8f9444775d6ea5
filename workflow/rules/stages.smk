include: "functions/stages.smk"


for stage in STAGES.values():

    rule:
        "One stage of the table in facegear/pipeline, for one case."
        name:
            stage.name
        input:
            **inputs(stage.upstream, stage),
        output:
            **outputs(stage),
        log:
            f"results/{{case}}/logs/{named(stage.name, stage.wildcards)}.log",
        benchmark:
            f"results/{{case}}/benchmarks/rules/{named(stage.name, stage.wildcards)}.tsv"
        wildcard_constraints:
            **alone(stage),
        priority: stage.priority
        localrule: stage.local
        conda:
            ENVIRONMENT
        resources:
            **resources(stage.memory_mb, stage.minutes),
        params:
            stage=stage.name,
            needs=needed(stage.needs, stage.name),
            code=code(STAGE_SCRIPT, *stage.functions),
        message:
            f"{stage.title}: {{wildcards}}"
        script:
            "../scripts/stage.py"


for stage, number, cases in STUDIED:

    rule:
        "One stage that takes seconds, for several cases of studies."
        name:
            f"{stage.name}_studies_{number}"
        input:
            **inputs_of_cases(stage, cases),
        output:
            **numbered(lambda case: outputs(stage, case), cases),
        log:
            f"results/{CASE}/logs/{stage.name}_studies_{number}.log",
        benchmark:
            f"results/{CASE}/benchmarks/rules/{stage.name}_studies_{number}.tsv"
        priority: stage.priority
        localrule: stage.local
        conda:
            ENVIRONMENT
        resources:
            **resources(stage.memory_mb, stage.minutes),
        params:
            stage=stage.name,
            cases=cases,
            needs=needs_of_cases(stage, cases),
            code=code(STAGE_SCRIPT, *stage.functions),
        message:
            f"{stage.title}: {', '.join(cases)}"
        script:
            "../scripts/stage.py"
