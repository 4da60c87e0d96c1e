"""The site's tables of keys: all of them, from the descriptions that files are read by."""

from __future__ import annotations

import re
import subprocess
import sys
import tomllib
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType

import pytest

from beamdyn.files.scene_inputs import SceneInput
from brakes.config.drum import DrumInput
from brakes.config.forklift import ForkliftInput
from brakes.config.mechanism import CompleteMechanismInput
from brakes.config.vehicle import VehicleInput
from brakes.planar import JOINTS, LOADS

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "input_files.md"


def extension() -> ModuleType:
    spec = spec_from_file_location("file_keys", ROOT / "docs" / "_ext" / "file_keys.py")
    assert spec is not None and spec.loader is not None
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_page_has_the_tables_of_all_files() -> None:
    source = [PAGE.read_text(encoding="utf-8")]
    extension().write_tables(None, "input_files", source)
    assert "<!-- keys" not in source[0]
    for heading in ("### `[beam.tip]`", "### `[second_shoe]`", "### `[levers]`", "### `[[rotation_lock]]`"):
        assert heading in source[0]


def test_the_page_of_examples_lists_each_with_what_it_is() -> None:
    source = [(ROOT / "docs" / "examples.md").read_text(encoding="utf-8")]
    extension().write_tables(None, "examples", source)
    for file in (ROOT / "examples").glob("**/*.toml"):
        assert f"({Path('..') / file.relative_to(ROOT)}): " in source[0]
    assert "Yoo et al. (1997), which reverses down a slope with its load and stops with locked" in source[0]


@pytest.mark.parametrize(
    ("section", "file"),
    [
        (SceneInput, "rolling_harvester"),
        (SceneInput, "patched"),
        (SceneInput, "twisted_blade"),
        (DrumInput, "drum"),
        (ForkliftInput, "forklift"),
        (VehicleInput, "vehicle"),
    ],
)
def test_keys_of_an_example_are_in_its_tables(section: type, file: str) -> None:
    text = extension().tables_of(section)
    given = tomllib.loads((ROOT / "examples" / f"{file}.toml").read_text(encoding="utf-8"))
    for table, keys in given.items():
        for key, value in keys.items():
            place = (
                f"### `[{table}.{key}]`"
                if isinstance(value, dict) and "values" not in value
                else f"| `{key}` |"
            )
            assert place in text, (table, key)


def test_rows_say_unit_bound_default_and_where_a_key_belongs() -> None:
    text = extension().tables_of(SceneInput)
    assert "| `width` | width of the section [m], greater than 0 | **required** | rectangular |" in text
    assert "| `law` | law of the spin-up: smooth, linear | smooth | `spin_up` |" in text
    assert not re.search(r"Input \|$", text, re.MULTILINE)  # no name of a class


def test_tables_that_may_be_repeated_have_two_brackets() -> None:
    assert "### `[[beam.point_mass]]`" in extension().tables_of(SceneInput)
    text = extension().tables_of(CompleteMechanismInput)
    assert "### `[run]`" in text and all(f"### `[[{part.key()}]]`" in text for part in (*JOINTS, *LOADS))


def test_the_default_of_a_kind_is_its_name() -> None:
    assert "sampled_translation | steady |" in extension().tables_of(SceneInput)


def test_the_page_of_mechanisms_has_every_part() -> None:
    page = (ROOT / "docs" / "mechanisms.md").read_text(encoding="utf-8")
    parts = page.partition("## Parts")[2].partition("##")[0]
    listed = re.findall(r"^\| `(\w+)` \|", parts, re.MULTILINE)
    assert listed == [part.key() for part in (*JOINTS, *LOADS)]


def test_the_repository_prints_the_page_with_all_keys() -> None:
    command = "docs/_ext/file_keys.py"
    assert f"python {command}" in PAGE.read_text(encoding="utf-8")
    made = subprocess.run(
        [sys.executable, command], cwd=ROOT, capture_output=True, encoding="utf-8", check=True
    )
    assert "<!-- keys" not in made.stdout and "| `bending_stiffness` |" in made.stdout
    assert "above the drum's centre; its arm about the pin is a + c" in made.stdout
