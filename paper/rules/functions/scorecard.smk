def whole_case(wildcards):
    """All plain values of a case's config."""
    return CASES[wildcards.case]


def stored(key):
    """File of stored results that the reproduction names under a key, if it does."""
    return getattr(REPRODUCTION, key) or [] if REPRODUCTION else []
