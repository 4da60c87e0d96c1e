"""Pictures as files, and the colours of their lines."""

from __future__ import annotations

from collections.abc import Iterable
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

from beamdyn.common.files import check_writable, replacing

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# Okabe and Ito's colours, which colour-blind people can tell apart; without yellow, pale on white.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
SUFFIXES = (".png", ".svg", ".pdf")
ANIMATION_SUFFIXES = (".gif",)


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
    OSError
        If it cannot be written.
    """
    path = check_writable(path, SUFFIXES, force)
    figure: Any = drawn.figure  # of axes, a subfigure perhaps; of a figure, itself
    content = BytesIO()  # matplotlib does not close a file that it cannot write
    figure.figure.savefig(content, format=path.suffix[1:].lower(), dpi=150, bbox_inches="tight")
    with replacing(path) as aside:
        aside.write_bytes(content.getvalue())
    return path


def save_animation(
    figure: Figure, path: str | Path, frames: Iterable[object], dpi: float, rate: float, force: bool = False
) -> None:
    """Write an animation of a figure that changes.

    Parameters
    ----------
    figure : Figure
        The figure.
    path : str or Path
        File to write, .gif.
    frames : iterable
        Each step to its next item draws one frame.
    dpi : float
        Resolution [1/inch].
    rate : float
        Frames per second.
    force : bool
        Overwrite a file that exists.

    Raises
    ------
    ValueError, FileExistsError, OSError
        As for `save_figure`.
    """
    from matplotlib import rc_context
    from matplotlib.animation import PillowWriter

    path = check_writable(path, ANIMATION_SUFFIXES, force)
    writer = PillowWriter(fps=rate)  # pyright: ignore[reportArgumentType]  (any rate will do)
    with replacing(path) as aside, rc_context({"savefig.bbox": None}):  # all frames have one size
        writer.setup(figure, str(aside), dpi)
        for _ in frames:
            writer.grab_frame()
        writer.finish()
