"""Screens that follow from the descriptions of analyses: a form of their options beside the scene's."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Mapping
from inspect import Parameter
from itertools import pairwise
from typing import Any, Literal, get_args, get_origin

from pydantic import Field, create_model

from beamdyn.analyses.analysis import Analysis, Answer
from beamdyn.app.inputs import ASIDE, read_aside, read_scene
from beamdyn.app.scene_screen import drawn, scene_screen
from beamdyn.common.edge.inputs import Section, parts_of
from beamdyn.common.edge.wording import of_file
from beamdyn.common.results.result import Result
from beamdyn.common.screens.folded_parts import FoldedPicture
from beamdyn.common.screens.screens import Screen
from beamdyn.results.cautions import warnings_of

_KINDS = (str, int, float)  # types of options that a form can have


def analysis_screen(analysis: Analysis) -> Screen:
    """Make the screen of an analysis."""
    table = analysis.function.__name__
    ASIDE[table] = _section(analysis)

    def solve(tables: Mapping[str, Any]) -> Answer:
        given = dict(read_aside(tables, table))
        paths = {name: f"{table}.{name}" for name in given}
        with of_file(paths):
            return analysis.answer(read_scene(tables), given, named=paths.__getitem__)

    def notes(answer: Answer) -> list[str]:
        said = warnings_of(answer.result) if answer.warnings is None else answer.warnings
        return [*([answer.refusal] if answer.refusal else []), *said]

    def result(answer: Answer) -> Result:
        return answer.result

    more = (FoldedPicture("Picture", lambda answer: drawn(answer.result)),)
    return scene_screen(analysis.screen, analysis.question, solve, (table,), result, notes=notes, more=more)


def first_entries(analysis: Analysis) -> dict[str, str]:
    """Entries of the form on opening: the options of the example in the help of the command."""
    words = shlex.split(analysis.examples[0])
    table = analysis.function.__name__
    given = {
        f"{table}.{word[2:].replace('-', '_')}": text for word, text in pairwise(words) if word[:2] == "--"
    }
    return {f"{table}.{name}": given.get(f"{table}.{name}", "") for name in _section(analysis).model_fields}


def _section(analysis: Analysis) -> type[Section]:
    """The table of an analysis' options."""
    fields: Any = dict(_fields(analysis))
    return create_model(f"{analysis.name}Input", __base__=Section, **fields)


def _fields(analysis: Analysis) -> Iterator[tuple[str, Any]]:
    for name, option in analysis.shown.items():
        kind = get_args(option.annotation)[0] if get_args(option.annotation) else option.annotation
        if name != "physics" and _stands_on_a_form(kind):
            default = ... if option.default is Parameter.empty else option.default
            yield name, (kind, Field(default, description=analysis.meaning(name)))


def _stands_on_a_form(kind: Any) -> bool:
    """Whether an option is a number, a text or a choice: files and groups of options are not."""
    return get_origin(kind) is not tuple and any(
        part in _KINDS or get_origin(part) is Literal for part in parts_of(kind)
    )
