include: "functions/defaults.smk"


for job in workflow.rules:
    if job.script:
        complete(job)
