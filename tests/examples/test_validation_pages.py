"""The build of the site writes the validation manual anew if what its numbers follow from has changed."""

from __future__ import annotations

import json
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

import pytest

EXTENSION = Path(__file__).parents[2] / "docs" / "_ext" / "validation_pages.py"


@pytest.fixture
def site(tmp_path, monkeypatch):
    """A repository with a manual of one page, and a module and a table behind it; what was written."""
    spec = spec_from_file_location("validation_pages", EXTENSION)
    assert spec is not None and spec.loader is not None
    pages = module_from_spec(spec)
    spec.loader.exec_module(pages)
    folder, module, table = (
        tmp_path / "generated",
        tmp_path / "beamdyn" / "a.py",
        tmp_path / "beamdyn" / "b.toml",
    )
    module.parent.mkdir()
    for file, text in ((module, "x = 1"), (table, "y = 2"), (tmp_path / "index.md", "generated/overview\n")):
        file.write_text(text)
    settings = {"ROOT": tmp_path, "INDEX": tmp_path / "index.md", "FOLDER": folder}
    for name, value in settings.items():
        monkeypatch.setattr(pages, name, value)
    monkeypatch.setattr(pages, "modules", lambda: {"beamdyn/a.py"})
    written = []

    def write_pages(to: Path) -> None:
        to.mkdir(exist_ok=True)
        written.append(module.read_text())
        (to / "overview.md").write_text(written[-1])

    monkeypatch.setattr("benchmarks.validation_manual.write_pages", write_pages)
    pages.write(None)
    return pages, tmp_path, written


def test_it_is_written_once_as_long_as_nothing_changes(site):
    pages, root, written = site
    (root / "beamdyn" / "a.py").touch()
    (root / "beamdyn" / "unrelated.py").write_text("z = 3")
    pages.write(None)
    assert written == ["x = 1"]


@pytest.mark.parametrize("change", ["a.py", "b.toml", "c.toml"])
def test_it_is_written_anew_when_code_or_data_has_changed(site, change):
    """Or is new."""
    pages, root, written = site
    (root / "beamdyn" / change).write_text("x = 5")
    pages.write(None)
    pages.write(None)
    assert len(written) == 2


@pytest.mark.parametrize("lost", ["beamdyn/b.toml", "generated/overview.md", "generated/sources.json"])
def test_it_is_written_anew_when_something_is_missing(site, lost):
    pages, root, written = site
    (root / lost).unlink()
    pages.write(None)
    assert len(written) == 2


def test_it_is_written_anew_when_a_module_is_gone(site):
    pages, root, written = site
    record = root / "generated" / "sources.json"
    record.write_text(json.dumps(json.loads(record.read_text()) | {"beamdyn/gone.py": "1"}))
    pages.write(None)
    assert len(written) == 2


def test_a_writing_that_fails_is_repeated(site, monkeypatch):
    pages, root, written = site
    (root / "beamdyn" / "a.py").write_text("x = 5")
    with monkeypatch.context() as broken:
        broken.setattr("benchmarks.validation_manual.write_pages", lambda to: 1 / 0)
        with pytest.raises(ZeroDivisionError):
            pages.write(None)
    (root / "beamdyn" / "a.py").write_text("x = 1")
    pages.write(None)
    assert len(written) == 2
