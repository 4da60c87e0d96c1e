"""Options that several commands share: output files, and inputs that are varied or have a tolerance.

Each output file is checked before anything is computed.
"""

from __future__ import annotations

import os
import tomllib
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, fields, is_dataclass
from itertools import combinations
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from cyclopts import Parameter, Token

from beamdyn.common.results.files import check_writable, same_file, write_text
from beamdyn.common.results.pictures import Figure, save_figure
from beamdyn.common.spreading import DEFAULT_SAMPLES

if TYPE_CHECKING:
    from beamdyn.common.edge.html_report import Report
    from beamdyn.common.results.result import Result

Flag = Annotated[bool, Parameter(negative="")]

_TABLES = (".csv", ".tsv", ".txt", "")  # suffixes of table files; "" for a file name without suffix
_SUFFIXES = {
    "json": (".json", ".txt", ""),
    "csv": _TABLES,
    "crossings": _TABLES,
    "cycles-file": (".json", *_TABLES),
    "plot": (".png", ".svg", ".pdf"),
    "report": (".html", ".htm"),
    "shapes": (".vtu", ".vtk"),
    "series": (".xdmf",),
    "animation": (".gif",),
    "free-bodies": (".png", ".svg", ".pdf"),
}


class Files:
    """Base class of the options for output files, which all commands share."""

    plot: Path | None = None
    json: Path | None = None
    csv: Path | None = None
    report: Path | None = None
    force: bool = False

    @property
    def draws(self) -> bool:
        """Return whether the options request a picture."""
        return self.plot is not None or self.report is not None

    def check(self, *inputs: str | Path | None, **more: Path | None) -> None:
        """Raise an error, before anything is computed, if a file is unwritable, an input or named twice.

        Parameters
        ----------
        *inputs : str or Path
            Files and folders that the command reads; None for those that are not given.
        **more : Path, optional
            Files of further options, by the option's name.

        Raises
        ------
        ValueError
            If a file cannot be written, is an input or lies in one, or is named twice.
        """
        own = {"plot": self.plot, "json": self.json, "csv": self.csv, "report": self.report}
        given = {option: path for option, path in (own | more).items() if path is not None}
        read = [place for i in inputs if i is not None and given for place in (i, *_named_by(Path(i)))]
        for option, path in given.items():
            above = (path, *Path(os.path.realpath(path)).parents)
            for needed in read:
                if any(same_file(place, needed) for place in above):
                    said = f"the command itself needs {needed}; give another file"
                    raise ValueError(f"--{option} = {path}: {said}")
        for (one, path), (other, same) in combinations(given.items(), 2):
            if same_file(path, same):
                raise ValueError(f"--{one} and --{other} = {same}: give each its own file")
        for option, path in given.items():
            try:
                remedy = "add --force to overwrite it, or give another name"
                check_writable(path, _SUFFIXES.get(option, ()), self.force, remedy)
            except (OSError, ValueError) as error:
                raise ValueError(f"--{option} = {error}") from None


@Parameter(name="*")
@dataclass(frozen=True)
class Outputs(Files):
    """Files to write.

    Parameters
    ----------
    plot : Path, optional
        Draw the result into this file: .png, .svg or .pdf.
    json : Path, optional
        Write the result with its error estimate and provenance into this file: .json.
    csv : Path, optional
        Write a table for other programs into this file: .csv, .tsv or .txt.
    report : Path, optional
        Write inputs, results, drawings and warnings into this self-contained file: .html.
    force : bool
        Overwrite files that exist.
    """

    plot: Path | None = None
    json: Path | None = None
    csv: Path | None = None
    report: Path | None = None
    force: Flag = False


@Parameter(name="*")
@dataclass(frozen=True)
class AnswerFiles(Files):
    """Output files for a result that is one number, or a list of words.

    Parameters
    ----------
    json : Path, optional
        Write the result with its error estimate and provenance into this file: .json.
    report : Path, optional
        Write inputs, result and warnings into this self-contained file: .html.
    force : bool
        Overwrite files that exist.
    """

    json: Path | None = None
    report: Path | None = None
    force: Flag = False


NO_FILES = Outputs()
NO_ANSWER_FILES = AnswerFiles()


def write(
    result: Result,
    outputs: Files,
    rows: Iterable[Sequence[object]] = (),
    draw: Callable[[], Figure] | None = None,
    report: Report | None = None,
) -> None:
    """Write the result into the files that the options request.

    Parameters
    ----------
    result : Result
        Result of the command, for the JSON file.
    outputs : Outputs
        The files, which have been checked.
    rows : iterable of sequence
        Rows of the CSV file; the first row holds the column headings.
    draw : callable, optional
        Draws the picture, and returns it.
    report : Report, optional
        Contents of the HTML report.
    """
    if outputs.json is not None:
        write_text(outputs.json, result.to_json())
    if outputs.csv is not None:
        write_table(outputs.csv, rows)
    if outputs.report is not None and report is not None:
        write_text(outputs.report, report.page(draw))
    if outputs.plot is not None and draw is not None:
        save_figure(draw(), outputs.plot, outputs.force)


def write_table(path: Path, rows: Iterable[Sequence[object]]) -> None:
    """Write rows into a text file, separated by commas, or by tabs if the file's suffix is .tsv."""
    # Imported here, since the import loads numpy, which is not needed to show help.
    from beamdyn.common.edge.rendering import csv_text

    write_text(path, csv_text(rows, "\t" if path.suffix.lower() == ".tsv" else ","))


def _named_by(scene: Path) -> list[Path]:
    """Return the CSV files of cross-sections or recorded motions that a scene file names; else none."""
    try:
        tables = tomllib.loads(scene.read_text(encoding="utf-8-sig"))
    except (OSError, ValueError, RecursionError):  # the error is reported later, on reading
        return []
    named = []
    for *path, key in (("beam", "stations"), ("motion", "file"), ("motion", "rotation", "file")):
        table: object = tables
        for name in path:
            table = table.get(name) if isinstance(table, dict) else None
        named.append(table.get(key) if isinstance(table, dict) else None)
    return [scene.parent / name for name in named if isinstance(name, str)]


# Inputs that are varied ------------------------------------------------------------------------------

OPTION, SPREAD = "--vary", "--spread"


def given_options(group: Any) -> dict[str, object]:
    """Return the options of a group, and of groups within it, that differ from their defaults."""
    given: dict[str, object] = {}
    for option in fields(group):
        value = getattr(group, option.name)
        if is_dataclass(value):
            given |= given_options(value)
        elif value != option.default:
            given[option.name] = value
    return given


_MOST_WORKERS = 128


def folder(_: object, tokens: Sequence[Token]) -> Path:
    """Convert the name of a folder to a path; refuse an empty name, which would mean the current folder."""
    if not tokens[0].value.strip():
        raise ValueError("the name is empty; give a folder, or leave the option out.")
    return Path(tokens[0].value)


Folder = Annotated[Path | None, Parameter(converter=folder)]
SomeFolder = Annotated[Path, Parameter(converter=folder)]  # a folder option that has a default folder


def _check_workers(_: object, value: object) -> None:
    if isinstance(value, int) and value > _MOST_WORKERS:
        raise ValueError(f"Give at most {_MOST_WORKERS}.")


Workers = Annotated[int, Parameter(validator=_check_workers)]


@Parameter(name="*")
@dataclass(frozen=True)
class VaryOptions:
    """Inputs that are varied, and how the designs are computed.

    Parameters
    ----------
    vary : tuple of str
        An input and its values: NAME=start:stop:count and a unit, such as "NAME=0.1:0.4:31 mm"; at equal
        ratios "NAME=1e-4:1e-1:13:log"; or a list, "NAME=0.2,0.25,0.3 mm". Give the option once for each
        input. Names are those of the file.
    together : bool
        Take the first values of all inputs, then the second, in place of all combinations.
    workers : int
        Number of processes; the result does not depend on it.
    store : Path, optional
        Folder in which finished designs are kept; the same command resumes from it.
    """

    vary: Annotated[tuple[str, ...], Parameter(negative="", consume_multiple=False, show_default=False)] = ()
    together: Flag = False
    workers: Workers = 1
    store: Folder = None

    @property
    def combine(self) -> Literal["product", "zip"]:
        """Return "product" for all combinations of the inputs' values, "zip" if n-th values go together."""
        return "zip" if self.together else "product"

    def check(self) -> None:
        """Raise an error for options that have no effect unless an input is varied."""
        for name in given_options(self):
            if not self.vary:
                raise ValueError(f"--{name} goes with {OPTION}: without {OPTION} there is one design only")


NOTHING_VARIED = VaryOptions()


# Tolerances ----------------------------------------------------------------------------------------


def _whole(_: object, tokens: Sequence[Token]) -> int:
    """Read a whole number; the option parser cyclopts would silently cut 2.5 down to 2."""
    text = tokens[0].value.strip()
    if not (text.isascii() and text.isdecimal()):
        raise ValueError(f'"{text}" is not a whole number of 0 or more.')
    return int(text)


@Parameter(name="*")
@dataclass(frozen=True)
class SpreadOptions:
    """Inputs that have a tolerance, and how many random designs are drawn.

    Parameters
    ----------
    spread : tuple of str
        An input and its tolerance, NAME=tolerance, such as "NAME=+-2%", "NAME=+1% -2%", "NAME=+-0.01 mm",
        "NAME=0.19 mm to 0.21 mm" (all values as likely), or "NAME=sd 1%" (normal). Give the option once for
        each input. Names are those of the file.
    samples : int
        Number n of designs in each of 2 + d random samples of d inputs: a power of two, at least 128.
    seed : int
        Seed of the random designs, a whole number; the same seed gives the same designs.
    """

    spread: Annotated[
        tuple[str, ...], Parameter(negative="", consume_multiple=False, show_default=False)
    ] = ()
    samples: Annotated[int, Parameter(converter=_whole)] = DEFAULT_SAMPLES
    seed: Annotated[int, Parameter(converter=_whole)] = 0

    def check(self, varying: VaryOptions) -> None:
        """Raise an error for options that contradict each other, or inputs both varied and with tolerance."""
        for name in given_options(self):
            if not self.spread:
                raise ValueError(f"--{name} goes with {SPREAD}: no random designs are drawn without it")
        if not self.spread:
            return
        both = {_key(text) for text in self.spread} & {_key(text) for text in varying.vary}
        if both:
            name = min(both)
            raise ValueError(
                f"{name} is given to {OPTION} and to {SPREAD}: an input is varied, or has a tolerance"
            )
        if varying.vary or varying.together:
            given = OPTION if varying.vary else "--together"
            raise ValueError(f"{given} does not go with {SPREAD}: give one of them")


NO_SPREAD = SpreadOptions()


def _key(text: str) -> str:
    return text.partition("=")[0].strip()
