"""Machines with their tolerances, and designs that are searched."""

from facegear.pipeline import arguments, conditions, machine_conditions
from facegear.pipeline.rows.common_needs import (
    ACCURACY,
    ELASTIC_GEARS,
    HARMONICS,
    OPTIONS,
    PAIR,
    SHARING,
    SPEED,
)
from facegear.pipeline.stage import NUMBER, ComputedValue, Figures, File, From, Needs, Stage, from_stage

CAUSES = tuple(f"tolerances.{key}" for key in ("causes", "correlations", "model", "seed", "hunting_cycles"))
"""Keys that decide what samples are drawn."""
SOLID = ComputedValue(machine_conditions.solid_pair, ("transmission", "tooth_pair"))
"""Tooth pair where bodies that bend depend on it."""
SAMPLE_NEEDS: Needs = {
    **SHARING,
    "tolerances": CAUSES,
    "pair": ComputedValue(arguments.pair_where(arguments.sampled_contact), conditions.PAIR_SECTIONS),
    "lubrication_sections": ComputedValue(arguments.lubricated_samples, ("lubrication", "tooth_pair")),
    "solid": SOLID,
}
"""Needs of the samples of tolerances."""
SAMPLED_FROM = {
    **HARMONICS,
    **ELASTIC_GEARS,
    **{name: From("contact", name, when=arguments.stored_rubbing) for name in ("ltca", "pressure")},
    "flanks": From(
        "compliance", "arrays", each_wildcards=arguments.both_bodies, when=arguments.sampled_contact
    ),
}
"""Sources of the samples of tolerances."""
SEARCH_NEEDS: Needs = {
    **PAIR,
    **ACCURACY,
    **SPEED,
    "transmission": "transmission",
    "options": OPTIONS,
    "search": "search",
    "tolerances": "tolerances",
    "pair": ComputedValue(arguments.pair_where(arguments.searched_contact), conditions.PAIR_SECTIONS),
    "solid": SOLID,
}
"""Needs of the search."""
SEARCHED_FROM = {
    **HARMONICS,
    **ELASTIC_GEARS,
    "flanks": From(
        "compliance", "arrays", each_wildcards=arguments.both_bodies, when=arguments.searched_contact
    ),
}
"""Sources of the search."""

ROWS = (
    Stage(
        name="tolerances_chunk",
        module="studies",
        title="Samples of the machine with its tolerances",
        needs=SAMPLE_NEEDS,
        section="tolerances",
        upstream=SAMPLED_FROM,
        files={"chunk": File("tolerances/chunks/{design}_{first}_{last}.parquet")},
        wildcards={"design": "samples|indices", "first": NUMBER, "last": NUMBER},
        resumable="chunk",
    ),
    Stage(
        name="tolerances",
        module="studies",
        title="Percentiles, fractions and Sobol indices",
        needs={"tolerances": "tolerances"},
        section="tolerances",
        upstream={
            design: From("tolerances_chunk", "chunk", each_wildcards=arguments.tolerance_chunks(design))
            for design in ("samples", "indices")
        },
        files={
            "samples": File("tolerances/samples.parquet", ("sample", "error")),
            "percentiles": File(
                "tolerances/percentiles.csv",
                ("percentile", "value"),
                may_be_empty=True,
                text=("quantity",),
            ),
            "fractions": File("tolerances/fractions.csv", ("fraction",)),
            "importance": File("tolerances/importance.csv", text=("quantity", "cause")),
            "indices": File("tolerances/indices.csv", may_be_empty=True, text=("quantity", "cause")),
            "sampling": File("tolerances/sampling.csv", may_be_empty=True),
        },
        figures=Figures(
            draw="facegear.report.figures.tolerances:tolerances_figures",
            names=("tolerance_distributions", "tolerance_importance", "tolerance_scatter"),
            chapter="tolerances",
            upstream=from_stage("tolerances", "samples", "percentiles", "importance", "indices"),
        ),
        condition=machine_conditions.tolerances,
        local=True,
    ),
    Stage(
        name="tolerances_map",
        module="studies",
        title="Percentiles over torque and speed",
        needs={**SAMPLE_NEEDS, "tolerances": (*CAUSES, "tolerances.confidence", "tolerances.load_map")},
        section="tolerances",
        upstream=SAMPLED_FROM,
        files={
            "load_map": File(
                "tolerances/load_map.csv",
                ("torque_factor", "speed_rpm", "percentile", "value"),
                may_be_empty=True,
                text=("quantity",),
            ),
            "load_fractions": File(
                "tolerances/load_fractions.csv", ("torque_factor", "speed_rpm", "fraction")
            ),
            "load_sampling": File("tolerances/load_sampling.csv", may_be_empty=True),
        },
        figures=Figures(
            draw="facegear.report.figures.tolerances:map_figures",
            names=("tolerance_map",),
            chapter="tolerances",
            upstream=from_stage("tolerances_map", "load_map"),
        ),
        condition=machine_conditions.load_map,
        resumable="load_map",
        minutes=240,
    ),
    Stage(
        name="search_island",
        module="search",
        title="Evolution of designs from one seed",
        needs=SEARCH_NEEDS,
        section="search",
        upstream=SEARCHED_FROM,
        files={"designs": File("search/islands/{seed}.parquet")},
        wildcards={"seed": NUMBER},
        resumable="designs",
        minutes=240,
    ),
    Stage(
        name="search",
        title="Front of all islands, and its winners at full accuracy",
        needs=SEARCH_NEEDS,
        section="search",
        upstream={
            **SEARCHED_FROM,
            "islands": From("search_island", "designs", each_wildcards=arguments.islands),
        },
        files={
            "designs": File("search/designs.parquet", ("generation", "seed", "error")),
            "front": File("search/front.csv", may_be_empty=True),
            "hypervolume": File("search/hypervolume.csv", ("hypervolume",), may_be_empty=True),
            "winners": File("search/winners.csv", ("design",), text=("design",)),
        },
        figures=Figures(
            draw="facegear.report.figures.comparison:search_figures",
            names=("search_front", "search_hypervolume"),
            chapter="search",
            upstream=from_stage("search", "designs", "front", "hypervolume", "winners"),
            needs={"objectives": "search.objectives"},
        ),
        condition=machine_conditions.search,
        minutes=60,
    ),
)
"""Stages on tolerances and search."""
