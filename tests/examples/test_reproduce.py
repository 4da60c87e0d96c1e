"""`beamdyn reproduce` prints the published numbers with verdicts that are computed, and draws the figures."""

import re
from dataclasses import replace

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.cli import DONE, NO_ANSWER, main
from beamdyn.common.edge.console import comparison_table, console
from beamdyn.common.results.comparison import Comparison
from beamdyn.published import load
from beamdyn.reproduce import inward_beam, inward_beam_figures, printed_tables
from beamdyn.reproduce.entries import PrintedValue, summarize_entries


@pytest.fixture(scope="module")
def swept():
    return inward_beam.run_sweep(speeds=np.arange(45.0, 81.0))


@pytest.fixture(scope="module")
def sections(swept):
    return inward_beam.sections(swept)


@pytest.fixture(scope="module")
def rows(sections):
    return [row for section in sections.values() for row in section]


def test_reproduce_prints_and_draws(finished, tmp_path, monkeypatch, swept, sections):
    monkeypatch.setattr(inward_beam, "run_sweep", lambda progress: swept)
    monkeypatch.setattr(
        inward_beam, "sections", lambda of: {id(swept): sections}[id(of)]
    )  # once, of that sweep
    out, err = finished(main(["reproduce", "--output", str(tmp_path / "new")]), DONE)
    assert err == ""
    for number in ("65.231", "65.230", "65.23045643", "61.96301890", "50.90709537", "50.90705785"):
        assert number in out
    for number in ("88.35 to 88.36", "88.359846", "89.6266", "88.372", "88.5343", "159.818332659"):
        assert number in out
    for number in (
        "70.46541",
        "177.8582",
        "3.617",
        "1.9488",
        "1.94718",
        "1.94256",
        "1.96",
        "0.2618759",
        "53.0858418",
        "69.8024033",
        "at 8.22",
    ):
        assert number in out
    bent = [line.split() for line in out.splitlines() if "bent beam" in line and "independent" in line]
    assert [(line[0], line[6], line[-1]) for line in bent] == [
        (modes, value, "agrees") for modes, value in (("2", "1.94974"), ("3", "1.94883"), ("5", "1.94876"))
    ]
    for words in (
        "Modeling and Vibration",
        "agrees",
        "differs: unexplained",
        "differs: ring-down",
        "differs: large deflection",
        "Hz higher",
        "linear",
        "verdicts are as expected",
    ):
        assert words in out
    for i in range(4, 10):
        assert (tmp_path / "new" / f"fig_{i}.png").read_bytes().startswith(b"\x89PNG")


def test_an_unexpected_verdict_is_reported(finished, tmp_path, monkeypatch):
    row = [*inward_beam.first_frequencies()][1]
    monkeypatch.setattr(inward_beam, "run_sweep", lambda progress: None)
    monkeypatch.setattr(
        inward_beam, "sections", lambda swept: {"title": [replace(row, ours=row.ours + 0.01)]}
    )
    monkeypatch.setattr(inward_beam_figures, "pictures", lambda swept: {})
    out, err = finished(main(["reproduce", "--output", str(tmp_path)]), NO_ANSWER)
    assert "differs: unexpected" in out
    assert "not as expected" in err


def test_table_2_is_within_a_thousandth_of_ansys(rows):
    ansys = [r for r in rows if "ANSYS" in r.source]
    assert len(ansys) == 9
    assert all(abs(r.deviation) < 1e-3 for r in ansys)


def test_only_known_differences(rows):
    differing = {(r.what, r.source) for r in rows if not r.agrees}
    known = {(f"0 rad/s, {model}", "paper") for model in ("Ritz", "FE", "with stretch")}
    known |= {("1 mode, Ritz", "paper"), ("2 modes, Ritz", "paper"), ("steady amplitude, undamped", "paper")}
    known |= {(f"5 modes, {model}", "RecurDyn (4)") for model in ("Ritz", "FE")}
    known |= {(f"{a} deg, {v} rad/s", "paper's model") for a in (88.36, 89.63) for v in (100, 400)}
    known |= {("5 modes, bent beam", source) for source in ("paper", "RecurDyn (4)")}
    assert differing == known | {("second limit, to 150 rad/s", "paper")}


def test_table_3_is_reproduced_by_both_discretizations(rows):
    exact = 1e3 * load("lee_yoo_2019")["reference"]["largest_deflection"]["in_window"]["value"][4]
    five = {r.what: r for r in rows if r.what.startswith("5 modes") and "bent" not in r.what}
    assert len(five) == 2
    for row in five.values():
        assert row.ours == pytest.approx(exact, rel=3e-6)


def test_table_3_with_large_deflection(rows):
    exact = load("lee_yoo_2019")["reference"]["largest_deflection_elastica"]["in_window"]["value"]
    ours = [r.ours for r in rows if "bent beam" in r.what and "independent" in r.source]
    np.testing.assert_allclose(ours, 1e3 * np.array(exact), rtol=1e-5)  # what is promised


def test_figure_6_has_its_two_peaks(swept):
    two = swept.speeds[np.argsort(swept.peaks)[-2:]]
    assert sorted(two) == [53.0, 70.0]


def test_a_beam_that_bends_has_other_limits(rows):
    """To the digits of the other computation, and by a maximum or minimum at the top speed."""
    known = [r for r in rows if r.what.endswith("rad/s") and "deg" in r.what and "independent" in r.source]
    assert len(known) == 4 and all(r.agrees for r in known)
    second = next(r for r in rows if r.what.startswith("second limit, to 150") and "(9)" in r.reason)
    at_limit = inward_beam.inward_scene(second.ours, large_deflection=True)
    speeds = np.array([149.0, 150.0, 151.0])
    before, at, after = bd.frequency_locus(at_limit, speeds, 1, bd.Ritz(12)).frequency[:, 0]
    assert at < min(before, after)


@pytest.mark.parametrize("angle", [1.0, 20.0, 60.0, 88.35, 88.36, 88.5, 89.0, 89.62, 89.63, 90.0])
def test_at_no_angle_does_it_rise_first_and_then_fall(angle):
    """What note (9) says: its changes from one speed to the next change sign once at most, upwards."""
    speeds = np.linspace(0, 150.0, 16)
    locus = bd.frequency_locus(inward_beam.inward_scene(angle, large_deflection=True), speeds, 1, bd.Ritz(12))
    assert (np.diff(np.sign(np.diff(locus.frequency[:, 0]))) >= 0).all()


def test_every_cell_has_its_heading(rows, capsys):
    console().print(comparison_table("title", rows))
    heading = capsys.readouterr().out.splitlines()[2]
    assert len(re.findall(r"\S+(?: \S+)*", heading)) == len(rows[0].cells())


VALUE = Comparison("f", "x", 65.23, 65.2304, 1e-6, 2)
INTERVAL = replace(VALUE, published=(65.2, 65.3))


def test_a_value_agrees_within_its_rounding_and_our_error():
    assert VALUE.verdict == "agrees"
    assert replace(VALUE, ours=65.2350005).agrees
    assert not replace(VALUE, ours=65.2350005, error=0.0).agrees
    assert replace(VALUE, ours=65.24).verdict == "differs: unexpected"


def test_a_known_difference_must_be_there():
    assert replace(VALUE, ours=65.24, reason="erratum").as_expected
    assert not replace(VALUE, reason="erratum").as_expected


def test_an_interval_must_hold_the_value():
    assert INTERVAL.deviation == 0 and INTERVAL.agrees
    assert replace(INTERVAL, ours=65.31).deviation == pytest.approx(0.01)
    assert not replace(INTERVAL, ours=65.31).agrees


@pytest.mark.slow
def test_all_of_figure_6_has_no_other_peak():
    assert all(row.as_expected for row in inward_beam.sweep_peak_comparisons(inward_beam.run_sweep()))


@pytest.fixture(scope="module")
def papers():
    """What is found of the printed tables by one discretization, which takes two seconds."""
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(printed_tables, "_DISCRETIZATIONS", {"Ritz": "ritz"})
        yield printed_tables.compare_papers()


def test_tables_of_papers(papers):
    """Counts of benchmarks collected: values, errata, and those off by less than a unit of the last digit."""
    summaries, errata = papers
    found = [(s.values, s.errata, s.last_digits) for s in summaries]
    assert found == [
        *((39, 2, 2), (26, 2, 2), (6, 2, 1), (6, 3, 2), (75, 3, 2), (10, 8, 3)),
        *((3, 0, 0), (1, 0, 0), (10, 0, 0), (10, 0, 0), (10, 0, 0)),
    ]
    assert all(s.as_expected for s in summaries)
    assert {s.verdict for s in summaries if not s.errata} == {"agrees in all printed digits"}
    assert len(errata) == 20
    bounded = [entry.bounds is not None for _, entry in errata]
    assert bounded.count(False) == 3  # those with stretch


def test_reproduce_prints_tables(finished, tmp_path, monkeypatch, papers):
    monkeypatch.setattr(inward_beam, "run_sweep", lambda progress: None)
    monkeypatch.setattr(inward_beam, "sections", lambda swept: {})
    monkeypatch.setattr(inward_beam_figures, "pictures", lambda swept: {})
    monkeypatch.setattr(printed_tables, "reference_entries", lambda discretization: {})
    monkeypatch.setattr(printed_tables, "compare_papers", lambda: papers)
    lines = finished(main(["reproduce", "--tables", "--output", str(tmp_path)]), DONE).out.splitlines()
    for words in (
        ("Mabie, Rogers 1972: tapers", "Ritz", "10", "agrees but 5 errata, 3 last"),
        ("IEA-15 blade, computed", "Ritz", "10", "agrees in all printed digits"),
        ("Ozdemir, Kaya 2006: tapers", "b 0.4, h 0.4", "38.4920", "20.04998385", "20.0499838515", "e-12"),
        ("Hamza cherif, Houmat 2004:", "gamma 50", "7.3362", "7.333589076", "no theorem", "+26"),
        ("60 rpm, mode 1", "BModes 3", "1.7517", "1.7517787", "no rotary inertia (10)"),
        ("Bir, 2009 (10.2514/6.2009-1035)", "pyBModes"),
        ("All 16 verdicts are as expected",),
    ):
        assert any(all(word in line for word in words) for line in lines), words


@pytest.mark.slow
def test_tables_of_papers_by_elements():
    summaries, _ = printed_tables.compare_papers()
    assert len(summaries) == 22
    assert all(s.as_expected for s in summaries)


AGREES = PrintedValue("x", 1, "23.02", 23.0229, 1e-9)
ERRATUM = replace(AGREES, printed="23.03", exact="23.0229", bounds=(23.02289, 23.02291))


def test_an_erratum_needs_its_proofs():
    assert AGREES.as_expected and not AGREES.is_erratum
    assert not replace(AGREES, printed="23.03").as_expected  # with no third computation
    assert ERRATUM.as_expected and ERRATUM.off_by == pytest.approx(0.71)
    for wrong in (
        {"exact": "23.0282"},  # which is not ours
        {"ours": 23.0282},  # which is not the third
        {"printed": "23.02"},  # the print is right
        {"bounds": (23.02289, 23.0251)},  # some of what they enclose rounds to the print
        {"bounds": (23.0230, 23.0231)},  # the third is not among it
    ):
        assert not replace(ERRATUM, **wrong).as_expected, wrong
    assert replace(ERRATUM, bounds=None).as_expected


def test_verdicts_of_tables():
    def verdict(*entries):
        return summarize_entries("x", "Ritz", entries).verdict

    far = replace(ERRATUM, printed="46.05")
    assert verdict(AGREES) == "agrees in all printed digits"
    assert verdict(AGREES, replace(AGREES, ours=23.0251, error=1e-3)) == "agrees within error"
    assert verdict(AGREES, ERRATUM) == "agrees but 1 last digit"
    assert verdict(AGREES, ERRATUM, far, far) == "agrees but 2 errata, 1 last digit"
    assert verdict(AGREES, ERRATUM, replace(AGREES, printed="23.03")) == "differs: 1 value(s)"


@pytest.mark.slow
def test_tables_of_other_sources():
    twisted = {case["source"] for case in load("twisted_beams")["case"]}
    found = printed_tables.summarize(printed_tables.reference_entries)
    summaries = [s for s in found if s.source not in twisted]
    assert sum(s.values for s in summaries if s.discretization == "Ritz") == 62
    for s in summaries:
        assert s.as_expected, s
        assert s.deviation < {"Ritz": 1e-9, "FE": 1e-6}[s.discretization]


def test_a_wrong_value_in_the_tables_is_seen():
    case = load("rotating_beams")["case"][0]
    good = printed_tables.entries_of_reference(case, "ritz")
    assert summarize_entries("x", "Ritz", good).as_expected
    wrong = [replace(entry, ours=entry.ours * (1 + 1e-9)) for entry in good]
    assert not summarize_entries("x", "Ritz", wrong).as_expected
