"""Fingerprint of the code that a stage can reach, function by function.

Snakemake does not see changes of an imported package. A rule that carries this fingerprint as a parameter
reruns when code that it can reach has changed. A function reaches the closure of the names that it uses:

- A function counts with its code, its decorators and default values. A class counts whole, with its bases
  and methods. A constant counts with the statement that makes it: a table of functions counts with them.
- A module counts whole where it is used as a value (`getattr(module, name)`, an argument), where a name is
  not found in it, and where another module imports everything of it. So does a module whose own code reaches
  names that it does not spell (`globals`, `import_module` of a variable, `sys.modules`, an unknown name).
- Of every module that is imported on the way, those statements count that may do more than bind their names:
  calls of ours, decorators of ours, whatever is no definition.
- Templates count with the modules of their package, compiled kernels by the text of all their sources.
- Comments, docstrings and layout do not count. Annotations count for fields of classes, for functions with
  decorators that may read them, and for the arguments of a function that a row of the table names, which
  `facegear.pipeline.arguments` reads.

Why this suffices: let a stage call a function of ours. It was called by its name, as a value, or through an
object. By its name, it is in the closure of its caller. As a value, some code named it where the value was
made. Through an object, the object's class was named where the object was made, and a class counts whole.
This holds even if a function returns the object and the caller never names the class: the function that makes
the object is called, too, and names it. Objects that no called function makes are arguments of the stage:
plain values, tables and arrays from files, or sections of the config, whose classes the annotations name. A
library that calls us back was handed a function as a value, or an object. Code that an import runs is in the
statements that count of each imported module. By induction over the calls, each called function is in the
closure. The conditions are that no class of ours is made by a metaclass or found through `__subclasses__`,
that nothing is unpickled, and that annotations are read in one place alone. A test looks for all of them.
"""

from collections.abc import Sequence
from pathlib import Path

from facegear.pipeline.provenance.closure import Closure

_closures: dict[str, Closure] = {}
"""By folder of the packages: the closure of their files as they were when it was last asked."""


def fingerprint(script: str | Path, root: str | Path, functions: Sequence[str] = ()) -> str:
    """Compute the hash of a script and of all code of the packages that it reaches.

    Where the script calls functions that it does not import by name, their own fingerprint follows
    behind a dot, so that results can be known without the script. A module that the script imports by
    its name as text is none of its code.

    Parameters
    ----------
    script : str or Path
        The script.
    root : str or Path
        Folder of the packages.
    functions : sequence of str
        Functions that the script calls, as ``module:name``.

    Returns
    -------
    str
        Sixteen hexadecimal digits, and as many for the functions behind a dot where there are any.
    """
    closure = _closure(root)
    code = closure.digest(closure.search(closure.add_script(Path(script))))
    return f"{code}.{stage_fingerprint(functions, root)}" if functions else code


def stage_fingerprint(functions: Sequence[str], root: str | Path) -> str:
    """Compute the hash of functions and of all code of the packages that they reach.

    Parameters
    ----------
    functions : sequence of str
        Functions as ``module:name``; a module alone counts whole.
    root : str or Path
        Folder of the packages.

    Returns
    -------
    str
        Sixteen hexadecimal digits.
    """
    closure = _closure(root)
    return closure.digest(closure.search(closure.find_functions(functions)))


def reached_functions(functions: Sequence[str], root: str | Path) -> set[str]:
    """Find the functions, classes and constants of the packages whose code counts in the fingerprint of
    some functions.

    Parameters
    ----------
    functions : sequence of str
        Functions as ``module:name``; a module alone counts whole.
    root : str or Path
        Folder of the packages.

    Returns
    -------
    set of str
        Their names as ``module:name``.
    """
    closure = _closure(root)
    return closure.names(closure.search(closure.find_functions(functions)))


def loaded_modules(functions: Sequence[str], root: str | Path) -> set[str]:
    """Find the modules of the packages that are imported when some functions are imported and called.

    Parameters
    ----------
    functions : sequence of str
        Functions as ``module:name``; a module alone counts whole.
    root : str or Path
        Folder of the packages.

    Returns
    -------
    set of str
        Dotted names.
    """
    closure = _closure(root)
    return closure.modules(closure.search(closure.find_functions(functions)))


def _closure(root: str | Path) -> Closure:
    """Return the search over a folder of packages; it is made anew if one of the files that it has read
    changed.
    """
    key = str(root)
    if key not in _closures or not _closures[key].is_current:
        _closures[key] = Closure(key)
    return _closures[key]
