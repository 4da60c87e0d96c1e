"""`brakes reproduce` has every number that the papers print, with verdicts that are computed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from beamdyn.common.edge.exit_codes import DONE, NO_ANSWER
from brakes import reproduce
from brakes.cli import main
from brakes.published import load
from brakes.reproduce import drum_as_printed, eebrake, forklift_tables
from brakes.reproduce import forklift_as_printed as as_printed
from brakes.reproduce.common import Cell, step


def printed(name: str) -> list[str]:
    """Every text that the tables of a paper print."""

    def texts(value: object) -> list[str]:
        if isinstance(value, dict):
            return [t for key, inner in value.items() if key != "expressions" for t in texts(inner)]
        return [str(x) for x in np.ravel(value)] if isinstance(value, list) else [str(value)]  # pyright: ignore

    tables = [table for key, table in load(name).items() if key.startswith("table_")]
    entries = [e["printed"] for t in tables for e in t.values() if isinstance(e, dict) and "printed" in e]
    return sorted(t for entry in entries for t in texts(entry))


def test_every_printed_number_is_compared() -> None:
    found = [cell for table in forklift_tables.tables().values() for cell in table.cells]
    assert sorted(cell.printed for cell in found) == printed("yoo_1997")
    found = [cell for table in drum_as_printed.tables().values() for cell in table.cells]
    assert sorted(cell.printed for cell in found) == printed("vardanyan_2019")


def test_counts_of_verdicts() -> None:
    """Drum: 3 columns of 8 and a difference. Tables 2-4: 44 of 45. Tables 5-7: 3 x 3 rows, 4 forces."""
    found = forklift_tables.tables()
    groups = {
        "drum": [c for table in drum_as_printed.tables().values() for c in table.cells],
        "2-4": [c for name in ("table_2", "table_3", "table_4") for c in found[name].cells],
        "5-7": [c for name in ("table_5", "table_6", "table_7") for c in found[name].cells],
    }
    counts = {name: (len(cells), sum(c.agrees for c in cells)) for name, cells in groups.items()}
    assert counts == {"drum": (25, 25), "2-4": (45, 44), "5-7": (36, 36)}
    (misfit,) = [c for c in groups["2-4"] if not c.agrees]
    known = load("yoo_1997")["misfit"][0]
    assert misfit.printed == known["printed"] and misfit.ours == pytest.approx(known["ours"], abs=5e-4)
    assert misfit.as_expected and "misfit" in misfit.verdict


def test_a_cell_agrees_within_its_rounding() -> None:
    cell = Cell("9.560", 9.5649, step("9.560", 3))
    assert cell.agrees and not replace(cell, ours=9.5651).agrees and not replace(cell, step=1e-3).agrees
    assert (
        replace(cell, ours=9.6).verdict == "differs: unexpected" and not replace(cell, ours=9.6).as_expected
    )
    known = replace(cell, ours=9.6, reason="misprint")
    assert known.as_expected and known.verdict == "differs: misprint"
    assert not replace(cell, reason="misprint").as_expected  # a known difference must be there


@pytest.mark.parametrize(
    "text, digits, unit",
    [("9.50", None, 0.01), ("120.5", None, 0.1), ("12300", None, 10.0), ("9218", None, 1.0),
     ("-0.13", None, 0.01), ("7.320", 3, 0.01), ("11.80", 3, 0.1), ("37.71", None, 0.01)],
)  # fmt: skip
def test_unit_of_the_last_digit(text: str, digits: int | None, unit: float) -> None:
    assert step(text, digits) == pytest.approx(unit, rel=1e-15)


def test_what_the_forklifts_errata_cost() -> None:
    """By the facts: torque 11000.5 for about 8481 N m, 0.6393 m/s2 unladen; by hand: arm and distance."""
    costs = {e.name: (e.printed_value, e.right_value) for e in as_printed.errata() if e.quantity}
    assert costs["twice"] == pytest.approx((11000.5, 8480.8), abs=0.1)
    assert costs["unladen"][0] == pytest.approx(-0.13, abs=5e-3)
    assert costs["unladen"][1] == pytest.approx(0.6393, abs=5e-5)
    assert costs["axle"][0] == 2 * costs["axle"][1]
    a, V, t2 = 1.5715, 20 / 3.6, 0.3
    longer, right = costs["speed_lost"]
    assert longer - right == pytest.approx(V * t2 / 2 - a * t2**2 / 8, rel=1e-4)
    assert costs["factor"][0] - costs["factor"][1] == pytest.approx(-0.03 * 9.806 * np.sin(0.3019), rel=1e-9)
    # Moments about the front axle without the brake torque, arms by hand from the input.
    y = (5950 * 0.359 + 3500 * 0.450) / 9450
    ratio = (1.89 + 0.7 * (y + 0.4)) / (1.89 + 0.7 * y)
    assert costs["body_moment"][0] / costs["body_moment"][1] == pytest.approx(ratio, rel=1e-12)


def test_every_erratum_is_told() -> None:
    entries = load("yoo_1997")["erratum"]
    assert [e.name for e in as_printed.errata()] == [entry["name"] for entry in entries]
    assert all(e.consequence for e in as_printed.errata())
    assert sum(bool(e.quantity) for e in as_printed.errata()) == 6
    assert all(e.quantity for e in drum_as_printed.errata())


def test_corrected_tables() -> None:
    """The facts' three accelerations, unladen to laden, at 0.3019 rad; unladen it never stops."""
    found = as_printed.corrected_tables()
    np.testing.assert_allclose(
        found["table_3", "acceleration"][2], [0.6393, -0.7224, -1.5715], rtol=0, atol=5e-5
    )
    assert found["table_3", "distance"][2, 0] == np.inf
    assert found["table_2", "distance"][1, 1] == pytest.approx(13.425, abs=5e-4)


@pytest.mark.slow
def test_reproduce_prints_and_draws(finished, tmp_path) -> None:
    out, err = finished(main(["reproduce", "--output", str(tmp_path / "new")]), DONE)
    assert err == ""
    told = " ".join(out.split())
    for words in (
        "Torque of the Cylinder Brake Mechanism",
        "Do not use Table 1",
        "30 % too high (11000 in place of 8481 N m)",
        "9.56 m where the truck needs 13.42 m",
        "10.1 differs: the one misfit (1)",
        "44 of 45",
        "never stops",
        "C* = 5.95",
        "enter the drum by 1.55 mm near 26 deg",
        "drawn:",
    ):
        assert words in told, words
    total = len(reproduce.cells()) + sum(len(rows) for rows in eebrake.sections().values())
    assert f"All {total} verdicts are as expected" in told
    drawn = {path.name for path in (tmp_path / "new").iterdir()}
    names = ("truck", "distance", "stages", "shoes", "forces")
    assert {"drum_forces.png", "drum_torque_over_arc.png", *(f"forklift_{n}.png" for n in names)} <= drawn
    assert all((tmp_path / "new" / name).read_bytes().startswith(b"\x89PNG") for name in drawn)


def test_an_unexpected_verdict_is_reported(finished, tmp_path, monkeypatch) -> None:
    true = as_printed.tables()
    wrong = true | {("table_4", "torque"): 1.01 * true["table_4", "torque"]}
    monkeypatch.setattr(as_printed, "tables", lambda: wrong)
    monkeypatch.setattr(reproduce, "pictures", dict)
    out, err = finished(main(["reproduce", "--output", str(tmp_path)]), NO_ANSWER)
    assert out.count("differs: unexpected") >= 8 and "9 of" in err


def test_output_must_be_a_folder(finished, tmp_path) -> None:
    path = tmp_path / "file"
    path.write_text("")
    assert "give a folder" in finished(main(["reproduce", "--output", str(path)]), 2).err
