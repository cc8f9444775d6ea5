STAGE_SCRIPT = "workflow/scripts/stage.py"


def own_cases(stage):
    """Cases of studies with files of their own of a stage that takes seconds, to be made by one job."""
    if stage.together == 1 or len(CASES) == 1:
        return []
    return [name for name, shared_by in sources(stage.name).items() if name == shared_by != CASE]


STUDIED = [
    (stage, number, own_cases(stage)[first : first + stage.together])
    for stage in STAGES.values()
    for number, first in enumerate(range(0, len(own_cases(stage)), stage.together), 1)
]
"""Stage, number and cases of every job that makes cases of studies."""


def alone(stage):
    """Wildcards of a stage; its rule makes the cases that no other job makes."""
    others = [name for name in CASES if name not in own_cases(stage)]
    return {**stage.wildcards, "case": "|".join(map(re.escape, others))}


def inputs(upstream, stage):
    """Files of earlier stages that a stage takes, each from the case whose files are shared."""
    return {name: read_from(source, stage.name) for name, source in upstream.items()}


def outputs(stage, case="{case}"):
    """Paths of a stage's files by name, its manifest among them; a list where it writes several of a kind."""
    files = {
        name: (
            [f"results/{case}/{file.at({'each': each})}" for each in file.each_text(BASE)]
            if file.each_text
            else f"results/{case}/{file.path}"
        )
        for name, file in stage.files.items()
    }
    return {**files, "manifest": f"results/{case}/{stage.manifest}"}


def numbered(values_of_case, cases):
    """Files or values of several cases by name, the number of the case behind each name."""
    return {
        f"{name}__{n}": value for n, case in enumerate(cases) for name, value in values_of_case(case).items()
    }


def inputs_of_cases(stage, cases):
    """Files of earlier stages that a stage takes for several cases."""
    return numbered(
        lambda case: {
            name: lambda wildcards, source=source: files_read(source, case, stage.name)
            for name, source in stage.upstream.items()
        },
        cases,
    )


def needs_of_cases(stage, cases):
    """Function of the wildcards giving what a stage needs of the config, case by case."""
    return lambda wildcards: [values_needed(stage.needs, case, stage.name) for case in cases]


def named(name, wildcards):
    """A name for files of a rule, made of the rule's and of its wildcards beside the case."""
    return "_".join([name, *(f"{{{wildcard}}}" for wildcard in sorted(wildcards))])


def resources(memory_mb=None, minutes=None):
    """Resources of a job beyond what the profile gives each."""
    known = {"mem_mb": memory_mb, "runtime": minutes}
    return {name: value for name, value in known.items() if value is not None}
