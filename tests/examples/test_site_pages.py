"""Which pages of the site are looked at in a browser."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks.site_pages import OF_EACH_KIND, pages_of


@pytest.fixture
def site(tmp_path: Path) -> Path:
    """A site with two pages of each kind, and what is no page of it."""
    for pattern in OF_EACH_KIND:
        page = tmp_path / pattern.replace("*", "a")
        page.parent.mkdir(parents=True, exist_ok=True)
        page.touch()
    for more in ("gallery/a/b.html", "further.html", "_static/part.html"):
        page = tmp_path / more
        page.parent.mkdir(parents=True, exist_ok=True)
        page.touch()
    return tmp_path


def test_one_page_of_each_kind(site: Path) -> None:
    found = pages_of(site, every=False)
    assert len(found) == len(OF_EACH_KIND) == len(set(found))
    assert site / "gallery" / "a" / "a.html" in found


def test_all_pages_of_the_site(site: Path) -> None:
    found = pages_of(site, every=True)
    assert len(found) == len(OF_EACH_KIND) + 2
    assert not any("_static" in page.parts for page in found)
