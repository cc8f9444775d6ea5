RUN_LOCK = FileLock(".snakemake/facegear.lock")
"""Lock of the kernel's, which releases it when this process ends, however it ends."""


def hold_folder():
    """Keep other runs out of this folder until this process ends."""
    try:
        RUN_LOCK.acquire(blocking=False)
    except Timeout:
        sys.exit(f"another run is working in {os.getcwd()}; wait for it or stop it first")
    except OSError as error:
        print(f"no lock in this folder ({error}): start no second run here", file=sys.stderr)


@cache
def code_of(script, modules):
    """Fingerprint of a script and of the modules that it calls, found once a run and for rules with jobs alone."""
    return fingerprint(ROOT / script, ROOT, modules)


def code(script, *modules):
    """Function of the wildcards giving the fingerprint of a script, by its path from the repository's folder.

    As a parameter of a rule it makes jobs run again where code that they reach has changed. `modules`: those that
    the script calls without importing them by name.
    """
    return lambda wildcards: code_of(script, modules)
