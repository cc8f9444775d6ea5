from facegear.pipeline.stage import FIGURES

DRAWN = [stage for stage in STAGES.values() if stage.figures and stage.figures.named(BASE)]
"""Stages of which there is something to draw."""
TITLES = {stage.name: stage.title for stage in STAGES.values()} | {
    f"{stage.name}{FIGURES}": f"Figures: {stage.title[0].lower()}{stage.title[1:]}" for stage in DRAWN
}
MODULES = {stage.name: stage.modules for stage in STAGES.values()} | {
    f"{stage.name}{FIGURES}": (stage.figures.draw.partition(":")[0],) for stage in DRAWN
}
"""Modules that decide the files of a rule, beside its script."""


def machine_code_of(rule):
    """Functions that load what jobs of a rule run, with their arguments."""
    codes = [STAGES[name] for name in STAGES[rule].runs] if rule in STAGES else []
    return [(code.function, resolved_needs(code.needs, BASE)) for code in codes]


def inputs(upstream, stage):
    """Files of earlier stages that a stage, or its figures, take, each from the case whose files are shared."""
    return {name: read_from(source, stage.name) for name, source in upstream.items()}


def outputs(stage):
    """Paths of a stage's files by name; a list where it writes several of a kind."""
    return {
        name: (
            [f"results/{{case}}/{file.at({'each': each})}" for each in file.each(BASE)]
            if file.each
            else f"results/{{case}}/{file.path}"
        )
        for name, file in stage.files.items()
    }


def pictures(figures):
    """Lists `svg`, `png` and `json` of the files of figures; the first are marked for Snakemake's report."""
    names = figures.named(BASE)
    return {
        "svg": [shown(name, figures.chapter) for name in names],
        "png": [f"results/{{case}}/figures/{name}.png" for name in names],
        "json": [f"results/{{case}}/figures/{name}.json" for name in names],
    }


def shown(name, chapter):
    """The svg of a figure, marked for Snakemake's report."""
    category = chapter.replace("_", " ").capitalize()
    file, text = f"results/{{case}}/figures/{name}.svg", f"../report/{chapter}.rst"
    return report(file, caption=text, category=category, labels={"figure": name})


def resources(memory_mb=None, minutes=None):
    """Resources of a job beyond what the profile gives each."""
    known = {"mem_mb": memory_mb, "runtime": minutes}
    return {name: value for name, value in known.items() if value is not None}
