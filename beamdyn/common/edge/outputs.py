"""Files that commands write: options, checks before anything is computed, and writing."""

from __future__ import annotations

import os
import tomllib
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import combinations
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from beamdyn.common.results.files import check_writable, same_file, write_text
from beamdyn.common.results.pictures import Axes, Figure, figure_of, save_figure

if TYPE_CHECKING:
    from beamdyn.common.edge.html_report import Report
    from beamdyn.common.results.result import Result


Flag = Annotated[bool, Parameter(negative="")]

_TABLES = (".csv", ".tsv", ".txt", "")  # suffixes of tables; a name without a suffix may be a table
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
    """Files to write: base of the options that commands of all kinds share."""

    plot: Path | None = None
    json: Path | None = None
    csv: Path | None = None
    report: Path | None = None
    force: bool = False

    @property
    def draws(self) -> bool:
        """Whether a picture is wanted."""
        return self.plot is not None or self.report is not None

    def check(self, *inputs: str | Path | None, **more: Path | None) -> None:
        """Refuse, before anything is computed, a file that cannot be written or would destroy another.

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
        Write inputs, results, drawings and warnings into this file, which needs no other: .html.
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
    """Files to write of an answer that is one number or a list in words.

    Parameters
    ----------
    json : Path, optional
        Write the result with its error estimate and provenance into this file: .json.
    report : Path, optional
        Write inputs, result and warnings into this file, which needs no other: .html.
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
    """Write the requested files.

    Parameters
    ----------
    result : Result
        The result, for the JSON file.
    outputs : Outputs
        The files, which have been checked.
    rows : iterable of sequence
        Rows of the CSV file, heads first.
    draw : callable, optional
        Makes the picture.
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
    """Write rows as text, separated by commas, or by tabs in a file named .tsv."""
    # Imported here, since it loads numpy, which help does without.
    from beamdyn.common.edge.rendering import csv_text

    write_text(path, csv_text(rows, "\t" if path.suffix.lower() == ".tsv" else ","))


def check_folder(option: str, folder: Path) -> None:
    """Refuse, before anything is computed, a folder that cannot be made or written in."""
    there = next(place for place in (folder, *folder.absolute().parents) if place.exists())
    if not there.is_dir():
        raise ValueError(f"--{option} = {folder}: {there} is a file; give a folder")
    try:
        check_writable(there / "picture.png", force=True)
    except OSError as error:
        raise ValueError(f"--{option} = {folder}: {error}") from None


def on_axes(draw: Callable[[Axes], object]) -> Callable[[], Figure]:
    """Return a function that makes a figure with what `draw` draws on axes."""
    return partial(figure_of, draw)


def _named_by(scene: Path) -> list[Path]:
    """Return the files of stations or records that a scene file names; empty for other files."""
    try:
        tables = tomllib.loads(scene.read_text(encoding="utf-8-sig"))
    except (OSError, ValueError, RecursionError):  # the error is reported when the file is read
        return []
    named = []
    for *path, key in (("beam", "stations"), ("motion", "file"), ("motion", "rotation", "file")):
        table: object = tables
        for name in path:
            table = table.get(name) if isinstance(table, dict) else None
        named.append(table.get(key) if isinstance(table, dict) else None)
    return [scene.parent / name for name in named if isinstance(name, str)]
