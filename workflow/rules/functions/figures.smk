DRAWN = [
    stage
    for stage in STAGES.values()
    if stage.figures and stage.condition and stage.condition(BASE) and stage.figures.figure_names(BASE)
]
"""Stages that the config asks for and of which there is something to draw."""
CHAPTERS = {
    chapter: [stage for stage in DRAWN if stage.figures.chapter == chapter]
    for chapter in dict.fromkeys(stage.figures.chapter for stage in DRAWN)
}
"""Stages that are drawn, by the chapter of the report."""


def drawn_inputs(stages):
    """Files that the figures of some stages are drawn from; the stage stands before each name."""
    return {
        f"{stage.name}__{name}": read_from(source, stage.name)
        for stage in stages
        for name, source in stage.figures.upstream.items()
    }


def drawn_needs(stages):
    """Function of the wildcards giving what the figures need of the config, by stage."""
    return lambda wildcards: {
        stage.name: values_needed(stage.figures.needs, wildcards.case, stage.name) for stage in stages
    }


def drawn_names(stages):
    """Names of the figures of some stages."""
    return [name for stage in stages for name in stage.figures.figure_names(BASE)]


def shown(name, chapter):
    """The svg of a figure, marked for Snakemake's report."""
    category = chapter.replace("_", " ").capitalize()
    file, text = f"results/{{case}}/figures/{name}.svg", f"../report/{chapter}.rst"
    return report(file, caption=text, category=category, labels={"figure": name})


def drawing_functions(stages):
    """Functions that draw the figures of some stages."""
    return sorted({stage.figures.draw for stage in stages})


def most_memory(stages):
    """Memory (MB) of the figures that need most of it, as a resource; none where the profile's is enough."""
    return resources(max((stage.figures.memory_mb or 0 for stage in stages)) or None)
