"""The validation manual: every published value beside ours, written from the data that the packages bring.

python -m benchmarks.validation_manual FOLDER writes its pages in Markdown; the site does so when it is built.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from inspect import getdoc
from pathlib import Path
from typing import Any

import numpy as np

from beamdyn.common.results.comparison import Comparison
from beamdyn.common.results.one_line import rounded_up
from beamdyn.common.words import supported
from beamdyn.modes.equilibria import equilibrium
from beamdyn.modes.modes import natural_modes
from beamdyn.published import load
from beamdyn.reproduce import blades, inward_beam, printed_tables
from beamdyn.reproduce.entries import PrintedValue, compare_modes, half_unit
from beamdyn.scene.beam import Beam
from beamdyn.scene.mount import Mount
from beamdyn.scene.physics import Physics
from beamdyn.scene.scene import Scene
from benchmarks.cases import measured, single_answers, statics, textbooks
from benchmarks.sources import page_of_sources
from brakes.planar import solve
from brakes.published import load as load_brakes
from brakes.reproduce import drum_as_printed, eebrake, forklift_as_printed, forklift_tables
from brakes.reproduce.common import Erratum, PrintedTable

TESTS = "tests/literature"
_TESTS_OF_TABLES = {  # by the beginning of the source's name
    "Bir 2009, section": "test_printed_tables.py::test_a_hinged_beam_tends_to_a_cable",
    "Code_Aster SSLV105": "test_printed_tables.py::test_centrifugal_stretch",
    "": "test_printed_tables.py::test_all_digits_or_a_proven_erratum",
}
_BLADES = "test_printed_tables.py::test_blades_of_wind_turbines"
_SPIN_UP = "test_transient.py::test_spin_up_of_an_outward_beam"
_BMODES = "test_bmodes.py::test_what_reproduce_compares_is_traced_here"
_CARNEGIE = "test_two_planes.py::test_carnegies_theory_and_experiment_are_of_the_same_blade"
_MEASURED = "test_measured.py::test_a_measured_straight_beam"
_TESTS_OF_LEE_YOO = {  # by the beginning of the section's title
    "Table 2": "test_lee_yoo.py::test_table_2_within_a_thousandth_of_ansys",
    "Table 3 with large": "test_elastica_transient.py::test_table_3_with_large_deflection",
    "Table 3, continued": "test_resonance.py::test_steady_amplitude_is_a_seventh_of_the_published_peak",
    "Table 3": "test_transient.py::test_table_3_with_one_to_six_modes",
    "Fig. 6": "test_resonance.py::test_peaks_stand_at_the_resonance_speeds",
    "Fig. 7": "test_resonance.py::test_the_two_peaks_of_figure_6",
    "Fig. 8": "test_elastica.py::test_harvester",
    "Section 3.3": "test_lee_yoo.py::test_first_setting_angle_limit",
    "Section 4": "test_lee_yoo.py::test_buckling_speed",
}
_ROTATING = {
    True: "test_rotating_beams.py::test_published",
    False: "test_rotating_beams.py::test_critical_speeds",
}
_TEXTBOOKS = {
    "shigley_16_2": "test_drum.py::test_shigley_example_16_2",
    "shigley_16_1": "test_drum.py::test_shigley_problem_16_1",
    "shigley_16_1_inch": "test_drum.py::test_shigley_problem_16_1_in_inches",
    "shigley_16_2_problem": "test_drum.py::test_shigley_problem_16_2",
    "bhandari_12_9": "test_drum.py::test_bhandari_12_9",
}
_STATICS = "test_planar_problems.py::test_what_the_book_prints"
_BRAKE_BY_HAND = "test_planar_problems.py::test_cantilever_brake_by_hand"
_BEAMS = "Uniform and tapered beams, inward and outward, computed"
_PINS_OF_16_1 = "test_drum.py::test_shigley_problem_16_1_pin_reactions"


@dataclass(frozen=True)
class Row:
    """A published value beside ours: description of the input, both values, stated error, verdict, test."""

    where: str
    printed: str
    ours: str
    error: str
    verdict: str
    test: str

    def cells(self) -> list[str]:
        return [self.where, self.printed, self.ours, self.error, self.verdict, f"`{self.test}`"]


HEADS = ("input", "reference", "ours", "stated error", "verdict", "test")
Sections = dict[str, list[Row]]


def first_of(table: dict[str, str], name: str) -> str:
    """Return the entry of the first key that is a prefix of a name."""
    return next(value for key, value in table.items() if name.startswith(key))


def of_printed_tables() -> Sections:
    """Tables of papers on rotating beams, and blades of wind turbines, by Ritz.

    Speeds gamma and frequencies lambda are [nondimensional](../../conventions.md#nondimensional-groups);
    those of blades of wind turbines are in rpm and Hz.
    """
    found: Sections = {}
    for source, entries in printed_tables.all_entries("ritz").items():
        test = _BLADES if source.endswith("computed") else first_of(_TESTS_OF_TABLES, source)
        found[source] = _rows(entries, test)
    return found


def _row_of_entry(entry: PrintedValue, test: str) -> Row:
    verdict = "agrees" if entry.agrees else "differs"
    if entry.exact:
        verdict = f"the print errs: {_as_sure(entry)}"
    ours = supported(entry.ours, entry.error, 12)
    return Row(
        f"{entry.where}, mode {entry.mode}", entry.printed, ours, rounded_up(entry.error), verdict, test
    )


def _as_sure(entry: PrintedValue) -> str:
    """Return the third value, rounded to the digits that our error confirms."""
    return min(supported(float(entry.exact), entry.error, 12), entry.exact, key=len)


def of_reference_tables() -> Sections:
    """Frequencies of rotating and of twisted beams that several methods give in all digits.

    All are [nondimensional](../../conventions.md#nondimensional-groups): lambda, by speed (gamma), hub radius
    (delta) and mode. The papers print their first four or five digits; the others are of a power series and
    of Rayleigh-Ritz in 40 digits, which agree. Sections, tip bodies and twist of each row stand in
    `rotating_beams.toml` and `twisted_beams.toml` of `beamdyn/published`.
    """
    found: Sections = {}
    data = load("rotating_beams")
    for case in (*data["case"], *(c for c in data["critical"] if np.isfinite(c["gamma"]))):
        rows = _rows(printed_tables.entries_of_reference(case, "ritz"), _ROTATING["frequency" in case])
        source = case.get("source", "computed")
        found.setdefault(_BEAMS if source == "computed" else source, []).extend(rows)
    for case in load("twisted_beams")["case"]:
        entries = printed_tables.entries_of_reference(case, "ritz")
        rows = _rows(entries, "test_two_planes.py::test_rows_of_the_models")
        found.setdefault(case["source"][:1].upper() + case["source"][1:], []).extend(rows)
    return found


def _rows(entries: Iterable[PrintedValue], test: str) -> list[Row]:
    return [_row_of_entry(entry, test) for entry in entries]


def of_single_answers() -> Sections:
    """Slopes, limits, a spin-up, growth where the speed varies, and branches of bent equilibria."""
    return {
        "Southwell's slopes, computed": _single(single_answers.slopes(), "test_slopes_at_rest"),
        "Critical speed far from the axis, computed": _single(
            [single_answers.limit_of_the_critical_speed()], "test_critical_speed_far_from_the_axis"
        ),
        "Varying speed, computed": _single(
            single_answers.growth_factors(), "test_growth_where_the_speed_varies"
        ),
        "Kane, Ryan and Banerjee 1987; Simo and Vu-Quoc 1986": [
            _row_of_comparison(single_answers.spin_up(), _SPIN_UP)
        ],
        "Branches of the harvester that bends, computed": _single(
            single_answers.branches(), "test_branches_of_the_harvester"
        ),
    }


def _single(comparisons: Iterable[Comparison], test: str) -> list[Row]:
    return [_row_of_comparison(c, f"test_measured.py::{test}") for c in comparisons]


def of_wider_models() -> Sections:
    """Numbers that contain more than our models: of a program with torsion, and of experiments."""
    paper = load("epps_chandra_1996")
    title = f"{' and '.join(paper['authors'])} {paper['year']}, straight beam, flapping [Hz]"
    return {
        "BModes, Test01, as it prints them [Hz]": [
            _row_of_comparison(c, _BMODES) for c in blades.printed_by_bmodes()
        ],
        title: [_row_of_comparison(c, _MEASURED) for c in measured.compare()],
        "Carnegie 1959, blade twisted by 45 deg, at rest [Hz]": [
            _row_of_comparison(c, _CARNEGIE) for c in measured.compare_carnegie()
        ],
    }


def of_elastica() -> Sections:
    """Equilibria of beams that bend far, and frequencies about them.

    Frequencies are lambda, and speeds gamma, [nondimensional](../../conventions.md#nondimensional-groups);
    r is the radius of the root, places of the tip are over the length L.
    """
    rows: list[Row] = []
    for case in load("elastica")["case"]:
        angles = (float(np.radians(case[f"{name}_angle_deg"])) for name in ("setting", "bending"))
        physics = Physics(large_deflection=True, branch=case["branch"])
        scene = Scene(Beam.from_stiffness(1.0, 1.0, 1.0), Mount(case["radius"], *angles), physics=physics)
        modes = natural_modes(scene, case["gamma"], len(case["frequency"]))
        test = "test_elastica.py::test_frequencies"
        case |= {"name": f"{case['name']} (gamma {case['gamma']:.6g}, r/L {case['radius']:g})"}
        entries = compare_modes(case["name"], case["frequency"], np.abs(modes.eigenvalue), modes.error)
        rows += _rows(entries, test)
        if "tip" in case:
            rows += _tips(case, equilibrium(scene, case["gamma"]))
    return {"Rotating elastica, computed by other methods": rows}


def _tips(case: dict[str, Any], found: Any) -> Iterator[Row]:
    for name, printed, ours in zip(
        ("along", "across"), case["tip"], _along_and_across(case, found.tip), strict=True
    ):
        free = case["setting_angle_deg"] == 0.0  # then either sign is as good
        close = abs(abs(ours) - abs(float(printed))) if free else abs(ours - float(printed))
        verdict = "agrees" if close <= found.error + 0.5e-9 else "differs"
        where = f"{case['name']}, tip {name}"
        yield Row(
            where,
            printed,
            supported(ours, found.error, 10),
            rounded_up(found.error),
            verdict,
            "test_elastica.py::test_tips",
        )


def _along_and_across(case: dict[str, Any], tip: np.ndarray) -> tuple[float, float]:
    angle = np.radians(case["bending_angle_deg"])
    return float(tip[0]), float(np.cos(angle) * tip[1] + np.sin(angle) * tip[2])


def of_lee_and_yoo() -> Sections:
    """All numbers of the paper on the inward beam."""
    return {
        f"Lee and Yoo 2019, {title}": [
            _row_of_comparison(c, first_of(_TESTS_OF_LEE_YOO, title)) for c in rows
        ]
        for title, rows in inward_beam.sections(inward_beam.run_sweep()).items()
    }


def _row_of_comparison(comparison: Comparison, test: str) -> Row:
    what, source, printed, ours, _, verdict = comparison.cells()
    error = rounded_up(comparison.error) if comparison.error else "-"
    return Row(f"{what} ({source})", printed, ours, error, verdict, test)


def of_brakes() -> Sections:
    """Drum brakes, the forklift, bicycle calipers; "ours" follows the papers' own way where they err.

    What a verdict calls right is the corrected number.
    """
    test = "test_drum.py::test_table_1_to_every_printed_digit"
    drum = [row for table in drum_as_printed.tables().values() for row in _rows_of_table(table, test)]
    found = {"Vardanyan et al. 2019, Table 1 (by the paper's own way)": drum}
    for name, table in forklift_tables.tables().items():
        early = name in ("table_2", "table_3", "table_4")
        test = "tables_2_3_4_but_for_one_cell" if early else "tables_5_6_7_within_their_rounding"
        found[f"Yoo et al. 1997, Table {name[-1]} (by the paper's own way)"] = _rows_of_table(
            table, f"test_forklift.py::test_{test}"
        )
    for title, comparisons in eebrake.sections().items():
        test = "test_caliper.py::test_every_verdict_on_the_page_is_as_expected"
        found[title] = [_row_of_comparison(c, test) for c in comparisons]
    return found


def _rows_of_table(table: PrintedTable, test: str) -> list[Row]:
    """A row for each number of a table: its inputs, if the table has any, and its quantity."""
    found = []
    for inputs, cells in table.rows:
        given = ", ".join(f"{head} = {value}" for head, value in zip(table.inputs, inputs, strict=True))
        for quantity, cell in zip(table.quantities, cells, strict=True):
            name = f"{quantity} [{table.unit}]" if table.unit else quantity
            printed, ours, *right = cell.texts
            verdict = f"{cell.verdict}; right: {right[0]}" if right else cell.verdict
            where = f"{given}: {name}" if given else name
            found.append(Row(where, printed, ours, "rounding", verdict, test))
    return found


def of_textbooks() -> Sections:
    """Worked examples of drum brakes, in the books' units."""
    data, solved = load_brakes("drum_textbooks"), textbooks.answers()
    return {
        data[name]["source"]: [
            _row_of_example(quantity, data[name][quantity], ours, _test_of(name, quantity))
            for quantity, ours in solved[name].items()
        ]
        for name in _TEXTBOOKS
    }


def _test_of(name: str, quantity: str) -> str:
    return _PINS_OF_16_1 if name == "shigley_16_1" and "pin" in quantity else _TEXTBOOKS[name]


def _row_of_example(quantity: str, given: dict[str, Any], ours: Sequence[float], test: str) -> Row:
    printed = given.get("printed", given.get("value"))
    texts = printed if isinstance(printed, list) else [str(printed)]
    digits = max(6, max(map(_count_digits, texts)))
    nought = 1e-12 * max(map(abs, ours))
    values = ", ".join(f"{value if abs(value) > nought else 0.0:.{digits}g}" for value in ours)
    verdict = _verdict_of_example(given, texts, ours)
    where = ", ".join(filter(None, (quantity.replace("_", " "), given.get("sense"))))
    unit = "" if given["unit"] == "1" else f" [{given['unit']}]"
    where = f"{where}{unit}{'' if 'printed' in given else ' (computed)'}"
    return Row(where, ", ".join(texts), values, "rounding", verdict, test)


def _verdict_of_example(given: dict[str, Any], texts: Sequence[str], ours: Sequence[float]) -> str:
    note = given.get("note", "")
    if "right" in given:
        return f"the print errs: {given['right']}; {note}"
    close = all(
        abs(value - float(text)) <= half_unit(_printed_by(text, given))
        for text, value in zip(texts, ours, strict=True)
    )
    return "agrees" if close else f"differs: {note or 'unexpected'}"


def _printed_by(text: str, given: dict[str, Any]) -> str:
    """Return the printed number with all its digits, also trailing zeros."""
    return f"{float(text):.{given['digits'] - 1}e}" if "digits" in given else text


def _count_digits(text: str) -> int:
    """Count the significant digits of a printed number."""
    return sum(character.isdigit() for character in text)


def of_statics() -> Sections:
    """Worked problems of statics, in the books' units; two numbers are components to the right and up.

    Their points and loads stand in `benchmarks/cases/statics.py`; the force of a pin is that on the part
    which is named first there.
    """
    data, solved = load_brakes("statics"), statics.answers()
    found = {
        given["source"]: [
            _row_of_example(quantity, given[quantity], ours, _STATICS)
            for quantity, ours in solved[name].items()
        ]
        for name, given in data.items()
    }
    found["Cantilever brake, by hand: N/T = PC / (2 PS sin(alpha))"] = list(map(_brake_by_hand, (25, 45, 70)))
    return found


def _brake_by_hand(angle: float) -> Row:
    brake, expected = statics.cantilever_brake(angle)
    given = {"printed": f"{expected:.10f}", "unit": "1", "sense": f"alpha = {angle} deg"}
    return _row_of_example("N/T", given, (float(solve(brake).amplitudes["pad"]),), _BRAKE_BY_HAND)


_ERRATA = """# Errata

Errors in print. A printed value that ours contradicts is confirmed by a third computation first.

## Values of tables

The proof: the power series in 30 digits, here rounded to 12, and guaranteed bounds that exclude the print.
"""
_HEADS_OF_VALUES = (
    "source",
    "at",
    "mode",
    "printed",
    "ours",
    "power series",
    "width of bounds",
    "last digits off",
)
_HEADS_OF_ERRATA = ("where", "the paper has", "right", "what follows")
_HEADS_OF_TEXTBOOKS = ("where", "the book has", "right", "why", "test")
_ERRATA_OF_BRAKES = {
    "Vardanyan et al. 2019": (drum_as_printed, "test_drum.py::test_every_erratum_has_a_consequence"),
    "Yoo et al. 1997": (
        forklift_as_printed,
        "test_forklift.py::test_corrected_distance_and_what_the_printed_one_adds",
    ),
}


def errata() -> Iterator[str]:
    """Return all errata, with their proofs or consequences."""
    yield _ERRATA
    found = printed_tables.compare_papers()[1]
    yield _table(_HEADS_OF_VALUES, ([source, *entry.cells()] for source, entry in found))
    yield "\n## Lee and Yoo 2019\n"
    yield "The proof: `tests/invariants/test_derivation.py` derives the equations again.\n"
    keys = ("where", "printed", "right", "consequence")
    rows = ([entry[key] for key in keys] for entry in load("lee_yoo_2019")["erratum"])
    yield _table(_HEADS_OF_ERRATA, rows)
    for title, (module, test) in _ERRATA_OF_BRAKES.items():
        yield f"\n## {title}\n\nThe numbers that follow are computed both ways: `{test}`.\n"
        yield _table(_HEADS_OF_ERRATA, (_erratum(entry) for entry in module.errata()))
    yield "\n## Textbooks\n\nThe proof: the book's own numbers, and equilibrium, which ours keeps.\n"
    yield _table(_HEADS_OF_TEXTBOOKS, errata_of_textbooks())


def errata_of_textbooks() -> Iterator[list[str]]:
    """Return the errors in worked examples: place, printed value, right value, reason and test."""
    for name, example in load_brakes("drum_textbooks").items():
        for quantity, given in example.items():
            if isinstance(given, dict) and "right" in given:
                where = f"{example['source']}: {quantity.replace('_', ' ')} [{given['unit']}]"
                yield [
                    where,
                    given["printed"],
                    given["right"],
                    given["note"],
                    f"`{_test_of(name, quantity)}`",
                ]


def _erratum(entry: Erratum) -> list[str]:
    return [entry.where, entry.printed, entry.right, entry.consequence]


def _table(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    lines = ["| " + " | ".join(heads) + " |", "|" + "---|" * len(heads)]
    return "\n".join([*lines, *("| " + " | ".join(_cell(cell) for cell in row) + " |" for row in rows)])


def _cell(text: object) -> str:
    return str(text).replace("|", "\\|").replace("*", "\\*").replace("\n", " ")


PARTS = {
    "rotating_beams": ("Tables of rotating beams and blades", of_printed_tables),
    "references": ("Rotating and twisted beams in all digits", of_reference_tables),
    "single_answers": ("Answers that are no row of a table", of_single_answers),
    "wider_models": ("Numbers that contain more than our models", of_wider_models),
    "large_deflection": ("Beams that bend far", of_elastica),
    "inward_beam": ("The inward beam of Lee and Yoo", of_lee_and_yoo),
    "brakes": ("Brakes", of_brakes),
    "textbooks": ("Drum brakes of textbooks", of_textbooks),
    "statics": ("Problems of statics", of_statics),
}


NOTES: dict[str, tuple[Callable[[], Iterable[str]], ...]] = {  # to which numbers in verdicts refer
    "inward_beam": (inward_beam.notes,),
    "wider_models": (blades.notes,),
    "brakes": (drum_as_printed.notes, forklift_tables.notes, eebrake.notes),
}


def write_pages(folder: Path) -> list[str]:
    """Write all pages and their overview; the names of the pages."""
    folder.mkdir(parents=True, exist_ok=True)
    found = {name: part() for name, (_, part) in PARTS.items()}
    pages = {name: "\n".join(_page(name, sections)) for name, sections in found.items()}
    pages["sources"] = page_of_sources()
    pages["errata"] = "\n".join(errata())
    pages["overview"] = _overview(found)
    for name, text in pages.items():
        (folder / f"{name}.md").write_text(text, encoding="utf-8")
    return list(pages)


_ABOUT = f"""A reference is what the [source](sources.md) prints, or, where the row or its heading says so,
what other methods computed. Tests: in `{TESTS}`."""


def _page(name: str, sections: Sections) -> Iterator[str]:
    title, part = PARTS[name]
    yield f"# {title}\n\n{getdoc(part)} {_ABOUT}\n"
    beams = printed_tables.beams()
    for source, rows in sections.items():
        about = f"The beam: {beams[source]}.\n\n" if source in beams else ""
        yield f"## {source}\n\n{about}{_table(HEADS, (row.cells() for row in rows))}\n"
    notes = [_cell(note) for make in NOTES.get(name, ()) for note in make()]
    if notes:
        yield "## Notes\n\n" + "\n\n".join(notes)


def _overview(found: dict[str, Sections]) -> str:
    counts = [
        [f"[{source}]({name}.md)", str(len(rows)), _count(rows, "the print errs"), _count(rows, "differs")]
        for name, sections in found.items()
        for source, rows in sections.items()
    ]
    heads = ("source", "values", "the print errs", "differ, with the reason there")
    values = sum(int(row[1]) for row in counts)
    return f"# Overview\n\n{_table(heads, counts)}\n\n{values} values."


def _count(rows: Sequence[Row], verdict: str) -> str:
    return str(sum(row.verdict.startswith(verdict) for row in rows))


if __name__ == "__main__":
    print(*write_pages(Path(sys.argv[1])), sep="\n")
