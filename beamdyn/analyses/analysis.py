"""Description of an analysis, from which its command, screen, report and manual page are made."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, is_dataclass, replace
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, get_args, get_origin, get_type_hints

from cyclopts import Parameter

from beamdyn.analyses.results.cautions import describe_choice, describe_left_out, noted, warnings_of
from beamdyn.analyses.values import check_moves, in_unit_of
from beamdyn.common.edge import exit_codes
from beamdyn.common.edge.command_options import NO_FILES, Files, Outputs, given_options, write
from beamdyn.common.edge.config import read
from beamdyn.common.edge.console import show
from beamdyn.common.edge.html_report import Question, Report
from beamdyn.common.edge.views import picture_of, rows_of, tables_of
from beamdyn.common.results.pictures import Axes, figure_of
from beamdyn.files.scenes import load_scene

if TYPE_CHECKING:
    from rich.console import RenderableType

    from beamdyn.common.results.result import Result
    from beamdyn.scene.scene import Scene

Physics = Annotated[
    Literal["auto"] | None,
    Parameter(
        help="auto: add the effects whose size exceeds the tolerance, in place of the physics of the scene."
    ),
]


# Roles of an option, in its annotation: an output file, a choice of what pictures show, a second input file.
WRITTEN, DRAWN, READ_SECOND = "written", "drawn", "read second"


def _option(name: str) -> str:
    """Return the name of an option on the command line, such as "--top-speed"."""
    return f"--{name.replace('_', '-')}"


@dataclass(frozen=True)
class AsText:
    """An option given as text, such as a number with its unit, which is converted for a scene.

    Parameters
    ----------
    read : callable
        ``read(option, text, scene)`` returns the value in SI units; it raises a ValueError that names the
        option.
    default : str, optional
        Default text.
    absent : callable, optional
        ``absent(scene)`` returns the value if the option is not given; without `absent` and `default`, the
        option is required.
    """

    read: Callable[[str, str, Scene], Any]
    default: str | None = None
    absent: Callable[[Scene], Any] | None = None

    def shown(self, option: inspect.Parameter) -> inspect.Parameter:
        """Return the option as the command line has it, with a text as its value."""
        notes = Parameter(allow_leading_hyphen=True), *_extras(option.annotation)
        if self.default is None and self.absent is not None:
            return option.replace(annotation=Annotated[str | None, *notes], default=None)
        default = inspect.Parameter.empty if self.default is None else self.default
        return option.replace(annotation=Annotated[str, *notes], default=default)

    def value(self, option: str, text: str | None, scene: Scene) -> Any:
        """Return the value that a text means, or, if the option is not given, its default for the scene."""
        if text is None:
            return None if self.absent is None else self.absent(scene)
        return self.read(option, text, scene)


@dataclass(frozen=True)
class Answer:
    """A result, with messages, tables and drawing that differ from the defaults for its class.

    Parameters
    ----------
    result : Result
        The result.
    refusal : str
        The reason why the model has no solution; empty if it has one.
    warnings : sequence of str, optional
        Warnings; by default the warnings of the result.
    tables : sequence of rich renderables, optional
        Tables and sentences for the console; by default those of the result's class.
    draw : callable, optional
        Draws the result on axes; by default as its class does.
    tolerance : float, optional
        Tolerance that the errors of the result should not exceed; otherwise a warning is given.
    """

    result: Result
    refusal: str = ""
    warnings: Sequence[str] | None = None
    tables: Sequence[RenderableType] | None = None
    draw: Callable[[Axes], object] | None = None
    tolerance: float | None = None

    @property
    def cautions(self) -> Sequence[str]:
        """Return the warnings on the result, including those on model errors, which are computed here."""
        return warnings_of(self.result, self.tolerance) if self.warnings is None else self.warnings


@dataclass(frozen=True)
class Analysis:
    """An analysis of a scene.

    Parameters
    ----------
    function : callable
        ``function(scene, **options)`` returns a result or an `Answer`.  The name of the function is the name
        of the command, its docstring is the help text, and the annotations of its keyword arguments describe
        the options.  It receives `outputs`, and the `file` of the scene, only if it has arguments with these
        names.
    examples : tuple of str
        Example commands that can be typed as they are.
    about_scene : str
        Parts of the scene that the analysis uses, in words.
    moving : callable
        ``moving(options)`` returns whether the scene must have a motion.
    physics : type, optional
        Annotation of the option on physical effects; None if the analysis uses those of the scene.
    screen : str
        Name of the screen made from the analysis; empty if there is none.
    opens_with : tuple of str
        Initial options of the screen, as typed; empty for the options of the first example.
    sooner : callable, optional
        ``sooner(scene, **options)`` returns a preliminary result, whose picture the screen shows until the
        result of `function` is available; by default, a result with few modes.
    """

    function: Callable[..., Result | Answer]
    examples: tuple[str, ...]
    about_scene: str = "The scene."
    moving: Callable[[Mapping[str, Any]], bool] = lambda _: False
    physics: Any = Physics
    screen: str = ""
    opens_with: tuple[str, ...] = ()
    sooner: Callable[..., Result | Answer] | None = None

    @property
    def name(self) -> str:
        """Return the name of the command: the name of the function, with hyphens."""
        return self.function.__name__.replace("_", "-")

    @cached_property
    def options(self) -> dict[str, inspect.Parameter]:
        """Return the options by name, with annotations: first the function's own, then the common ones."""
        own = [p for p in inspect.signature(self.function).parameters.values() if p.kind is p.KEYWORD_ONLY]
        names = vars(inspect.getmodule(self.function))
        found = {p.name: p.replace(annotation=eval(p.annotation, names)) for p in own}
        outputs = found.pop("outputs", _keyword("outputs", Outputs, NO_FILES))
        found.pop("file", None)
        if self.physics is not None:
            found["physics"] = _keyword("physics", self.physics, None)
        return found | {"outputs": outputs}

    @cached_property
    def texts(self) -> dict[str, AsText]:
        """Return the descriptions of the options that are given as text, by name."""
        return {
            name: note
            for name, each in self.options.items()
            for note in _extras(each.annotation)
            if isinstance(note, AsText)
        }

    @cached_property
    def shown(self) -> dict[str, inspect.Parameter]:
        """Return the options as the command line and forms have them, by name."""
        texts = {name: text.shown(self.options[name]) for name, text in self.texts.items()}
        return self.options | texts

    @property
    def question(self) -> str:
        """Return the first line of the function's docstring: the question that the analysis answers."""
        return (self.function.__doc__ or "").partition("\n")[0]

    def meaning(self, name: str) -> str:
        """Return the explanation of an option: from the function's docstring, else from the option's type."""
        notes = [note.help for note in _extras(self.options[name].annotation) if isinstance(note, Parameter)]
        return next(filter(None, [meanings_in(self.function).get(name), *notes]), "")

    def command(self) -> Callable[..., None]:
        """Make the function of the command, with a signature from which the help text is made."""

        def run(scene: Path, /, *second: Path | None, **options: Any) -> None:
            named = (name for name, each in self.options.items() if READ_SECOND in _extras(each.annotation))
            self.run(scene, options | dict(zip(named, second, strict=False)))

        file = Annotated[Path, Parameter(name="SCENE.toml", help=self.about_scene)]
        first = inspect.Parameter("scene", inspect.Parameter.POSITIONAL_ONLY, annotation=file)
        shown = sorted(map(_placed, self.shown.values()), key=lambda option: option.kind)
        run.__name__, run.__doc__ = self.function.__name__, self.function.__doc__
        run.__signature__ = inspect.Signature([first, *shown])  # pyright: ignore[reportFunctionMemberAccess]
        run.__annotations__ = {each.name: each.annotation for each in (first, *shown)}
        return run

    def run(self, file: Path, options: Mapping[str, Any]) -> None:
        """Analyse the scene of a file, write the requested files, and print the result."""
        given = {name: options.get(name, each.default) for name, each in self.shown.items()}
        outputs: Files = given.pop("outputs")
        written, others, asked = self._sort(given)
        outputs.check(file, *others, **written)
        for name, each in self.options.items():
            if DRAWN in _extras(each.annotation) and given[name] is not None and not outputs.draws:
                remedy = "give --plot or --report, or leave it out"
                raise ValueError(f"{_option(name)} = {given[name]}: it only affects pictures; {remedy}")
        scene = load_scene(file)
        if self.moving(given):
            check_moves(scene, file)
        # Results are displayed in the unit of a given speed.
        scene = in_unit_of(scene, *(given[name] for name in self.texts))
        if given.get("physics") is not None:
            scene = replace(scene, physics=given["physics"])
        question = Question.of(f"beamdyn {self.name}", file, read(file), **asked)
        deliver(self.answer(scene, given, outputs, file=file), outputs, question)

    def answer(
        self,
        scene: Scene,
        given: Mapping[str, Any],
        outputs: Files = NO_FILES,
        named: Callable[[str], str] = _option,
        file: Path | None = None,
        by: Callable[..., Result | Answer] | None = None,
    ) -> Answer:
        """Compute the result for a scene.

        Parameters
        ----------
        scene : Scene
            The scene, with the requested physical effects.
        given : mapping
            Values of the options; options in `texts` as text.
        outputs : Outputs
            Requested output files.
        named : callable
            ``named(name)`` returns the name of an option for the user.
        file : Path, optional
            The file that contains the scene, if any.
        by : callable, optional
            Function to call in place of `function`, with the same options.
        """
        values = {name: value for name, value in given.items() if name != "physics"}
        values |= {name: text.value(named(name), given[name], scene) for name, text in self.texts.items()}
        own = {"outputs": outputs, "file": file}
        values |= {
            name: own[name] for name in own.keys() & inspect.signature(self.function).parameters.keys()
        }
        made = (by or self.function)(scene, **values)
        return made if isinstance(made, Answer) else Answer(made)

    def _sort(self, given: Mapping[str, Any]) -> tuple[dict[str, Path], list[Path], dict[str, object]]:
        """Return output files by option, paths in other options, and all options except output files."""
        # Values and annotations of options; options in a group are listed one by one.
        options: dict[str, tuple[Any, Any]] = {}
        for name, value in given.items():
            if is_dataclass(value):
                hints = get_type_hints(type(value), include_extras=True)
                options |= {each: (own, hints[each]) for each, own in given_options(value).items()}
            else:
                options[name] = value, self.options[name].annotation
        written = {name for name, (_, annotation) in options.items() if WRITTEN in _extras(annotation)}
        asked: dict[str, object] = {name: each for name, (each, _) in options.items() if name not in written}
        read = [value for value in asked.values() if isinstance(value, Path)]
        return {_option(name)[2:]: options[name][0] for name in written}, read, asked


def analysis(*examples: str, **about: Any) -> Callable[[Callable[..., Any]], Analysis]:
    """Return a decorator that makes an `Analysis` of a function, with the given attributes."""
    return lambda function: Analysis(function, examples, **about)


def meanings_in(documented: object) -> dict[str, str]:
    """Return the explanations of the parameters in a docstring, by name."""
    from docstring_parser import parse

    return {each.arg_name: each.description or "" for each in parse(documented.__doc__ or "").params}


def deliver(answer: Answer, outputs: Files, question: Question) -> None:
    """Write the requested files, then print the result and its warnings.

    Parameters
    ----------
    answer : Answer
        The result to write and print.
    outputs : Outputs
        Requested output files.
    question : Question
        The command and its input, for the report.

    Raises
    ------
    NoAnswer
        If the model has no solution; raised after all files are written.
    """
    result, refusal = answer.result, answer.refusal
    draw = picture_of(result) if answer.draw is None else partial(figure_of, answer.draw)
    if draw is None and outputs.plot is not None:
        raise ValueError(f"--plot = {outputs.plot}: this result has no picture; give --json or --csv")
    draw = None if draw is None else noted(draw, result)
    tables = [*([tables_of(result)] if answer.tables is None else answer.tables), *describe_choice(result)]
    tables += describe_left_out(result)
    warnings = answer.cautions
    refusals = [refusal] if refusal else []
    # Files are written first, so that a user who closes the output does not lose a long computation.
    write(result, outputs, rows_of(result), draw, Report(question, tables, [*warnings, *refusals]))
    show(tables)
    exit_codes.warn("beamdyn", warnings)
    if refusal:
        raise exit_codes.NoAnswer(refusal)


def _keyword(name: str, annotation: Any, default: Any = inspect.Parameter.empty) -> inspect.Parameter:
    return inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=annotation)


def _placed(option: inspect.Parameter) -> inspect.Parameter:
    """Return the option for the command: positional if it names the second input file."""
    second = READ_SECOND in _extras(option.annotation)
    return option.replace(kind=inspect.Parameter.POSITIONAL_ONLY) if second else option


def _extras(annotation: Any) -> tuple[Any, ...]:
    """Return the extra entries of an annotation: all that `Annotated` adds to the type."""
    return get_args(annotation)[1:] if get_origin(annotation) is Annotated else ()
