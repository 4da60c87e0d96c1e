"""Writing of pictures as files, colours of lines, and plots of several results on the same axes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import wraps
from inspect import Parameter, signature
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from beamdyn.common.results.files import check_writable, replacing

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
else:
    # Names for type annotations; matplotlib is imported only when something is drawn.
    Artist = Axes = Figure = Any

# The palette of Okabe and Ito, which colour-blind people can tell apart; without yellow, pale on white.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
DASHES = ("-", "--", "-.", ":")
_MOST_INSIDE = 6  # most entries of a legend inside the axes; with more it is beside them
# Most characters in an entry of a legend inside the axes; with a longer entry it is placed below them.
_LONGEST_INSIDE = 28
SUFFIXES = (".png", ".svg", ".pdf")
ANIMATION_SUFFIXES = (".gif",)


def save_figure(drawn: Axes | Figure, path: str | Path, force: bool = False) -> Path:
    """Write a picture as PNG, SVG or PDF.

    Parameters
    ----------
    drawn : Axes or Figure
        The figure, or axes in the figure.
    path : str or Path
        File to write; its suffix .png, .svg or .pdf determines the format.
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
    figure: Any = drawn.figure  # axes may be in a subfigure: its parent is needed
    content = BytesIO()  # written in memory first, as matplotlib does not close a file that it cannot write
    figure.figure.savefig(content, format=path.suffix[1:].lower(), dpi=150, bbox_inches="tight")
    with replacing(path) as aside:
        aside.write_bytes(content.getvalue())
    return path


def save_animation(
    figure: Figure, path: str | Path, frames: Iterable[object], dpi: float, rate: float, force: bool = False
) -> None:
    """Write an animation of a figure that changes from frame to frame.

    Parameters
    ----------
    figure : Figure
        The figure.
    path : str or Path
        File to write, .gif.
    frames : iterable
        Iterable that draws one frame each time the next item is taken.
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
    with replacing(path) as aside, rc_context({"savefig.bbox": None}):  # all frames must have the same size
        writer.setup(figure, str(aside), dpi)
        for _ in frames:
            writer.grab_frame()
        writer.finish()


def add_legend(ax: Axes) -> Axes:
    """Add a legend: inside the axes, beside them if it has many entries, or below them for long entries."""
    labels = ax.get_legend_handles_labels()[1]
    place: dict[str, Any] = {"loc": "best"}
    if max(map(len, labels), default=0) > _LONGEST_INSIDE:
        # The offset leaves space for the label of the axis, four font sizes high, at any height of the axes.
        place = {"loc": "upper center", "bbox_to_anchor": (0.5, 0.0), "borderaxespad": 4.2, "ncols": 2}
    elif len(labels) > _MOST_INSIDE:
        place = {"loc": "upper left", "bbox_to_anchor": (1.01, 1.0), "borderaxespad": 0.0}
    ax.legend(fontsize=10, **place)
    return ax


def figure_of(draw: Callable[[Axes], object], size: tuple[float, float] = (7.5, 4.8)) -> Figure:
    """Make a figure of a given size [inch] with axes on which `draw` draws; pyplot does not keep it open."""
    figure = new_figure(*size)
    draw(figure.subplots())
    return figure


def new_axes(width: float = 7.5, height: float = 4.8) -> Axes:
    """Make axes of a new figure of a given size [inch], which pyplot keeps open until it is closed."""
    from matplotlib import pyplot

    return pyplot.subplots(figsize=(width, height), layout="constrained")[1]


def new_figure(width: float, height: float, layout: Literal["constrained"] | None = "constrained") -> Figure:
    """Make an empty figure of a given size [inch], with constrained layout, so that texts do not overlap."""
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout=layout)


# Several results on the same axes ---------------------------------------------------------------------


def labelled(plot: Callable[..., Axes]) -> Callable[..., Axes]:
    """Give a method that draws a result the option `label`, which names the result in the legend.

    Entries of the legend then begin with the label, and colours that are already used on the axes are not
    used again.  The default is the `plot_label` of the result.
    """
    known = signature(plot)

    @wraps(plot)
    def drawn(self: Any, *arguments: Any, label: str | None = None, **options: Any) -> Axes:
        ax = known.bind(self, *arguments, **options).arguments.get("ax")
        before = [] if ax is None else [*_marks(ax)]
        made = plot(self, *arguments, **options)
        if text := self.plot_label if label is None else label:
            _tell_apart(made, before if made is ax else [], text)
        return made

    option = Parameter("label", Parameter.KEYWORD_ONLY, default=None, annotation="str | None")
    each = [*known.parameters.values()]
    drawn.__dict__["__signature__"] = known.replace(parameters=[*each, option])
    return drawn


def _marks(ax: Axes) -> Iterator[Artist]:
    """Yield the lines, areas, bars and texts on axes."""
    marks: Any = (*ax.lines, *ax.collections, *ax.containers, *ax.patches, *ax.texts)
    yield from marks


def _tell_apart(ax: Axes, before: list[Artist], text: str) -> None:
    """Put a label before the legend entries of new marks (not in `before`), and give them other colours.

    The colours change only if older marks (`before`) have one of them.  They are shifted in `COLOURS` by the
    number of older marks' colours; or replaced by unused colours if the list is too short for the shift.
    """
    new = [mark for mark in _marks(ax) if not any(mark is old for old in before)]
    taken, own = _colours(before), _colours(new)
    moves: dict[int, int] = {}
    if taken & own:
        moves = {place: place + len(taken) for place in own}
        free = [place for place in range(len(COLOURS) - 1) if place not in taken]
        if max(moves.values()) >= len(COLOURS) and len(free) >= len(own):
            moves = dict(zip(sorted(own), free, strict=False))
    for mark in new:
        _recolour(mark, moves)
    names = [mark for mark in new if _name(mark)]
    for mark in names or [mark for mark in new if hasattr(mark, "get_data")][:1]:
        mark.set_label(f"{text}, {_name(mark)}" if _name(mark) else text)
    if new:
        add_legend(ax)


def _name(mark: Artist) -> str:
    """Return the name of a line or area in the legend; empty if it has none."""
    label = str(mark.get_label())
    return "" if label.startswith("_") else label


def _colours(marks: Iterable[Artist]) -> set[int]:
    return {place for mark in marks if (place := _place(mark)) is not None}


def _place(mark: Artist) -> int | None:
    """Return the index of a line's or area's colour in `COLOURS`; None for any other colour."""
    from matplotlib.colors import to_hex

    given: Any = getattr(mark, "get_color", None) or getattr(mark, "get_facecolor", None)
    colour = None if given is None else given()
    if colour is not None and not isinstance(colour, str):
        colour = colour[0] if len(colour) and not isinstance(colour[0], float) else colour
    # Black, the last colour, does not count: elements other than curves are drawn in it.
    known = {to_hex(each): place for place, each in enumerate(COLOURS[:-1])}
    return None if colour is None or not len(colour) else known.get(to_hex(colour))


def _recolour(mark: Artist, moves: Mapping[int, int]) -> None:
    """Change a mark's colour: `moves` maps the index of each colour in `COLOURS` to a new index.

    A new index beyond the end of `COLOURS` counts on from the first colour, and makes a line dashed.
    """
    place, line = _place(mark), hasattr(mark, "get_linestyle")
    if place is None or place not in moves:
        return
    cycle, colour = divmod(moves[place], len(COLOURS))
    new: dict[str, Any] = {"color": COLOURS[colour]}
    if cycle and line and mark.get_linestyle() == "-":  # pyright: ignore[reportAttributeAccessIssue]
        new["linestyle"] = DASHES[cycle % len(DASHES)]
    mark.set(**new)
