from facegear.validation.contact.refinement_levels import RUNGS


def contact_benchmark_targets(case):
    """Tables that `make benchmarks` writes for the contact stage."""
    return [f"results/{case}/benchmarks/{name}.csv" for name in ("contact", "contact_shortcuts", "twin")]
