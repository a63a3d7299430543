"""The book: Sphinx, Markdown by MyST, mathematics drawn while building, one page per model."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent / "_ext"))

project = "Lesk"
author = "The Lesk authors"
copyright = author
language = "en"
exclude_patterns = ["generated", "pictures", "tests"]

extensions = [
    "gallery_pages",
    "model_pages",
    "myst_parser",
    "numpydoc",
    "pictures",
    "scene_pages",
    "sphinx.ext.autodoc",
    "sphinxcontrib.bibtex",
    "svg_math",
]
myst_enable_extensions = ["amsmath", "colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3
myst_links_external_new_tab = False

bibtex_bibfiles = ["../references.bib"]
bibtex_reference_style = "author_year"
numpydoc_show_class_members = False
autodoc_member_order = "bysource"
autodoc_typehints = "none"
# names in single backticks, as in Markdown
default_role = "code"

html_math_renderer = "svg"
html_theme = "furo"
html_title = "Lesk"
html_static_path = ["_static"]
html_css_files = ["lesk.css"]
html_copy_source = False
# every formula and every page can be read without a network
html_theme_options = {"source_repository": "", "top_of_page_buttons": []}
