"""Classes of elements: each has a rule, as no style sheet is made in the browser for those that come up."""

import re
from pathlib import Path

import pytest

nicegui = pytest.importorskip("nicegui", reason="NiceGUI, the extra 'app', is missing")

from beamdyn.common.screens.page import STYLE  # noqa: E402

ROOT = Path(__file__).parents[2]
TOOLKIT = ("quasar.unimportant.css", "quasar.important.css", "nicegui.css")


def test_each_class_of_an_element_has_a_rule():
    static = Path(nicegui.__file__).parent / "static"
    sheets = [STYLE, *((static / name).read_text(encoding="utf-8") for name in TOOLKIT)]
    ruled = set(re.findall(r"\.([a-zA-Z][\w-]*)", "".join(sheets)))
    sources = [file for package in ("beamdyn", "brakes") for file in (ROOT / package).rglob("screens/*.py")]
    used = re.findall(r'\.classes\(\s*(?:add=)?f?"([^"]*)"', "".join(f.read_text("utf-8") for f in sources))
    assert len(used) > 50
    assert {name for names in used for name in names.split()} - ruled == set()
