"""The validation manual: each test that it names exists, and each published file is in it."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from beamdyn import published
from benchmarks import validation_manual
from brakes import published as published_brakes

ROOT = Path(__file__).parents[2]
TEXT = Path(validation_manual.__file__).read_text(encoding="utf-8")
NAMED = re.findall(r"(test_\w+\.py)::(test_\w+)", TEXT)


def test_the_tests_that_it_names_exist() -> None:
    assert len(NAMED) > 15
    for file, name in NAMED:
        assert f"def {name}(" in (ROOT / validation_manual.TESTS / file).read_text(encoding="utf-8")


def test_every_published_file_is_in_it() -> None:
    """By `reproduce`, which reads some, and by name."""
    tables = validation_manual.printed_tables
    by_reproduce = {*tables.PAPERS, *(f"blade_{name}" for name in tables.BLADES), "blades"}
    by_name = {name for name in published.available() if f'load("{name}")' in TEXT}
    assert {*published.available()} == by_reproduce | by_name
    brakes = {
        "drum_textbooks",
        "statics",
        "eebrake",
        "vardanyan_2019",
        "yoo_1997",
    }  # the last three by `reproduce`
    assert {*published_brakes.available()} == brakes


@pytest.mark.parametrize("part", ["brakes", "textbooks", "statics", "wider_models", "single_answers"])
def test_no_value_differs_without_a_reason(part: str) -> None:
    """Of the quick parts; `reproduce` is held to the same by its own tests."""
    rows = [row for section in validation_manual.PARTS[part][1]().values() for row in section]
    assert len(rows) >= 20
    assert [row for row in rows if "unexpected" in row.verdict] == []
    assert [row for row in rows if not re.search(r"\d", row.ours)] == []


def test_numbers_in_verdicts_are_those_of_notes() -> None:
    """Of a quick page: "the one misfit (1)" has its note below."""
    page = "\n".join(validation_manual._page("brakes", validation_manual.of_brakes()))
    verdicts, _, notes = page.partition("## Notes")
    assert {*re.findall(r"\(\d+\)(?=;| \|)", verdicts)} == {"(1)"}
    assert "(1) " in notes


def test_a_wrong_print_of_a_textbook_is_an_erratum() -> None:
    (row,) = validation_manual.errata_of_textbooks()
    assert row[1:3] == ["959", "943"]


@pytest.mark.slow  # as it proves them anew, which tests/literature do one by one
def test_errata_name_their_proof() -> None:
    text = "\n".join(validation_manual.errata())
    for part in ("power series", "tests/invariants/test_derivation.py", "## Yoo et al. 1997"):
        assert part in text
    assert (ROOT / "tests" / "invariants" / "test_derivation.py").exists()
