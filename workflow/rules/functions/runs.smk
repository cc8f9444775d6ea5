ENVIRONMENT = str(ROOT / "workflow" / "envs" / "facegear.yaml").replace("{", "{{").replace("}", "}}")
"""Environment of all rules; Snakemake takes single braces, which a folder's name may have, for wildcards."""
RUN_LOCK = FileLock(".snakemake/facegear.lock")
"""Lock of the kernel's, which releases it when this process ends, however it ends."""


def require_folder():
    """End the run in one line where nothing can be written."""
    results = Path("results")
    if results.exists() and not results.is_dir():
        sys.exit(f"{results.absolute()} is a file; move it away, as results go there")
    for folder in (Path(), results):
        if folder.exists() and not os.access(folder, os.W_OK):
            sys.exit(f"{folder.absolute()} cannot be written; choose another folder with --directory")


def hold_folder():
    """Keep other runs out of this folder until this process ends."""
    try:
        RUN_LOCK.acquire(blocking=False)
    except Timeout:
        sys.exit(f"another run is working in {os.getcwd()}; wait for it or stop it first")
    except OSError as error:
        print(f"no lock in this folder ({error}): start no second run here", file=sys.stderr)


@cache
def code_of(script, functions):
    """Fingerprint of a script and of functions that it calls, found once a run and for rules with jobs alone."""
    return fingerprint(ROOT / script, ROOT, functions)


def code(script, *functions):
    """Function of the wildcards giving the fingerprint of a script, by its path from the repository's folder.

    As a parameter it makes jobs run again where code that they reach has changed.

    - functions: `module:function` of those that the script calls without importing them by name
    """
    return lambda wildcards: code_of(script, functions)
