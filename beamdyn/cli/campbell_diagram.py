"""The command `campbell`, which draws Campbell diagrams of one scene or several."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

from cyclopts import Parameter

import beamdyn as bd
from beamdyn.analyses.about_campbell import parse_operation, parse_orders, parse_top
from beamdyn.analyses.analysis import Answer, Physics, deliver
from beamdyn.analyses.options import Discretization, FrequencyTolerance, ModeCount, Text
from beamdyn.analyses.results.of_modes import said_of_model
from beamdyn.analyses.results.of_studies import crossings_columns
from beamdyn.cli.decks import read_with
from beamdyn.common.edge.command_options import NO_FILES, Flag, Outputs, write_table
from beamdyn.common.edge.config import read
from beamdyn.common.edge.html_report import Question
from beamdyn.files.scenes import load_scene

if TYPE_CHECKING:
    from beamdyn.scene.scene import Scene

EXAMPLE = 'beamdyn campbell examples/twisted_blade.toml --top-speed "15 rpm" --modes 2'

SceneFiles = Annotated[tuple[Path, ...], Parameter(name="FILE", negative=())]
OfAll = Annotated[
    Physics,
    Parameter(
        help="auto: add the effects whose size exceeds the tolerance, in place of the physics of the scenes."
    ),
]


def campbell(
    scenes: SceneFiles,
    /,
    *,
    top_speed: Text,
    rated: Text | None = None,
    operating: Text | None = None,
    per_rev: Text = "6",
    modes: ModeCount = 4,
    labels: Text | None = None,
    length: Text | None = None,
    hub_radius: Text | None = None,
    bounds: Flag = False,
    discretization: Discretization = "ritz",
    tolerance: FrequencyTolerance = None,
    crossings: Path | None = None,
    physics: OfAll = None,
    outputs: Outputs = NO_FILES,
) -> None:
    """Campbell diagram: natural frequencies over rotor speed, per-rev lines, crossings and margins.

    Each file is a scene (.toml) or a blade that `beamdyn import` reads; several are drawn over one another.
    The speeds in the results have the unit of --top-speed: rpm or rad/s. The CSV file has the frequencies
    over speed.

    Parameters
    ----------
    scenes
        The scenes (.toml), or blades of ElastoDyn, FAST 7 or BModes, or CSV tables.
    top_speed
        Top speed of the diagram, with its unit, e.g. "15 rpm".
    rated
        Rated speed, at which margins are stated, with its unit, e.g. "12.1 rpm".
    operating
        Operating range, over which margins are stated and in which crossings are marked: lowest:highest with
        a unit, e.g. "6.9:12.1 rpm".
    per_rev
        Per-rev lines: "6" for 1P to 6P, one order, e.g. "2P", or a list, e.g. "3, 6, 9".
    labels
        Names of the scenes, separated by commas; default: the names of the files.
    length
        Length of the blade with its unit, if the blade's file does not say it (TipRad - HubRad).
    hub_radius
        Distance of the root from the axis of rotation with its unit, if the blade's file does not say it.
    bounds
        Also give guaranteed bounds of the frequencies at the rated speed, or else the top speed.
    crossings
        Write the crossings into this file: .csv.
    outputs
        Output files.
    """
    outputs.check(*scenes, crossings=crossings)
    options: dict[str, Any] = {"modes": modes, "discretization": discretization, "tolerance": tolerance}
    inputs = _read_all(scenes, length, hub_radius)
    # A speed in km/h needs the rolling radius of one scene: with several scenes it is refused.
    alone = inputs[0].scene if len(inputs) == 1 else None
    bent = any(given.scene.physics.large_deflection for given in inputs)
    speeds, unit = parse_top(top_speed, alone, bent)
    question = _question(
        inputs, top_speed=top_speed, rated=rated, operating=operating, per_rev=per_rev, labels=labels,
        length=length, hub_radius=hub_radius, **options, physics=physics,
    )  # fmt: skip
    by_label = _label(inputs, labels, physics)
    at, range_ = parse_operation(rated, operating, top_speed, speeds[-1], alone)
    result = bd.campbell(
        by_label, speeds, per_rev=parse_orders(per_rev), rated=at, operating=range_, unit=unit,
        bounds=bounds, **options,
    )  # fmt: skip
    if crossings is not None:
        write_table(crossings, crossings_columns(result))
    ignored = (warning for given in inputs for warning in given.warnings)
    said = *result.warnings, *result.left_out_effects.warnings(where="in speeds of crossings")
    warnings = *ignored, *(said_of_model(result, warning) for warning in said)
    deliver(Answer(result, warnings=warnings), outputs, question)


class _BladeFile(NamedTuple):
    """A scene or blade file: path, scene, scene as text, warnings on data that a scene cannot hold."""

    path: Path
    scene: Scene
    text: str
    warnings: Sequence[str]


def _read_all(paths: Sequence[Path], length: str | None, hub_radius: str | None) -> list[_BladeFile]:
    """Read the files; `length` and `hub_radius` apply only to a blade file of another program."""
    given = {"length": length, "hub_radius": hub_radius}
    decks = [path for path in paths if path.suffix.lower() != ".toml"]
    for name, text in given.items():
        if text is not None and len(decks) != 1:
            why = "scenes (.toml) have their own; leave it out"
            if decks:
                why = "it applies to one blade file; beamdyn import writes each as a scene with its own value"
            raise ValueError(f'--{name.replace("_", "-")} = "{text}": {why}')
    return [_read(path, **given) for path in paths]


def _read(path: Path, length: str | None, hub_radius: str | None) -> _BladeFile:
    if path.suffix.lower() == ".toml":
        return _BladeFile(path, load_scene(path), read(path), ())
    deck = read_with(path, length, hub_radius)
    ignored = ", ".join(f"{entry.name} ({entry.values})" for entry in deck.ignored)
    said = [f"{path}: not modelled: {ignored}; see beamdyn import {path}"] if ignored else []
    return _BladeFile(path, deck.scene, deck.scene_text(), said)


def _question(inputs: Sequence[_BladeFile], **options: object) -> Question:
    """Make the heading of a report: the command with each of its files."""
    each = [Question.of("beamdyn campbell", given.path, given.text, **options) for given in inputs]
    title = f"beamdyn campbell: {', '.join(str(given.path) for given in inputs)}"
    return Question(title, "\n\n".join(question.inputs for question in each))


def _label(inputs: Sequence[_BladeFile], labels: str | None, physics: Physics) -> dict[str, Scene]:
    """Return the scenes by label, with the effects of `physics`, if not None, in place of their own."""
    stems = [given.path.stem for given in inputs]
    names = stems if labels is None else [part.strip() for part in labels.split(",")]
    if len(names) != len(inputs) or not all(names):
        raise ValueError(f'--labels = "{labels}": give one label per scene, {len(inputs)} in all')
    twice = [name for name in dict.fromkeys(names) if names.count(name) > 1]
    if twice:
        remedy = "give --labels, one for each" if labels is None else "give each its own"
        raise ValueError(f'two scenes have the label "{twice[0]}": {remedy}')
    scenes = (given.scene for given in inputs)
    chosen = (scene if physics is None else replace(scene, physics=physics) for scene in scenes)
    return dict(zip(names, chosen, strict=True))
