def compliance(body):
    """Function of the wildcards giving the compliance of a body, shared by all cases that differ in gaps alone."""
    return lambda wildcards: rules.compliance.output.arrays.format(
        case=sources("compliance")[wildcards.case], body=body
    )


def flanks(rule):
    """Function of the wildcards giving both compliances where machines among many of a rule have contacts of their own."""

    def files(wildcards):
        if not many_contacts(rule, CASES[wildcards.case]):
            return []
        return [compliance(body)(wildcards) for body in ("pinion", "face_gear")]

    return files
