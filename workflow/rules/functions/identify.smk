from facegear.paper.config.reproduction import design_points
from facegear.paper.config.sections import design_chunks

IDENTIFY = REPRODUCTION.identify if REPRODUCTION else None
DESIGNS = list(design_points(IDENTIFY))
CLAIMS = REPRODUCTION.claims if REPRODUCTION else []
SEARCH = IDENTIFY.search if IDENTIFY else None


def searches(repeat, name):
    """Evaluations of one round of searches."""
    return [f"results/{{case}}/identify/search/{repeat}/{name}/{place}.csv" for place in range(SEARCH.places)]


SEARCHES = [
    one
    for repeat in range(SEARCH.repeats if SEARCH else 0)
    for name in ("first", "again")
    for one in searches(repeat, name)
]
LIKELY = [f"results/{{case}}/identify/likely/{part}.csv" for part in range(SEARCH.parts)] if SEARCH else []
STORED_SETS = REPRODUCTION.sets if REPRODUCTION and REPRODUCTION.sets else []

DRAWN = {"ranges": True, "random": {"seed"}}
"""On what random inputs depend, of section `identify`."""
SEARCH_KEYS = {"by_mean", "by_upper", "again_within", "population", "generations", "starts", "seed"}
"""On what a search depends, of its own section."""


def identify_values(**kept):
    """Values of section `identify` that a job depends on, whole parts (True) or some keys of a part."""
    return IDENTIFY.model_dump(mode="json", include=kept) if IDENTIFY else None


def searched_before(wildcards):
    """The first searches of a repeat, from which those that are made again start."""
    return (
        expand(searches(wildcards.repeat, "first"), case=wildcards.case) if wildcards.round == "again" else []
    )


def judged_sets():
    """The config's own inputs, and the sets that fit about as well."""
    if not STORED_SETS:
        return ["config"]
    from facegear.paper.identify.sets import stored_sets

    return ["config", *stored_sets(STORED_SETS)]


def random_chunks(design):
    """Function of the wildcards giving the chunk files of a design of random inputs."""
    chunks = design_chunks(IDENTIFY.random, design) if IDENTIFY else []
    return [f"results/{{case}}/identify/chunks/{design}_{first}_{last}.csv" for first, last in chunks]
