"""Pictures as files, and the colours of their lines."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# Okabe and Ito's colours, which colour-blind people can tell apart; without yellow, pale on white.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
SUFFIXES = (".png", ".svg", ".pdf")


def save_figure(drawn: Axes | Figure, path: str | Path, force: bool = False) -> Path:
    """Write a picture as PNG, SVG or PDF.

    Parameters
    ----------
    drawn : Axes or Figure
        The picture, or axes in it.
    path : str or Path
        File to write; its suffix .png, .svg or .pdf chooses the format.
    force : bool
        Overwrite a file that exists.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    ValueError
        If the suffix is unknown.
    FileExistsError
        If the file exists and `force` is not set.
    FileNotFoundError
        If there is no such directory.
    """
    path = output_path(path, SUFFIXES, force)
    figure: Any = drawn.figure  # of axes, a subfigure perhaps; of a figure, itself
    figure.figure.savefig(path, dpi=150, bbox_inches="tight")
    return path


def output_path(path: str | Path, suffixes: Sequence[str], force: bool = False) -> Path:
    """Check that a file may be written.

    Parameters
    ----------
    path : str or Path
        File to write.
    suffixes : sequence of str
        Suffixes allowed, in lower case, with their dots.
    force : bool
        Overwrite a file that exists.

    Returns
    -------
    Path

    Raises
    ------
    ValueError
        If the suffix is none of those allowed.
    FileExistsError
        If the file exists and `force` is not set.
    FileNotFoundError
        If there is no such directory.
    """
    path = Path(path)
    if path.suffix.lower() not in suffixes:
        raise ValueError(f"{path}: unknown suffix {path.suffix!r}; give one of {', '.join(suffixes)}")
    if path.exists() and not force:
        raise FileExistsError(f"{path} exists; choose another name, or overwrite it with force")
    if not path.parent.is_dir():
        raise FileNotFoundError(f"{path}: there is no directory {path.parent}; create it first")
    return path
