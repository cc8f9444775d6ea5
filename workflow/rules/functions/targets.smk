from facegear.pipeline import machine_conditions, studies
from facegear.pipeline.report_tables import REPORT_TABLES


def files_of(rule, case):
    """Files that a rule writes for a case."""
    return [path.format(case=case) for path in rule.output]


def targets(case):
    """All files of a case but its report: only what its config asks for."""
    made = [stage for stage in STAGES.values() if stage.condition and stage.condition(case_of(case))]
    names = [stage.name for stage in made]
    names += [
        f"{chapter}{FIGURES}" for chapter, stages in CHAPTERS.items() if any(one in made for one in stages)
    ]
    found = [getattr(rules, name) for name in names] + ([rules.scorecard] if REPRODUCTION else [])
    return [path for rule in found for path in files_of(rule, case)]


def report_tables(wildcards):
    """Tables that the report of a case reads."""
    case = case_of(wildcards.case)
    wanted = [(name, file) for name, files in REPORT_TABLES.items() for file in files]
    tables = [path for one in wanted for path in where_made(*one)(wildcards)]
    tables += (
        [shared("duty_loads", "duty_loads")(wildcards)] if machine_conditions.machine_loads(case) else []
    )
    return tables + (files_of(rules.scorecard, wildcards.case)[:1] if REPRODUCTION else [])


def report_values(wildcards):
    """All plain values of a case; `reproduction` says whether it is the machine of a publication."""
    case = wildcards.case
    return {**CASES[case], "reproduction": case == CASE and REPRODUCTION is not None}


def report_base(wildcards):
    """Name and values, as `report_values`, of the config file that the first one extends, if it does.

    A file that is no whole config has no values to compare with.
    """
    path = base_path(CONFIGFILES[0])
    if path is None:
        return None
    try:
        values = expand_cases(whole := load_config(path))[whole.case]
    except FacegearError:
        return None
    return [path.name, {**values, "reproduction": values["reproduction"] is not None}]


def where_made(stage, file):
    """Function of the wildcards giving a file of a stage, none where a case does not ask for it."""

    def files(wildcards):
        made = STAGES[stage].condition(case_of(wildcards.case))
        return [shared(stage, file)(wildcards)] if made else []

    return files


def report_pictures(wildcards):
    """Figures that the report of a case shows."""
    return [file for file in targets(wildcards.case) if file.endswith(".svg")]
