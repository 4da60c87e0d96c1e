"""Every example of a caliper or mechanism runs through the command."""

from __future__ import annotations

from pathlib import Path

import pytest

from brakes import calipers
from brakes.cli import main

FILES = sorted((Path(__file__).parents[2] / "examples" / "calipers").glob("*.toml"))


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_example_runs(path, finished):
    out, err = finished(main(["caliper", str(path)]), 0)
    assert err == "" and "every reaction and load is determined" in out


def test_each_named_caliper_has_an_example():
    assert {path.stem for path in FILES} >= set(calipers.NAMED)


@pytest.mark.parametrize("name", calipers.NAMED)
def test_named_caliper_runs(name, finished):
    assert "pads together" in finished(main(["caliper", name]), 0).out
