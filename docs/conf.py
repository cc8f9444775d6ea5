"""How Sphinx builds the documentation: `make docs`."""

import importlib.metadata
import sys
from pathlib import Path

from sphinx.application import Sphinx

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT))

project = "facegear"
author = "the facegear authors"
release = importlib.metadata.version("facegear")
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.apidoc", "sphinx.ext.napoleon"]
exclude_patterns = ["build", "joss"]
default_role = "literal"  # docstrings write names in single backticks
suppress_warnings = ["ref.python"]  # shapes in lists of fields, such as (meshes,), look like names of code
napoleon_use_ivar = True  # fields are listed once, by their class
myst_enable_extensions = ["dollarmath", "colon_fence"]
myst_heading_anchors = 4
apidoc_modules = [
    {
        "path": "../facegear",
        "destination": "api",
        "separate_modules": True,
        "module_first": True,
        "include_private": False,
    }
]
autodoc_typehints = "description"
autodoc_member_order = "bysource"
html_theme = "alabaster"
html_theme_options = {"page_width": "1100px", "sidebar_width": "240px"}
html_static_path = ["static"]
html_css_files = ["tables.css"]


def _with_references(app: Sphinx, name: str, source: list[str]) -> None:
    """Put stored tables into the pages that show them."""
    if name == "verification":
        import pandas as pd

        from validation.mutation.modules import mutation_tables, rows
        from validation.platforms import MEASURED, OUTCOMES, outcomes_table, platforms_table
        from validation.references import read, shares_table, verification_table

        source[0] = source[0].replace("{mutants}", mutation_tables(rows()))
        source[0] = source[0].replace("{platforms}", platforms_table(pd.read_csv(MEASURED)))
        source[0] = source[0].replace("{platform_tests}", outcomes_table(pd.read_csv(OUTCOMES)))
        source[0] = source[0].replace("{shares}", shares_table(read()))
        source[0] = source[0].replace("{references}", verification_table(read()))
    if name == "load_sharing":
        import pandas as pd

        from validation.sharing_advice import TABLE, advice_table

        source[0] = source[0].replace("{sharing_advice}", advice_table(pd.read_csv(TABLE)))


def setup(app: Sphinx) -> None:
    """What Sphinx calls before it reads a page."""
    app.connect("source-read", _with_references)
