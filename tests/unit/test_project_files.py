"""What stands beside the packages: the citation, the changelog, and the picture of the architecture."""

from __future__ import annotations

import importlib.util
import re
from pathlib import Path
from types import ModuleType

import pytest

import beamdyn

ROOT = Path(__file__).parents[2]
CITATION = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
REQUIRED = ("cff-version", "message", "title", "authors")  # by version 1.2.0 of the format


def top_level(text: str) -> dict[str, str]:
    """Keys at the margin of a YAML file and what follows on their lines."""
    return dict(re.findall(r"^([a-z-]+):[ ]?(.*)$", text, re.MULTILINE))


def test_the_citation_names_this_version() -> None:
    fields = top_level(CITATION)
    assert fields["version"].strip('"') == beamdyn.__version__
    assert fields["cff-version"] == "1.2.0"
    assert fields["license"] == "BSD-3-Clause"
    assert fields["type"] == "software"
    assert fields.keys() >= set(REQUIRED)


def test_lines_of_the_citation_are_plain_yaml() -> None:
    """No tabs, even indents, quotes closed, and no second colon in a text without quotes."""
    for line in CITATION.splitlines():
        indent = len(line) - len(line.lstrip(" "))
        assert "\t" not in line and indent % 2 == 0 and line.count('"') in (0, 2), line
        assert '"' in line or line.count(": ") <= 1, line


def test_the_changelog_has_this_version() -> None:
    text = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    assert f"## [{beamdyn.__version__}]" in text


@pytest.fixture(scope="module")
def drawing() -> ModuleType:
    """The script that draws the architecture, which stands in no package."""
    pytest.importorskip("grimp", reason="grimp, which import-linter brings, is not installed")
    spec = importlib.util.spec_from_file_location("draw_architecture", ROOT / "docs" / "draw_architecture.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("package", ["beamdyn", "brakes"])
def test_all_arrows_of_the_architecture_point_down(drawing: ModuleType, package: str) -> None:
    arrows = drawing.count_imports(package)
    assert len(arrows) > 20
    assert drawing.find_upward(arrows, drawing.read_layers(package)) == []


def test_arrows_that_do_not_point_down_are_found(drawing: ModuleType) -> None:
    layers = [["cli"], ["modal", "steady"], ["scene"]]
    arrows = {("cli", "scene"): 1, ("scene", "cli"): 1, ("modal", "steady"): 2}
    assert drawing.find_upward(arrows, layers) == [("scene", "cli"), ("modal", "steady")]


def test_an_arrow_is_left_out_only_where_a_path_implies_it(drawing: ModuleType) -> None:
    arrows = {("cli", "modal"): 1, ("modal", "scene"): 2, ("cli", "scene"): 3, ("cli", "output"): 4}
    assert drawing.leave_out_implied(arrows) == {k: n for k, n in arrows.items() if k != ("cli", "scene")}
