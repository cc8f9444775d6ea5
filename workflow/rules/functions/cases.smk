@cache
def sources(stage):
    """For each case the case whose files of a stage it shares."""
    return shared_sources(CASES, stage)


def case_of(name):
    """A case among the cases of the config."""
    return Case(CASES[name], CASES, lambda stage, case: sources(stage)[case])


BASE = case_of(CASE)


def asked_case(stage, name):
    """A case; ends the run where its config lacks the section that a stage is about."""
    try:
        require_section(stage, CASES[name])
    except FacegearError as error:
        sys.exit(f"{name}: {error}")
    return case_of(name)


def files_read(source, name, reader=None):
    """Files of an earlier stage that an argument of a reader is read from, for a case; a list if several."""
    file, case = STAGES[source.stage].files[source.file], asked_case(reader, name)
    several = source.each_wildcards or file.each_text
    texts = [{"each": text} for text in file.each_text(BASE)] if file.each_text else [{}]
    found = []
    for place in source.file_wildcards(case) if source.is_needed(case) else []:
        place = {"case": name, **place}
        shared_by = sources(source.stage)[place["case"]]
        found += [f"results/{shared_by}/{file.at({**place, **text})}" for text in texts]
    return found if several or not found else found[0]


def read_from(source, reader=None):
    """Function of the wildcards giving the files that an argument of a reader is read from."""
    return lambda wildcards: files_read(source, wildcards.case, reader)


def given(stage, argument):
    """Function of the wildcards giving the files that an argument of a stage is read from."""
    return read_from(STAGES[stage].upstream[argument], stage)


def shared(stage, file, **where):
    """Function of the wildcards giving a file of an earlier stage, shared by all cases alike up to it."""
    return read_from(From(stage, file, where))


def values_needed(needs, name, reader=None):
    """Values of the needs of a reader, for a case."""
    try:
        return resolved_needs(needs, asked_case(reader, name))
    except FacegearError as error:
        sys.exit(f"{name}: {error}")


def needed(needs, reader=None):
    """Function of the wildcards giving values of the needs of a reader."""
    return lambda wildcards: values_needed(needs, wildcards.case, reader)


def value_of(key):
    """Function of the wildcards giving a value of a case's config; a dotted key reaches inside."""
    return lambda wildcards: value_at(CASES[wildcards.case], key)


def values_of(*keys, **renamed):
    """Config values as params: sections under their own names, dotted keys under the names given."""
    return {name: value_of(key) for name, key in {**dict(zip(keys, keys)), **renamed}.items()}


def sections(*keys):
    """Function of the wildcards giving these keys of a case's config, as a config of its own."""
    return lambda wildcards: {key: CASES[wildcards.case][key] for key in keys}
