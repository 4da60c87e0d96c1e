"""Columns of a blade file of ElastoDyn that stand in another order than that in which it reads them."""

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.cli import main
from tests.unit import decks_written as written

GIVEN = {"length": written.LENGTH, "hub_radius": written.HUB}


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "sub").mkdir()
    for path in ("blade.dat", "sub/blade.dat"):
        (tmp_path / path).write_text(written.elastodyn_blade())
    (tmp_path / "main.dat").write_text(written.elastodyn_main())
    return tmp_path


def in_order(path, order):
    """The blade file at a path with its columns, heads and units too, in another order."""
    lines = path.read_text().splitlines()
    first = next(i for i, line in enumerate(lines) if line.startswith("BlFract"))
    for i in range(first, first + 2 + len(written.STATIONS)):
        words = lines[i].split()
        lines[i] = "  ".join(words[k] for k in order)
    path.write_text("\n".join(lines) + "\n")


def test_columns_in_another_order_than_elastodyn_reads_are_warned_of(folder, finished):
    assert not [said for said in bd.read_deck(folder / "main.dat").audit.warnings if "headings" in said]
    in_order(folder / "sub" / "blade.dat", (0, 1, 2, 4, 3, 5))
    deck = bd.read_deck(folder / "main.dat")
    np.testing.assert_allclose(deck.scene.beam.bending_stiffness(0.0), written.FLAP[0])  # by their heads
    assert "it takes the values under FlpStff as BMassDen" in deck.audit.warnings[0]
    err = finished(main(["import", str(folder / "main.dat")]), 0).err
    assert "expected BlFract, PitchAxis, StrcTwst, BMassDen, FlpStff, EdgStff" in err


def test_a_blade_file_without_the_column_that_newer_versions_lack_is_in_order(folder):
    in_order(folder / "blade.dat", (0, 2, 3, 4, 5))
    assert not [
        said for said in bd.read_deck(folder / "blade.dat", **GIVEN).audit.warnings if "headings" in said
    ]
