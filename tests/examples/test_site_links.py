"""The link check of the site's build finds what it is to find, and nothing else."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import pytest

pytest.importorskip("sphinx")
BUILD = Path(__file__).parents[2] / "docs" / "build.py"


def test_dead_links_and_what_comes_from_a_network(tmp_path: Path) -> None:
    spec = importlib.util.spec_from_file_location("build_of_the_site", BUILD)
    assert spec and spec.loader
    build = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(build)
    (tmp_path / "sub").mkdir()
    (tmp_path / "index.html").write_text(
        '<h1 id="a&amp;b">A</h1><a class="x" href="sub/page.html#there">1</a> <a href="#a&amp;b">2</a>'
        '<a href="https://example.org/">3</a> <a data-href="nothing">4</a> <a href="sub/page.html?q=1">5</a>'
    )
    assert build.find_mistakes(tmp_path) == [
        "index.html: sub/page.html#there",
        "index.html: sub/page.html?q=1",
    ]
    (tmp_path / "sub" / "page.html").write_text(
        '<p id="there">P</p><a href="../index.html#gone">1</a><script src="https://example.org/a.js"></script>'
        '<img alt="" src="none.png"> <a href="../index.html#a%26b">2</a>'
    )
    assert build.find_mistakes(tmp_path) == [
        "sub/page.html: fetches https://example.org/a.js",
        "sub/page.html: ../index.html#gone",
        "sub/page.html: none.png",
    ]
