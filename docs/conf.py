"""Configuration with which Sphinx builds the documentation: `make docs`."""

import importlib.metadata
import sys
from pathlib import Path

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
