"""Sphinx: pages in Markdown, examples as a gallery, the rest generated from the package by ``_ext``."""

import os
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent / "_ext"))
os.environ.setdefault("MPLBACKEND", "Agg")

import axlespan

project = "axlespan"
author = "the axlespan developers"
project_copyright = "the axlespan developers, BSD-3-Clause"
release = version = axlespan.__version__

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.napoleon",
    "sphinx.ext.mathjax",
    "sphinx.ext.viewcode",
    "sphinx_gallery.gen_gallery",
    "sphinx_copybutton",
    "made_pages",
]
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}
exclude_patterns = [
    "_build",
    "_ext",
    "_static",
    "gallery/*",
    "made/gallery/*.ipynb",
    "**/*.py.md5",
    "**/sg_execution_times.rst",
]
language = "en"
html_theme = "furo"
html_title = f"axlespan {release}"
html_static_path = ["_static"]
html_css_files = ["pages.css"]
html_show_sourcelink = False
suppress_warnings = ["config.cache"]  # the gallery's configuration holds functions

# Equations are drawn by a copy of MathJax that comes along: the pages need no server.
mathjax_path = "mathjax-tex-svg.js"
myst_enable_extensions = ["dollarmath", "colon_fence", "deflist", "attrs_block"]
myst_heading_anchors = 3
mathjax3_config = {
    "svg": {"scale": 0.92},
    "tex": {"tags": "none", "macros": {"tag": ["\\qquad (\\text{#1})", 1]}},
}

napoleon_numpy_docstring = True
napoleon_google_docstring = False
napoleon_use_rtype = False
autodoc_typehints = "signature"
autodoc_typehints_format = "short"
autodoc_member_order = "bysource"
python_use_unqualified_type_names = True
python_maximum_signature_line_length = 100
autosummary_generate = True

sphinx_gallery_conf = {
    "examples_dirs": "gallery",
    "gallery_dirs": "made/gallery",
    "filename_pattern": r"/plot_",
    "within_subsection_order": "FileNameSortKey",
    "download_all_examples": False,
    "show_signature": False,
    "remove_config_comments": True,
    "abort_on_example_error": True,
    "nested_sections": False,
    "write_computation_times": False,
    "capture_repr": (),
}
