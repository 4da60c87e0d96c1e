"""The validation manual: each test that it names exists, and each published file is in it."""

from __future__ import annotations

import re
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from beamdyn import published
from beamdyn.reproduce.entries import PrintedValue, half_unit
from benchmarks import sources, validation_manual
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


def _unsure(row: validation_manual.Row) -> list[str]:
    """Numbers of ours and of the verdict with more digits than the stated error supports."""
    numbers = re.findall(r"(?<![\w.])-?\d+\.\d+(?:e[-+]?\d+)?(?![\d.])", f"{row.ours} {row.verdict}")
    return [text for text in numbers if half_unit(text) < 0.999 * float(row.error)]


@pytest.mark.slow
def test_no_digit_is_beyond_the_stated_error() -> None:
    """Neither of ours nor of the third computation in a verdict; of the quick parts, and of all errata."""
    parts = (validation_manual.PARTS[name][1]() for name in ("single_answers", "wider_models", "brakes"))
    rows = [row for part in parts for section in part.values() for row in section if row.error != "rounding"]
    entries = [e for each in validation_manual.printed_tables.all_entries("ritz").values() for e in each]
    rows += [validation_manual._row_of_entry(entry, "") for entry in entries if entry.exact]
    assert len(rows) > 50
    assert [(row.where, row.error) for row in rows if not row.error[0].isdigit()] == []
    assert [(row.where, unsure) for row in rows if (unsure := _unsure(row))] == []


def test_a_verdict_has_no_more_digits_than_the_third_computation() -> None:
    row = validation_manual._row_of_entry(PrintedValue("", 1, "3.51", 3.516015268500, 1e-15, "3.51602"), "")
    assert row.verdict == "the print errs: 3.51602"


def test_a_stated_error_is_not_below_the_error() -> None:
    """It has one digit, rounded up."""
    row = validation_manual._row_of_entry(PrintedValue("", 1, "3.516", 3.5160152685, 1.2e-12), "")
    assert row.error == "2e-12"


def test_tips_have_the_digits_that_their_error_supports() -> None:
    case = {"name": "bent", "tip": ("0.9", "0.4"), "setting_angle_deg": 5.0, "bending_angle_deg": 0.0}
    found = SimpleNamespace(tip=np.array([0.9000123456789, 0.4000123456789, 0.0]), error=4e-6)
    rows = validation_manual._tips(case, found)
    assert [row.ours for row in rows] == ["0.90001", "0.40001"]


def test_every_printed_table_says_of_which_beam_it_is() -> None:
    """Who computes a row anew needs its tip mass, its direction of bending, and the unit of its numbers."""
    tables = validation_manual.printed_tables
    beams = tables.beams()
    assert {name for name in tables.all_entries("ritz") if not name.endswith("computed")} == {*beams}
    page = "\n".join(validation_manual._page("rotating_beams", validation_manual.of_printed_tables()))
    for name, beam in beams.items():
        assert f"## {name}\n\nThe beam: {beam}.\n" in page


def test_sources_name_the_file_that_has_the_numbers() -> None:
    """In the data, not in a comment alone."""
    for who, _, file in sources._CITED:
        surname = re.split(r"[ ,]", who)[0].lower()
        assert surname in str(published.load(file)).lower(), f"{who}: {file}"


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
