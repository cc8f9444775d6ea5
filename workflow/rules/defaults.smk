include: "functions/defaults.smk"


with remembered(Path(".snakemake/facegear_sources.json")):
    for job in workflow.rules:
        if job.script:
            complete(job)
