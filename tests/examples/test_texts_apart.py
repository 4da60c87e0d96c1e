"""No two texts of a picture overlap, in what commands draw of the examples."""

from __future__ import annotations

import shlex
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

import beamdyn as bd
from beamdyn.analyses import analyses
from beamdyn.cli import commands
from beamdyn.common.plots.curves import plot_work_precision
from brakes.cli import main as brakes
from tests.drawn_texts import drawn_texts, overlapping

ROOT = Path(__file__).parents[2]
BEAMS = [p for p in (ROOT / "examples").glob("*.toml") if "\n[beam" in f"\n{p.read_text()}"]
SCENES = sorted(p.name for p in BEAMS if "large_deflection = true" not in p.read_text())  # those take minutes
_SLOW = (pytest.mark.slow,)
BRAKES = [
    *(
        pytest.param(name, f"{name}.toml", marks=pytest.mark.slow)
        for name in ("band", "block", "cone", "disc")
    ),
    *(pytest.param(name, f"{name}.toml") for name in ("drum", "forklift", "sliding")),
    *(
        pytest.param(
            "caliper", f"calipers/{path.name}", marks=_SLOW * (path.stem not in ("cantilever", "v-brake"))
        )
        for path in sorted((ROOT / "examples" / "calipers").glob("*.toml"))
        if "toggle" not in path.stem
    ),
]
OF_MAP = ("--vary", "mount.radius=100:300:5 mm", "--vary", "speed=0:300:5 rpm", "--modes", "2")
COMMANDS = (
    ("locus", "--speeds", "0:40:11 rad/s"),
    ("draw",),
    ("loads", "--speed", "20 rad/s"),
    ("campbell", "--top-speed", "40 rad/s"),
    ("response", "--frequencies", "1:100:50 Hz"),
    ("study", *OF_MAP),
    ("sensitivities",),
)
_LONG = "tradeoff", "random-loads", "loads", "equilibrium", "response", "random", "branches", "steady"
_NO_PICTURE = ("critical", "limits", "matrices", "terms")


@pytest.fixture
def draw(monkeypatch, tmp_path):
    """Run a command of a program; the pictures that it would write."""
    drawn: list[Figure] = []
    monkeypatch.setattr(
        "beamdyn.common.edge.command_options.save_figure",
        lambda picture, *_: drawn.append(picture.figure.figure),
    )
    monkeypatch.chdir(ROOT)

    def run(main, *words: str) -> list[Figure]:
        main([*words, "--plot", str(tmp_path / "picture.png")])
        return drawn

    return run


def examples_of_commands():
    for each in analyses().values():
        for text in each.examples:
            words = shlex.split(text)[1:]
            for option in ("--plot", "--json"):
                if option in words:
                    del words[words.index(option) : words.index(option) + 2]
            if words[0] not in _NO_PICTURE:
                slow = words[0] in _LONG or "--spread" in words or "critical_speed" in words
                yield pytest.param(words, marks=_SLOW * slow, id=" ".join(words[:4]))


@pytest.mark.parametrize("last", np.geomspace(3e-4, 3e-2, 15))
def test_labels_of_times_on_any_machine(last):
    """Over less than two decades ticks between the powers have labels, also where the picture is narrow."""
    figure = Figure(figsize=(5.0, 4.8))
    points = np.array([[2.1e-4, 1.0], [last, 1e-12]])
    plot_work_precision({"Ritz": points}, points, ax=figure.add_subplot())
    assert overlapping(figure) == []


@pytest.mark.parametrize("words", [*examples_of_commands()])
def test_examples_in_the_help_of_commands(draw, words):
    assert [overlapping(figure) for figure in draw(commands.main, *words)] == [[]]


@pytest.mark.parametrize(("command", "file"), BRAKES)
def test_brakes(draw, command, file):
    assert [overlapping(figure) for figure in draw(brakes, command, str(ROOT / "examples" / file))] == [[]]


@pytest.mark.slow
@pytest.mark.parametrize("scene", SCENES)
@pytest.mark.parametrize("command", COMMANDS, ids=lambda command: command[0])
def test_every_scene_by_every_command(draw, scene, command):
    figures = draw(commands.main, command[0], f"examples/{scene}", *command[1:])
    assert not any(overlapping(figure) for figure in figures)


SIDES = {"beam.thickness": np.linspace(1e-4, 4e-4, 11), "speed": np.linspace(0.0, 150.0, 11)}


@pytest.fixture(scope="module", params=[{}, {"mount.radius": [0.1, 0.2, 0.3]}], ids=["two inputs", "three"])
def study(request):
    scene = bd.load_scene(ROOT / "examples" / "rolling_harvester.toml")
    return bd.study(scene, SIDES | request.param, modes=2)


@pytest.mark.parametrize("scale", [0.7, 1.0, 1.6])
def test_maps_at_three_sizes(study, scale):
    width, height = study.picture_size()
    figure = Figure(figsize=(scale * width, scale * height), layout="constrained")
    study.plot(figure.subplots())
    assert overlapping(figure) == []
    texts = [text for text, _ in drawn_texts(figure)]
    assert "buckles" in texts and "present design" in texts


def test_a_map_on_a_narrow_page(study):
    figure = Figure(figsize=(4.0, 18.0), layout="constrained")
    study.plot(figure.subplots())
    assert overlapping(figure) == []


def test_what_overlaps_is_found():
    figure = Figure()
    figure.text(0.5, 0.5, "one")
    figure.text(0.5, 0.505, "other")
    assert overlapping(figure) == [("one", "other")]
