"""The Python of the README, of the tour and of the page on sweeps runs; the README's tables are written."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import matplotlib
import pytest

from beamdyn.cli import main
from benchmarks.readme import write_between

ROOT = Path(__file__).parents[2]


def blocks(page: str, language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```", (ROOT / page).read_text(), re.DOTALL | re.MULTILINE)


def printed_by(page: str, capsys: pytest.CaptureFixture[str]) -> str:
    names: dict[str, object] = {}
    for block in blocks(page, "python"):
        exec(block, names)
    return capsys.readouterr().out


def test_readme(capsys: pytest.CaptureFixture[str]) -> None:
    printed = printed_by("README.md", capsys)
    for number in ("61.96301", "159.8183326"):
        assert number in printed


def test_tour(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.chdir(tmp_path)  # it writes files
    printed = printed_by("docs/tour.md", capsys)
    for number in ("61.96301", "159.8183326", "0.0019424", "53.0858418", "69.802403", "0.000261"):
        assert number in printed
    for number in ("eebrake       5.9811", "v-brake       9.7663", "176.7287", "13.4249", "117207"):
        assert number in printed


def test_readme_and_first_page_say_the_same_first() -> None:
    """The sentence that says what it is, and the five lines."""
    readme, index = ((ROOT / page).read_text(encoding="utf-8") for page in ("README.md", "docs/index.md"))
    assert readme.split("\n\n")[1] == index.split("\n\n")[1]
    assert "This is not OpenFAST's module BeamDyn" in readme.split("\n\n")[1]
    assert blocks("README.md", "python") == blocks("docs/index.md", "python")
    assert len(readme.splitlines()) < 125  # short


def test_the_readme_quotes_no_figure_that_no_command_measured() -> None:
    """Rows of its tables of measurements stand in docs/measured.md or docs/peers.md as they are."""
    text = (ROOT / "README.md").read_text()
    written = (ROOT / "docs" / "measured.md").read_text()
    tables = re.findall(r"^\| what \| measured \|.*?(?=^$)", text, re.DOTALL | re.MULTILINE)
    rows = [row for table in tables for row in table.splitlines()[2:]]
    assert len(rows) > 12
    assert [row for row in rows if row.rstrip(" |") not in written] == []
    peers = (ROOT / "docs" / "peers.md").read_text(encoding="utf-8")
    between = text.partition("<!-- peers -->")[2].partition("<!-- end of peers -->")[0]
    assert "| CalculiX |" in between and between.strip() in peers


def test_tables_of_the_readme_are_replaced(tmp_path: Path) -> None:
    page = tmp_path / "README.md"
    page.write_text("a\n<!-- one -->\n\nold\n\n<!-- end of one -->\nb\n")
    write_between("one", ["| new |"], page)
    assert page.read_text() == "a\n<!-- one -->\n\n| new |\n\n<!-- end of one -->\nb\n"
    with pytest.raises(ValueError, match="there is no <!-- two -->"):
        write_between("two", [], page)


def test_first_block_of_sweeps(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """With fewer speeds and a shorter run than on the page."""
    matplotlib.use("Agg")
    monkeypatch.chdir(tmp_path)
    block = blocks("docs/sweeps.md", "python")[0]
    short = block.replace("150, 151", "60, 4").replace("(20.0, 30.0)", "(0.5, 1.0)")
    assert short.count("60, 4") == short.count("(0.5, 1.0)") == 1
    exec(short, {})
    assert (tmp_path / "fig6.png").exists() and any((tmp_path / "fig6").iterdir())


def test_the_first_two_shell_blocks_are_install_and_test() -> None:
    install, test = blocks("README.md", "sh")[:2]
    assert "beamdyn reproduce" in install and "pytest" in test


def test_page_on_spreads(finished) -> None:
    """Its Python runs, and its command prints the ranges of the page, which follow from no random number."""
    names: dict[str, object] = {}
    exec(blocks("docs/spread.md", "python")[0], names)
    command = blocks("docs/spread.md", "sh")[0].replace("\\\n", " ").splitlines()[0]
    shown = finished(main(shlex.split(command)[1:]), 0).out
    page = blocks("docs/spread.md", "text")[0].splitlines()
    ranges = page[page.index("Ranges, by Ritz, at most 14 functions, batched") :][4:6]
    assert [line.rpartition("corner")[0] in shown for line in ranges] == [True, True]  # then the error
    assert all(line.startswith(" mode") for line in ranges)
