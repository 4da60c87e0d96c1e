"""The screen of any planar mechanism: its points, joints and loads, as files of parts have them."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any

from matplotlib.figure import Figure

from beamdyn.common.app.screens import Document, Handle, Screen, Slider
from beamdyn.common.edge.config import ConfigError
from beamdyn.common.edge.inputs import Input
from beamdyn.common.edge.units import show
from brakes.answers.caliper import Answer, CaliperAnswer
from brakes.app import caliper
from brakes.app.bases import base
from brakes.app.caliper import notes, sweeps_of
from brakes.config.mechanism import MechanismInput, parse_mechanism
from brakes.config.mechanism_inputs import PARTS, mechanism_inputs


def inputs_of(entries: Mapping[str, str]) -> list[Input]:
    """Inputs of a mechanism with the points that there are."""
    return mechanism_inputs(path.removeprefix("points.") for path in entries if path.startswith("points."))


def check(text: str, source: str) -> object:
    """Parse a file as the commands do.

    Raises
    ------
    ConfigError
        If it does not describe a mechanism part by part, or in words that the form has no place for.
    """
    given = parse_mechanism(text, source)
    if not isinstance(given, MechanismInput):
        raise ConfigError(source, ["caliper: it is a named caliper, which has a screen of its own"])
    if dotted := [name for name in given.points if "." in name]:
        raise ConfigError(
            source, [f"points: {show(dotted[0])} has a dot; give the point another name, e.g. with a dash"]
        )
    return given


def solve(tables: Mapping[str, Any]) -> Answer:
    """The mechanism as drawn and over its stroke.

    Raises
    ------
    ConfigError
        If the tables do not describe one.
    NoAnswer
        If it cannot be assembled or does not reach the end of its stroke.
    """
    parts = [part for part in PARTS if isinstance(tables.get(part), str)]
    if parts:
        raise ConfigError("mechanism", [f"{part}: {_why(tables[part])}" for part in parts], parts)
    return caliper.solve(tables)


def _why(text: str) -> str:
    """Why a text is no list of parts."""
    form = 'give a list of tables, e.g. [{ name = "A", body = "arm", at = "B" }]'
    try:
        tomllib.loads(f"parts = {text}")
    except (ValueError, RecursionError) as error:
        return f"not valid TOML: {re.sub(r', column [0-9]+', '', str(error))}; {form}"
    return form


def draw(found: Answer, progress: float = 1.0) -> Figure:
    """The mechanism at a part of its stroke, from 0 to 1, and what the loads do over it."""
    return caliper.draw(found, progress) if isinstance(found, CaliperAnswer) else found.figure(progress)


def handles(found: Answer, _: float) -> Sequence[Handle]:
    """The named points, as drawn."""
    points = found.given.points if isinstance(found.given, MechanismInput) else {}
    return [
        Handle(name, (float(x), float(y)), partial(_moved, name), scale=1e3)
        for name, (x, y) in points.items()
    ]


def _moved(name: str, x: float, y: float) -> dict[str, tuple[float, float]]:
    return {f"points.{name}": (x, y)}


_TABLES = ("points", "run", "caliper", "stop")
MECHANISM = Document(
    "mechanism",
    base("mechanism"),
    inputs_of,
    check,
    (
        Screen(
            "Mechanism",
            "Any planar mechanism of bodies, joints and loads: every force, as drawn and over a stroke.",
            ("", *_TABLES),
            ("title", "bodies", *PARTS, *_TABLES),
            solve,
            lambda found: found.tables(),
            draw,
            notes,
            lambda found: found.rows(),
            slider=Slider("stroke", ("as drawn", "end of the stroke"), step=0.1),
            sweeps=sweeps_of("points.C.x=17:20:13 mm", "work"),
            more=(("Free bodies", lambda found: found.free_bodies()),),
            handles=handles,
        ),
    ),
)
