"""How Sphinx builds the documentation: `sphinx-build -W docs docs/_build`."""

import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE / "extensions"))

project = "fem-impact"
author = "the fem-impact developers"
extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.napoleon",
    "sphinx_gallery.gen_gallery",
    "program_tables",
    "mathml",
    "described",
]
myst_enable_extensions = ["colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 4
exclude_patterns = ["_build", "examples", "extensions", "notebooks", "plots", "templates"]
templates_path = ["templates"]
default_role = "py:obj"  # names in single backticks: code, and a link where the name is documented
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_default_options = {"members": True, "show-inheritance": True}
napoleon_google_docstring = False
napoleon_use_ivar = True
# attributes of docstrings are looked up by bare names such as e, which several classes have
suppress_warnings = ["ref.python"]
# scripts that are run while the documentation is built, and become pages and notebooks
sphinx_gallery_conf = {
    "examples_dirs": ["notebooks", "plots"],
    "gallery_dirs": ["tutorials/notebook", "gallery"],
    "filename_pattern": r"\.py$",
    "abort_on_example_error": True,
    "download_all_examples": False,
    "image_srcset": ["2x"],
    "show_signature": False,
    "show_memory": False,
    "reset_modules": ("matplotlib", "look.colour_blind_safe"),
}
html_theme = "furo"
html_static_path = ["style"]
html_css_files = ["tables.css"]
html_title = "fem-impact"
html_copy_source = False
html_show_copyright = False
html_math_renderer = "mathml"
