"""The examples in docstrings of public names print what stands there; how many names have none is counted."""

from __future__ import annotations

import doctest
import inspect
import re
import tomllib
from importlib import import_module
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
import pytest

import beamdyn as bd
import brakes
from brakes import calipers, chain, drum, forklift, machines, planar, vehicle

ROOT = Path(__file__).parents[2]
MODULES = (bd, brakes, calipers, chain, drum, forklift, machines, planar, vehicle)
KNOWN = {"np": np, **{module.__name__.rpartition(".")[2]: module for module in MODULES[1:]}, "bd": bd}
NEED = {"beamdyn.count_cycles": "rainflow", "beamdyn.LoadCycles": "rainflow"}  # extras
CHECKED = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["numpydoc_validation"]


def public_names() -> dict[str, Any]:
    """Public classes and functions of both packages; numpy's `Polynomial` is documented by numpy."""
    found = {
        f"{module.__name__}.{name}": getattr(module, name) for module in MODULES for name in module.__all__
    }
    return {
        name: item
        for name, item in found.items()
        if (inspect.isclass(item) or inspect.isfunction(item))
        and item.__module__.startswith(("beamdyn", "brakes"))
    }


NAMES = public_names()
# Authors and year: "Lee and Yoo (2019)", "Nayfeh and Mook, 1979", "Keller's (1977)".
CITED = re.compile(r"((?:[A-Z][a-z]+(?:, | and | et al\.)?)+)(?:'s)?,? \(?((?:19|20)\d\d)\)?")


def documentation(item: Any) -> str:
    return inspect.getdoc(item) or ""


@pytest.mark.parametrize("name", NAMES)
def test_the_example_prints_what_stands_there(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    if name in NEED:
        pytest.importorskip(NEED[name])
    matplotlib.use("Agg")
    monkeypatch.chdir(ROOT)
    options = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
    examples = doctest.DocTestParser().get_doctest(documentation(NAMES[name]), dict(KNOWN), name, None, None)
    said: list[str] = []
    result = doctest.DocTestRunner(optionflags=options, verbose=False).run(examples, out=said.append)
    assert result.failed == 0, "".join(said)


def test_every_public_name_has_an_example() -> None:
    without = {name for name, item in NAMES.items() if "\nExamples\n-----" not in documentation(item)}
    assert without == set(CHECKED["without_example"])


def test_numpydoc_finds_nothing() -> None:
    """Its codes are listed in pyproject.toml, those that are left out with the reason."""
    validate = pytest.importorskip("numpydoc.validate").validate
    found = {
        (name, code, message)
        for name, item in NAMES.items()
        for code, message in validate(f"{item.__module__}.{item.__qualname__}")["errors"]
        if code in CHECKED["checks"]
    }
    assert found == set()


# A number has its unit in brackets, or words that say that it has none or that it is that of something else.
WORDS = (
    r"ratio|factor|relative|fraction|share|number|index|indices|friction|bool|strain|confidence|status|mobility|rank|"
    r"over|times|singular|tolerance|in.the.units?|of.the.answer|nondimensional|advantage|magnification|x/L|whether|where"
)
UNIT = re.compile(rf"\[[^\]]*\]|\b(?:{WORDS})", re.IGNORECASE)
QUANTITY = re.compile(
    r"^(\w+(?:, \w+)*) : (float|ndarray(?! of (?:int|str|bool))|Numbers|sequence of float)\b(.*)$",
    re.MULTILINE,
)


def quantities(text: str) -> list[tuple[str, str]]:
    """Names of the numbers of a docstring's sections, with what is said of them."""
    lines, found = text.splitlines(), []
    for i, line in enumerate(lines):
        if match := QUANTITY.match(line):
            below = []
            for further in lines[i + 1 :]:
                if not further.startswith("    "):
                    break
                below.append(further)
            found.append((match[1], f"{match[1].replace('_', ' ')} {match[3]} {' '.join(below)}"))
    return found


def without_unit() -> set[str]:
    found = set()
    for name, item in NAMES.items():
        text = documentation(item)
        found |= {f"{name}: {quantity}" for quantity, said in quantities(text) if not UNIT.search(said)}
    return found


def test_numbers_have_units() -> None:
    """Exceptions would be listed in pyproject.toml."""
    assert without_unit() == set(CHECKED["without_unit"])


def test_every_public_name_is_in_the_reference_once() -> None:
    listed = []
    for page in sorted((ROOT / "docs" / "reference").glob("*.md")):
        text = page.read_text(encoding="utf-8")
        module = re.search(r"automodule:: (\S+)", text)
        for block in re.findall(r":toctree: generated\n\n(.*?)```", text, re.DOTALL):
            listed += [f"{module[1]}.{name}" if module else name for name in block.split()]
    names = [f"{module.__name__}.{name}" for module in MODULES for name in module.__all__]
    assert sorted(listed) == sorted(names)
    assert all(hasattr(import_module(name.rpartition(".")[0]), name.rpartition(".")[2]) for name in listed)


# What computes physics has its source: a paper or book by its year, a norm, a page of our own derivation, or
# "standard", what textbooks of the field have.  "As `name`" is that of the other name.
SOURCE = re.compile(
    r"\((?:[^()]*, )?\d{4}\)|\beqs?\. \(|\bASTM|\bISO|\bShigley|[Ss]tandard\b|\bCoulomb|docs/\w+\.md|^As `"
)
WITHOUT_PHYSICS = {  # functions that read, draw, or put the questions of others
    *(
        f"beamdyn.{name}"
        for name in (
            "draw",
            "load",
            "load_scene",
            "read_deck",
            "read_measurements",
            "study",
            "sweep",
            "tradeoff",
        )
    ),
    "brakes.drum.duplex",
    "brakes.drum.simplex",
}
MODELS = {  # classes that bring physics: results have that of their functions, others hold what is given
    *(
        f"beamdyn.{name}"
        for name in ("Beam", "Damping", "Fem", "GaussCollocation", "Mount", "Physics", "Ritz")
    ),
    *(f"beamdyn.{name}" for name in ("PowerSpectrum", "RoadRoughness", "RoadWave", "RollingWheel", "SpinUp")),
    *(
        f"beamdyn.{name}"
        for name in ("FirstOrderRange", "ParametricTerm", "RandomStatistics", "SobolIndices")
    ),
    *(f"beamdyn.{name}" for name in ("TipMass", "WorstCases")),
    *(f"brakes.calipers.{name}" for name in ("Caliper", "Stance")),
    "brakes.drum.Shoe",
    *(f"brakes.forklift.{name}" for name in ("DuoServo", "Levers", "Truck")),
    *(f"brakes.planar.{name}" for name in ("Contact", "Pin", "Slot")),
}


def source_of(item: Any) -> str:
    """The section References, of numpydoc, in one line."""
    found = re.search(
        r"^References\n-+\n(.*?)(?=\n\n\w+\n-+\n|\Z)", documentation(item), re.DOTALL | re.MULTILINE
    )
    return " ".join(found[1].split()) if found else ""


def test_what_computes_physics_has_its_source() -> None:
    functions = {name for name, item in NAMES.items() if inspect.isfunction(item)}
    assert functions >= WITHOUT_PHYSICS
    assert set(NAMES) - functions >= MODELS
    without = {
        name for name in (functions - WITHOUT_PHYSICS) | MODELS if not SOURCE.search(source_of(NAMES[name]))
    }
    assert without == set(CHECKED["without_source"])


def test_sources_lead_to_pages_and_names_that_there_are() -> None:
    sources = {name: source_of(item) for name, item in NAMES.items()}
    pages = {page for text in sources.values() for page in re.findall(r"docs/\w+\.md", text)}
    assert pages
    assert [page for page in pages if not (ROOT / page).exists()] == []
    for name, text in sources.items():
        for other in re.findall(r"As `([\w.]+)`", text):
            of_module = f"{name.rpartition('.')[0]}.{other}"
            assert source_of(NAMES.get(of_module) or NAMES[f"brakes.{other}"]), name


def test_what_is_cited_stands_in_the_literature() -> None:
    page = (ROOT / "docs" / "reference" / "literature.md").read_text(encoding="utf-8")
    listed = {(row.split()[0].rstrip(","), year) for row, year in CITED.findall(page)}
    cited = {
        (who.split()[0].rstrip(","), year)
        for name, item in NAMES.items()
        if "References" in (text := " ".join(documentation(item).split()))
        for who, year in CITED.findall(text.partition("References")[2].partition("Examples")[0])
    }
    assert len(cited) > 15 and cited <= listed, cited - listed
