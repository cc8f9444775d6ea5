def complete(job):
    """Add what all jobs share, under names made of the rule's and its wildcards.

    That is the log, the benchmark, the environment, the docstring as message, and the fingerprint of the code
    that the script reaches; where it changes a job runs again.
    """
    wildcards = sorted(job.wildcard_names - {"case"})
    name = "_".join([job.name, *(f"{{{wildcard}}}" for wildcard in wildcards)])
    job.log_modifier = job.benchmark_modifier = job.output_modifier
    job.set_log(f"results/{{case}}/logs/{name}.log")
    job.benchmark = f"results/{{case}}/benchmarks/rules/{name}.tsv"
    job.conda_env = str(ROOT / "workflow" / "envs" / "facegear.yaml")
    job.docstring = job.docstring or TITLES[job.name]
    job.message = f"{job.docstring}: {{wildcards}}"
    script = job.basedir.join(job.script).get_path_or_uri(secret_free=True)
    modules = MODULES.get(job.name, ())
    job.set_params(code=lambda wildcards: code_of(script, modules))


@cache
def code_of(script, modules):
    """Fingerprint of a script and of the modules that it calls, found once a run and for rules with jobs alone."""
    return fingerprint(script, ROOT, modules)
