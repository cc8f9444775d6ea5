def compliance(body):
    """Function of the wildcards giving the compliance of a body, shared by all cases that differ in gaps alone."""
    return lambda wildcards: rules.compliance.output.arrays.format(
        case=sources("compliance")[wildcards.case], body=body
    )
