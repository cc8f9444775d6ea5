PRIORITIES = {
    "machine_code": 100,
    "compliance": 90,
    "contact": 80,
    "stiffness": 75,
    "dynamics_sweep_chunk": 60,
    "dynamics_sweep": 60,
    "dynamics_figures": 60,
    "branches_starts": 50,
    "branches": 50,
}
"""What starts first where several jobs may: long jobs and those that long ones wait for, so that short ones fill in."""


def complete(job):
    """Add what all jobs share, under names made of the rule's and its wildcards.

    That is the log, the benchmark, the environment, the docstring as message, the fingerprint of the code that the
    script reaches, and for a stage all that it takes from the config. Where one of the last two changes, a job runs
    again.
    """
    wildcards = sorted(job.wildcard_names - {"case"})
    name = "_".join([job.name, *(f"{{{wildcard}}}" for wildcard in wildcards)])
    job.log_modifier = job.benchmark_modifier = job.output_modifier
    job.set_log(f"results/{{case}}/logs/{name}.log")
    job.benchmark = f"results/{{case}}/benchmarks/rules/{name}.tsv"
    job.conda_env = str(ROOT / "workflow" / "envs" / "facegear.yaml")
    job.priority = PRIORITIES.get(job.name, 0)
    job.message = f"{job.docstring}: {{wildcards}}"
    if job.name in NEEDS:
        job.set_params(needs=needs(job.name))
    job.set_params(code=fingerprint(job.basedir.join(job.script).get_path_or_uri(secret_free=True), ROOT))
