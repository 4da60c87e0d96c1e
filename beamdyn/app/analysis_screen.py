"""Screens made from the description of an analysis: a form for its options, and its result."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Mapping
from dataclasses import fields as dataclass_fields
from dataclasses import is_dataclass
from functools import partial
from inspect import Parameter
from itertools import islice, pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, get_args, get_origin, get_type_hints

from pydantic import Field, create_model

from beamdyn.analyses.analysis import READ_SECOND, Analysis, Answer, meanings_in
from beamdyn.analyses.results.cautions import noted
from beamdyn.app.scene_form import ASIDE, COARSE, read_aside, read_scene
from beamdyn.app.scene_screen import scene_screen
from beamdyn.common.edge.command_options import Files
from beamdyn.common.edge.data_text import DataText
from beamdyn.common.edge.file_words import in_files
from beamdyn.common.edge.inputs import Lines, Section, of_file, parts_of
from beamdyn.common.edge.views import picture_of
from beamdyn.common.results.one_line import warned
from beamdyn.common.results.pictures import figure_of
from beamdyn.common.results.result import Result
from beamdyn.common.screens.screen_parts import KeyResult
from beamdyn.common.screens.screens import Screen

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_FEW_MODES = 6  # number of modes of a preliminary result, if the full result chooses its own by a tolerance
_HEADLINES = 3  # largest number of parts of a result's one-line summary that a screen shows
_NARROW = 4.4, 4.0  # size of a picture on a narrow page [inch]
_OF_COMMANDS = (
    "physics",
    "psd_axes",
    "workers",
    "samples",
    "seed",
)  # options that have no field in a form
_BETWEEN = ";"  # separator between several texts of an option that may be given several times


def analysis_screen(analysis: Analysis) -> Screen:
    """Make the screen of an analysis: a form with its options and the scene's inputs, and its result."""
    name = analysis.function.__name__
    ASIDE[name] = _section(analysis)

    def solve(tables: Mapping[str, Any]) -> Answer:
        given = dict(read_aside(tables, name))
        paths = {option: f"{name}.{option}" for option in given}
        options, by = _in_groups(analysis, given), analysis.sooner if COARSE in tables else None
        with of_file(paths):
            return analysis.answer(read_scene(tables), options, named=paths.__getitem__, by=by)

    def coarser(tables: Mapping[str, Any]) -> Mapping[str, Any]:
        given, modes = tables.get(name, {}), analysis.options.get("modes")
        chosen = modes is not None and given.get("modes", modes.default) == "auto"
        if chosen:
            tables = {**tables, name: {**given, "modes": _FEW_MODES}}
        return tables if analysis.sooner is None else {**tables, COARSE: {}}

    def notes(answer: Answer) -> list[str]:
        return [*([answer.refusal] if answer.refusal else []), *answer.cautions]

    def result(answer: Answer) -> Result:
        return answer.result

    def headline(answer: Answer) -> Iterator[KeyResult]:
        # The summary omits empty parts, and the number of warnings, which the screen lists below.
        beside = "", warned(getattr(answer.result, "warnings", ()))
        lines = (line for line in answer.result.headline() if line not in beside)
        yield KeyResult("in short", "; ".join(map(in_files, islice(lines, _HEADLINES))))

    return scene_screen(
        analysis.screen, analysis.question, solve, (name,), result, notes=notes, headline=headline,
        picture=_drawn_answer, coarser=coarser,
        draw=lambda answer, _=0.0: noted(partial(_drawn_answer, answer), answer.result)(),
    )  # fmt: skip


def _drawn_answer(answer: Answer, narrow: bool = False) -> Figure:
    """Draw the picture of a result, for a narrow page if `narrow`.

    Notes are not written below the picture, as the page shows them separately.
    """
    result: Any = answer.result
    if narrow:
        own = hasattr(result, "picture_size")  # a picture with several panels chooses its own size
        size, plot = (result.picture_size(_NARROW[0]), result.plot_panels) if own else (_NARROW, result.plot)
        draw = partial(figure_of, answer.draw or plot, size)
    else:
        draw = picture_of(result) if answer.draw is None else partial(figure_of, answer.draw)
    assert draw is not None
    return draw()


def first_entries(analysis: Analysis) -> dict[str, str]:
    """Return the initial field texts of a form: from `opens_with`, or from the first example."""
    name, words = analysis.function.__name__, analysis.opens_with or shlex.split(analysis.examples[0])
    given: dict[str, str] = {}
    for word, text in pairwise(words):
        if word.startswith("--"):
            option = word[2:].replace("-", "_")
            given[option] = f"{given[option]}{_BETWEEN} {text}" if option in given else text
    return {f"{name}.{option}": given.get(option, "") for option in _section(analysis).model_fields}


def _section(analysis: Analysis) -> type[Section]:
    """Make the class whose fields are the form fields of an analysis: one for each option, except for files.

    Options in groups have fields of their own.
    """
    fields: dict[str, Any] = {}
    for name, option in analysis.shown.items():
        if group := _group_of(option.annotation):
            hints, meanings = get_type_hints(group, include_extras=True), meanings_in(group)
            of_group = {each.name: each.default for each in dataclass_fields(group)}
            options = [(each, hints[each], of_group[each], meanings.get(each, "")) for each in of_group]
        else:
            if READ_SECOND in getattr(option.annotation, "__metadata__", ()):
                fields[name] = Annotated[str, Lines(meaning=f"{analysis.meaning(name)} Paste it here.")], ""
                continue
            default = ... if option.default is Parameter.empty else option.default
            options = [(name, option.annotation, default, analysis.meaning(name))]
        for each, annotation, default, meaning in options:
            if each not in _OF_COMMANDS and (kind := _in_a_form(annotation)):
                fields[each] = kind, Field(default or ("" if kind is str else default), description=meaning)
    return create_model(f"{analysis.name}Input", __base__=Section, **fields)


def _group_of(annotation: Any) -> type | None:
    """Return the class of an option that is a group of options; None for other options."""
    kind = _bare(annotation)
    return kind if isinstance(kind, type) and is_dataclass(kind) and not issubclass(kind, Files) else None


def _bare(annotation: Any) -> Any:
    return annotation.__origin__ if hasattr(annotation, "__metadata__") else annotation


def _in_a_form(annotation: Any) -> Any:
    """Return the kind of form field for an option; None if the option has no field."""
    kind = _bare(annotation)
    if get_origin(kind) is tuple:
        return str if str in get_args(kind) else None
    known = (part in (str, int, float) or get_origin(part) is Literal for part in parts_of(kind))
    return kind if any(known) and Path not in parts_of(kind) else None


def _in_groups(analysis: Analysis, given: Mapping[str, Any]) -> dict[str, Any]:
    """Return the option values as arguments of the analysis; groups of options become objects."""
    values: dict[str, Any] = {}
    for name, option in analysis.options.items():
        if group := _group_of(option.annotation):
            hints = get_type_hints(group, include_extras=True)
            own = {each: _listed(hints[each], given[each]) for each in hints if each in given}
            values[name] = group(**own)
        elif READ_SECOND in getattr(option.annotation, "__metadata__", ()):
            values[name] = DataText.of(Path(name), given[name]) if given[name] else None
        elif name in given:
            values[name] = _listed(option.annotation, given[name])
    return values


def _listed(annotation: Any, value: Any) -> Any:
    """Split the text of an option that may be given several times; return any other value unchanged."""
    if get_origin(_bare(annotation)) is not tuple:
        return value
    return tuple(part.strip() for part in (value or "").split(_BETWEEN) if part.strip())
