"""Files that commands write."""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from beamdyn.common.edge.html_report import Report
    from beamdyn.common.results import Result

Flag = Annotated[bool, Parameter(negative="")]

_SUFFIXES = {
    "plot": (".png", ".svg", ".pdf"),
    "report": (".html", ".htm"),
    "shapes": (".vtu", ".vtk"),
    "series": (".xdmf",),
    "animation": (".gif",),
}


@Parameter(name="*")
@dataclass(frozen=True)
class Outputs:
    """Files to write.

    Parameters
    ----------
    plot : Path, optional
        Draw the result into this file: .png, .svg or .pdf.
    json : Path, optional
        Write the result with its error estimate and provenance into this file.
    csv : Path, optional
        Write a table for other programs into this file.
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

    def check(self, **more: Path | None) -> None:
        """Refuse, before anything is computed, a file that cannot be written."""
        own = {"plot": self.plot, "json": self.json, "csv": self.csv, "report": self.report}
        paths = {**own, **more}
        given = {option: path for option, path in paths.items() if path is not None}
        for option, path in given.items():
            _check_output(option, path, self.force)
        if len({path.absolute() for path in given.values()}) < len(given):
            raise ValueError(f"{' and '.join('--' + o for o in given)}: give each its own file")


NO_FILES = Outputs()


def write(
    result: Result,
    outputs: Outputs,
    rows: Iterable[Sequence[object]] = (),
    draw: Callable[[], Figure] | None = None,
    report: Report | None = None,
) -> None:
    """Write the requested files; `rows` are those of the CSV file, `draw` makes the picture."""
    if outputs.json is not None:
        from beamdyn.common.results import to_json

        outputs.json.write_text(to_json(result.to_dict()), encoding="utf-8")
    if outputs.csv is not None:
        with outputs.csv.open("w", encoding="utf-8", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows(rows)
    if outputs.report is not None and draw is not None and report is not None:
        outputs.report.write_text(report.page(draw), encoding="utf-8")
    if outputs.plot is not None and draw is not None:
        from beamdyn.common.pictures import save_figure

        save_figure(draw(), outputs.plot, outputs.force)


def on_axes(draw: Callable[[Axes], object]) -> Callable[[], Figure]:
    """Turn a function that draws on axes into one that makes a figure."""

    def made() -> Figure:
        from matplotlib.figure import Figure

        figure = Figure(figsize=(7.5, 4.8), layout="constrained")
        draw(figure.subplots())
        return figure

    return made


def _check_output(option: str, path: Path, force: bool) -> None:
    suffixes = _SUFFIXES.get(option)
    if suffixes and path.suffix.lower() not in suffixes:
        raise ValueError(
            f"--{option} = {path}: unknown suffix {path.suffix!r}; give one of {', '.join(suffixes)}"
        )
    if path.is_dir():
        raise ValueError(f"--{option} = {path}: it is a folder; give the name of a file")
    if not path.parent.is_dir():
        raise ValueError(f"--{option} = {path}: there is no folder {path.parent}; create it first")
    if path.exists() and not force:
        raise ValueError(
            f"--{option} = {path}: the file exists; add --force to overwrite it, or give another name"
        )
