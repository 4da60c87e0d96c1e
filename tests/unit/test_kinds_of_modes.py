"""What deforms in each mode of a strip: in results, tables and files."""

from dataclasses import replace
from io import StringIO
from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.figure import Figure
from rich.console import Console

import beamdyn as bd
from beamdyn.common.edge.views import rows_of, tables_of
from beamdyn.modes.modal.model import kinds_of_modes
from benchmarks.cases.scenes import HARVESTER

BEAM = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0, poissons_ratio=0.3)
STRIP = bd.Scene(BEAM, bd.Mount(0.215), physics=bd.Physics(camber=True, torsion=True))
WIDE = replace(STRIP, beam=bd.Beam.rectangular(0.05, 0.05, 0.0002, 200e9, 7850.0, poissons_ratio=0.3))
BASIS = bd.Ritz(8)


def printed(table):
    console = Console(width=120, record=True, file=StringIO(), markup=False)
    console.print(table)
    return console.export_text()


def columns(csv):
    head, *rows = csv
    return dict(zip(head, zip(*rows, strict=True), strict=True))


def test_kinds_of_the_published_strip():
    modes = bd.natural_modes(STRIP, modes=4)
    assert modes.kind.tolist() == ["bending", "bending", "torsion", "bending"]
    assert [label.rpartition(", ")[2] for label in modes.labels()] == modes.kind.tolist()


def test_kinds_of_a_square_plate():
    kinds = bd.natural_modes(WIDE, modes=5, discretization=BASIS).kind
    assert kinds.tolist() == ["bending", "torsion", "bending", "camber", "torsion"]


def test_a_mode_in_the_other_direction_bends():
    scene = replace(STRIP, physics=replace(STRIP.physics, planes=2))
    modes = bd.natural_modes(scene, modes=7, discretization=BASIS)
    assert (modes.kind[modes.plane_share[:, 1] > 0.5] == "bending").all() and "torsion" in modes.kind


@pytest.mark.parametrize(
    ("energy", "kind"),
    [((1.0, 1.0, 1.0), "bending"), ((1 - 1e-10, 1.0, 1.0), "bending"), ((1 - 1e-8, 1.0, 1.0), "torsion")],
)
def test_equal_shares_are_decided_by_the_order(energy, kind):
    places = {"bending": [0], "torsion": [1], "camber": [2]}
    equations = SimpleNamespace(
        blocks=places,
        deflecting=["bending"],
        momentum=lambda vectors: vectors,
        places=lambda names: np.concatenate([places[name] for name in names]),
    )
    assert kinds_of_modes(equations, np.sqrt(energy)[None, :, None]).item() == kind


def test_modes_over_speed_have_their_kinds():
    locus = bd.frequency_locus(STRIP, [0.0, 100.0], 3, BASIS)
    assert locus.kind.tolist() == [["bending", "bending", "torsion"]] * 2
    assert columns(rows_of(locus))["kind_3"] == ("torsion", "torsion")
    text = printed(tables_of(locus))
    assert "(t: mostly torsion)" in text and text.count(" t ") == 2


def test_tables_and_files_have_kinds_where_sections_deform():
    modes = bd.natural_modes(STRIP, modes=3, discretization=BASIS)
    assert columns(rows_of(modes))["kind"] == ("bending", "bending", "torsion")
    assert modes.to_dict()["kind"] == ["bending", "bending", "torsion"]
    assert "stable   torsion" in printed(tables_of(modes))
    bends = bd.natural_modes(STRIP, modes=2, discretization=BASIS)
    assert " kind " not in printed(tables_of(bends)) and "kind" in columns(rows_of(bends))


def test_beams_that_only_bend_have_no_column_of_kinds():
    modes, locus = bd.natural_modes(HARVESTER), bd.frequency_locus(HARVESTER, [0.0, 1.0], 2)
    assert set(modes.kind) == set(locus.kind.ravel()) == {"bending"} and locus.kind.shape == (2, 2)
    for result in (modes, locus):
        heads = [*result.to_dict(), *columns(rows_of(result))]
        assert not [head for head in heads if "kind" in head]


def test_kinds_are_kept_in_files(tmp_path):
    for result in (bd.natural_modes(STRIP, modes=3), bd.frequency_locus(STRIP, [0.0], 3)):
        result.save(tmp_path / "result.json", force=True)
        assert bd.load(tmp_path / "result.json").kind.tolist() == result.kind.tolist()


def test_modes_over_speed_are_named_by_their_kinds():
    speeds = [0.0, 50.0]
    locus = bd.frequency_locus(STRIP, speeds, 3, BASIS)
    assert locus.names() == ("mode 1", "mode 2", "mode 3, torsion")
    legend = locus.plot(Figure().subplots()).get_legend().get_texts()
    assert [text.get_text() for text in legend] == [*locus.names()]
    blade = replace(STRIP, mount=bd.Mount(0.2, np.pi, bending_angle=np.pi / 2))
    assert bd.campbell(STRIP, speeds, modes=3).names == (locus.names(),)
    assert bd.campbell(blade, speeds, modes=3).names == (("flap 1", "flap 2", "torsion 1"),)
