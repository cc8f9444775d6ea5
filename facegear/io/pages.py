"""Self-contained HTML pages from templates."""

from pathlib import Path
from typing import Any

from facegear.errors import extras_named

with extras_named():
    import jinja2


def render(template: Path, **values: Any) -> str:
    """Fill a template.

    Parameters
    ----------
    template : Path
        Jinja2 template.
    **values : Any
        Values by the names that the template uses; texts are escaped. A name that is missing is an error.

    Returns
    -------
    str
        The page.
    """
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(template.parent),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    return environment.get_template(template.name).render(**values)
