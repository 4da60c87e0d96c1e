"""How Sphinx builds the site: ``python docs/build.py`` (see docs/README.md)."""

import sys
from pathlib import Path

sys.path[:0] = [str(Path(__file__).parents[1]), str(Path(__file__).parent / "_ext")]

from sphinx_gallery.sorting import FileNameSortKey  # noqa: E402

from beamdyn import __version__  # noqa: E402

project = "beamdyn and brakes"
author = "The beamdyn developers"
copyright = author
version = release = __version__

extensions = [
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.viewcode",
    "numpydoc",
    "myst_parser",
    "sphinx_copybutton",
    "sphinx_gallery.gen_gallery",
    "gallery_pages",  # notes what examples ran when they have run
    "mathml",  # this, the one above and the next ones: docs/_ext
    "docstring_bars",
    "docstring_pages",
    "repository_pages",
    "validation_pages",
    "analyses_page",
    "errors_page",
    "file_keys",
]
exclude_patterns = ["build", "_ext", "_templates", "**/GALLERY_HEADER.rst"]
templates_path = ["_templates"]
suppress_warnings = ["config.cache"]  # the classes that sort the gallery are not pickled
nitpicky = True
nitpick_ignore_regex = [
    ("py:obj", ".*")
]  # `error` in a docstring is a word of code, and a link where it can be
default_role = "obj"

# Pages in Markdown
myst_enable_extensions = ["dollarmath", "deflist", "colon_fence"]
myst_heading_anchors = 3

# Docstrings
autosummary_generate = True
autosummary_ignore_module_all = False
autodoc_typehints = "none"  # numpydoc's types have shapes, too
autodoc_member_order = "bysource"
numpydoc_show_class_members = False
numpydoc_xref_param_type = False
copybutton_prompt_text = r">>> |\.\.\. |\$ "
copybutton_prompt_is_regexp = True

# Gallery
sphinx_gallery_conf = {
    "examples_dirs": "../examples/gallery",
    "gallery_dirs": "gallery",
    "filename_pattern": r"\.py$",  # all are executed
    "within_subsection_order": FileNameSortKey,
    "abort_on_example_error": True,
    "download_all_examples": False,
    "show_memory": False,
    "write_computation_times": False,  # that page fetches scripts from a network
    "remove_config_comments": True,
    "reset_modules": ("matplotlib",),
    "plot_gallery": "True",
}

# Page
html_theme = "pydata_sphinx_theme"
html_title = "beamdyn and brakes"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_js_files = ["site.js"]
html_sidebars = {"tour": []}  # no pages below it
html_math_renderer = "mathml"
html_copy_source = False
html_show_sourcelink = False
html_theme_options = {
    "navbar_align": "left",
    "header_links_before_dropdown": 8,
    "show_toc_level": 2,
    "navigation_with_keys": False,
    "show_prev_next": True,
    "footer_start": ["copyright"],
    "footer_end": ["sphinx-version"],
    "pygments_light_style": "a11y-high-contrast-light",
    "pygments_dark_style": "a11y-high-contrast-dark",
}
