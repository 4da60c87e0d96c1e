"""Layout of drawings on paper: scale of the drawing and places of all texts; lengths in [pt], y points down.

A sheet holds rows of drawings; the drawings of a row are side by side.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import accumulate, pairwise
from typing import Any, NamedTuple

import numpy as np

from beamdyn.common.drawing.label_places import FAR, LabelRequest, Obstacles, Place, keep_places, place_labels
from beamdyn.common.drawing.shapes import NORMAL, Disc, Drawing, Label, Outline, Symbol, arc, points_of_shape
from beamdyn.common.drawing.text_width import LINE_HEIGHT, line_width, text_size, wrapped

Frame = tuple[float, float, float, float]  # left, top, right and bottom edge on paper [pt]
_HEADING = 11.0  # font size of the title [pt]
_SMALL = 8.5  # font size of the key (the list of symbols) [pt]
_EDGE = 4.0  # distance between the frame and texts [pt]
# Margins between the frame and the drawing [pt], tried from the smallest to the largest.
_MARGINS = (14.0, 36.0, 60.0, 90.0)
_CROWDED = 30.0  # distance between a label and its point above which the next larger margin is tried [pt]
_SWATCH, _SPACE = 16.0, 14.0  # length of a sample line in the key, and space after the text of an entry [pt]
_BAR = 0.22  # length of the longest scale bar, as a fraction of the frame's width
_SMALL_DISC = 30.0  # largest radius of a disc whose label stands beside the disc, not on it [pt]
# Points, relative to a movable point, that labels must not cover: the page shows a handle of 16 px there.
_HANDLE = np.vstack([np.zeros((1, 2)), arc((0, 0), 4.5, 0, 2 * np.pi, 9)])
# Points (x, y) of a ground symbol that labels must not cover; unit of x: half its width, of y: its height.
_MARKS = np.array([(0.0, 0.0), (0.0, -2 / 17), (0.0, 0.5), (-0.7, 0.9), (0.0, 0.9), (0.7, 0.9)])
_PADDING = (4.0, 1.0)  # added to width and height of a text [pt], as hinting and slant widen letters


@dataclass(frozen=True)
class Fit:
    """Transformation from the coordinates of a drawing to paper.

    Parameters
    ----------
    scale : float
        Length on paper of one length unit of the drawing [pt].
    left, top : float
        Position of the drawing's origin on paper [pt].
    """

    scale: float
    left: float
    top: float

    def to_paper(self, points: Any) -> np.ndarray:
        """Convert points (..., 2) from the drawing's coordinates to paper [pt]."""
        return np.asarray(points, dtype=float) * (self.scale, -self.scale) + (self.left, self.top)

    def from_paper(self, places: Any) -> np.ndarray:
        """Convert points (..., 2) on paper [pt] to the drawing's coordinates."""
        return (np.asarray(places, dtype=float) - (self.left, self.top)) / (self.scale, -self.scale)

    @classmethod
    def of(cls, low: np.ndarray, high: np.ndarray, frame: Frame, margin: float) -> Fit:
        """Fit a rectangle of the drawing into the centre of a frame, as large as the margin allows."""
        left, top, right, bottom = frame
        room = np.array([right - left, bottom - top])
        margin = min(margin, 0.3 * float(room.min()))
        size = np.maximum(high - low, 1e-9 * float(np.abs([low, high]).max()) + 1e-300)
        scale = float(np.min((room - 2 * margin) / size))
        middle = (np.asarray(low) + high) / 2
        return cls(scale, (left + right) / 2 - scale * middle[0], (top + bottom) / 2 + scale * middle[1])


class Text(NamedTuple):
    """A placed text: centre and size of its box, lines, symbol before them, colour role, font size [pt]."""

    centre: np.ndarray
    size: tuple[float, float]
    lines: tuple[str, ...]
    symbol: str
    role: str
    letters: float

    @property
    def box(self) -> np.ndarray:
        """Return the left, top, right and bottom edge of the text's box [pt]."""
        half = np.array(self.size) / 2
        return np.concatenate([self.centre - half, self.centre + half])

    @property
    def baselines(self) -> list[float]:
        """Return the height of the baseline of each line of text on paper [pt]."""
        height = self.letters * LINE_HEIGHT
        first = float(self.centre[1]) - height * len(self.lines) / 2 + 0.5 * height + 0.36 * self.letters
        return [first + height * i for i in range(len(self.lines))]


class Rule(NamedTuple):
    """A straight line on paper: its end points (2, 2) [pt], colour role and width [pt]."""

    ends: np.ndarray
    role: str
    width: float


@dataclass(frozen=True, eq=False)
class Layout:
    """A drawing with the places of all its texts on paper.

    Parameters
    ----------
    drawing : Drawing
        The drawing.
    frame : tuple of float
        Left, top, right and bottom edge on paper [pt].
    fit : Fit
        Transformation from the drawing's coordinates to the paper.
    texts : tuple of Text
        All texts.
    rules : tuple of Rule
        Leader lines of labels, sample lines of the key, and scale bars.
    numbered : tuple of str
        Labels without a free place: they are listed below the drawing, and numbers mark their points.
    places : tuple of Place or None
        Places of the labels; None for a label without a place.
    """

    drawing: Drawing
    frame: Frame
    fit: Fit
    texts: tuple[Text, ...]
    rules: tuple[Rule, ...]
    numbered: tuple[str, ...] = ()
    places: tuple[Place | None, ...] = ()


def arrange(drawing: Drawing, frame: Frame, fit: Fit | None = None) -> Layout:
    """Compute the layout of a drawing: its scale, and places for all its texts.

    Parameters
    ----------
    drawing : Drawing
        The drawing.
    frame : tuple of float
        Left, top, right and bottom edge on paper [pt].
    fit : Fit, optional
        Transformation to paper; if not given, the drawing is made as large as the frame allows.
    """
    inner, tries = _inner(drawing, frame), []
    low, high = drawing.extent()
    # Handles at movable points need space around the drawing.
    for margin in _MARGINS[1:] if drawing.points else _MARGINS:
        found = fit or Fit.of(low, high, inner, margin)
        requests = [_request(label, found) for label in drawing.labels]
        places = place_labels(requests, _obstacles(drawing, inner, found))
        far = [1e3 if place is None else max(place.distance - _CROWDED, 0.0) for place in places]
        tries.append((sum(far), found, places))
        # Larger margins are tried until every label is close to its point; a given `fit` fixes the margin.
        if fit is not None or sum(far) == 0:
            break
    _, chosen, places = min(tries, key=lambda each: each[0])
    return _composed(drawing, frame, chosen, places, fit)


def follow(drawing: Drawing, frame: Frame, before: Layout) -> Layout:
    """Lay out a slightly changed drawing at the scale of its earlier layout `before`.

    Each label keeps its offset.  If a label would then cover another label, a symbol or the frame, all labels
    are placed again.
    """
    if len(before.places) == len(drawing.labels):
        requests = [_request(label, before.fit) for label in drawing.labels]
        obstacles = _obstacles(drawing, _inner(drawing, frame), before.fit)
        if (kept := keep_places(before.places, requests, obstacles)) is not None:
            return _composed(drawing, frame, before.fit, kept, before.fit)
    return arrange(drawing, frame, before.fit)


def _inner(drawing: Drawing, frame: Frame) -> Frame:
    """Return the part of a frame that remains below the title and above the key."""
    left, top, right, bottom = frame
    below = top + heading(drawing.title, right - left, bottom - top).height
    rows = bool(drawing.unit or drawing.newton) + len(_lines_of_key(drawing, frame, 0.0))
    return (left, below, right, bottom - (3 * _EDGE + (_SMALL * LINE_HEIGHT + 3) * rows))


def _composed(
    drawing: Drawing, frame: Frame, fit: Fit, places: Sequence[Place | None], held: Fit | None
) -> Layout:
    """Make a layout from the places of a drawing's labels.

    The drawing is made smaller than `fit` if that is needed to list labels without a place below it; the
    transformation `held`, if given, is kept.
    """
    inner = _inner(drawing, frame)
    numbered, texts, rules, fit = _with_list(drawing, inner, fit, places, held)
    key_texts, key_rules = _key(drawing, frame, fit, inner[3])
    left, top, right, bottom = frame
    lines, letters, _ = heading(drawing.title, right - left, bottom - top)
    above = []
    for i, line in enumerate(lines):
        width, height = text_size(line, letters)
        at = np.array([(left + right) / 2, top + _EDGE + height * (i + 0.5)])
        above.append(Text(at, (width, height), (line,), "", "text", letters))
    shown = (*above, *texts, *key_texts), (*rules, *key_rules)
    return Layout(drawing, frame, fit, *shown, numbered, tuple(places))


def _request(label: Label, fit: Fit) -> LabelRequest:
    width, height = text_size(label.text, label.size, label.symbol)
    (x, y), anchors = label.towards, fit.to_paper(np.reshape(label.anchors, (-1, 2)))
    return LabelRequest((width + _PADDING[0], height + _PADDING[1]), anchors, (x, -y), label.priority)


def _obstacles(drawing: Drawing, inner: Frame, fit: Fit) -> Obstacles:
    """Return the lines of a drawing that labels should not cover, and the points that they must not cover.

    Labels must stand in the part `inner` of the frame; `fit` is the transformation to paper.
    """
    segments, points = [np.empty((0, 4))], [np.empty((0, 2))]
    for shape in drawing.shapes:
        along = fit.to_paper(points_of_shape(shape))
        if isinstance(shape, Symbol):
            w, h = (shape.size / 2, 0.85 * shape.size) if shape.kind == "ground" else (0.0, 0.0)
            points.append(along + _MARKS[: 1 if not h else None] * (w, h))
            continue
        if isinstance(shape, Disc) and shape.filled:
            (x, y), r = fit.to_paper(shape.centre), shape.radius * fit.scale
            heights = np.linspace(-0.8, 0.8, 9) * r
            half = np.sqrt(r**2 - heights**2)
            chords = np.stack([x - half, y + heights, x + half, y + heights], axis=-1)
            segments.append(chords[: None if r < _SMALL_DISC else 0])  # labels avoid only small discs
        closed = isinstance(shape, Outline) and shape.closed
        pairs = np.vstack([along, along[:1]]) if closed else along
        lines = np.concatenate([pairs[:-1], pairs[1:]], axis=1)
        segments.append(lines[np.isfinite(lines).all(axis=1)])
        whole = along[np.isfinite(along).all(axis=1)]
        if len(whole) and not closed and not np.array_equal(whole[0], whole[-1]):
            points.append(whole[[0, -1]])
    points += [fit.to_paper(at) + _HANDLE for at in drawing.points.values()]
    left, top, right, bottom = inner
    within = (left + _EDGE, top + _EDGE, right - _EDGE, bottom - _EDGE)
    lines, reach = np.vstack(segments), 3 * max(right - left, bottom - top)
    middle = np.tile([(left + right) / 2, (top + bottom) / 2], 2)
    near = (np.abs(lines - middle) < reach).all(axis=1)  # ignores lines that lie far outside the frame
    return Obstacles(within, lines[near], np.vstack(points))


# Labels without a free place ----------------------------------------------------------------------


def _with_list(
    drawing: Drawing, inner: Frame, fit: Fit, places: Sequence[Place | None], held: Fit | None
) -> tuple[tuple[str, ...], list[Text], list[Rule], Fit]:
    """Return the labels that are listed below the drawing, all texts, leader lines, and the scale.

    Labels without a free place are listed; numbers mark their points.  The texts are those of labels in the
    drawing and of the list.  `inner` is the frame without title and key; the other arguments are as for
    `_composed`.
    """
    listed, bottom, fit, places = _make_room(drawing, inner, fit, places, held)
    numbers = {i: f"({number})" for number, i in enumerate(listed, 1)}
    texts, rules = [], []
    for i, (label, place) in enumerate(zip(drawing.labels, places, strict=True)):
        if place is None:  # a label whose number has no free place, either, is only listed
            continue
        shown = Label(numbers[i], label.anchors, label.role, size=_SMALL) if i in numbers else label
        size, lines = text_size(shown.text, shown.size, shown.symbol), tuple(shown.text.split("\n"))
        texts.append(Text(place.centre, size, lines, shown.symbol, shown.role, shown.size))
        if place.distance > FAR:
            nearest = np.clip(place.anchor, texts[-1].box[:2], texts[-1].box[2:])
            rules.append(Rule(np.array([nearest, place.anchor]), "axis", 0.7))
    said = tuple(drawing.labels[i].said.replace("\n", ", ") for i in listed)
    if listed:
        texts += _rows(_list_lines(said, inner, _SMALL), inner[0] + _EDGE, bottom, _SMALL, "text")
    return said, texts, rules, fit


def _make_room(
    drawing: Drawing, inner: Frame, fit: Fit, places: Sequence[Place | None], held: Fit | None
) -> tuple[list[int], float, Fit, Sequence[Place | None]]:
    """Shrink the drawing until a list of labels without a place fits below it.

    A given transformation `held` is kept: the drawing then does not shrink.
    In the smaller drawing more labels may lack a free place: the steps are repeated until all such labels
    are listed.  Returns the indices of these labels, the top of the list [pt], the scale, and all places.
    """
    listed, bottom = [], inner[3]
    more = [i for i, place in enumerate(places) if place is None]
    while more:
        listed = sorted({*listed, *more})
        lines = _list_lines([drawing.labels[i].said for i in listed], inner, _SMALL)
        bottom = inner[3] - LINE_HEIGHT * _SMALL * len(lines)
        inside = (*inner[:3], bottom)
        fit = held or Fit.of(*drawing.extent(), inside, _MARGINS[-1])
        requests = [_request(label, fit) for label in drawing.labels]
        # In the drawing, a number in brackets stands for each listed label.
        for number, i in enumerate(listed, 1):
            width, height = text_size(f"({number})", _SMALL)
            requests[i] = LabelRequest((width + 2, height), requests[i].anchors, requests[i].towards, 10)
        places = place_labels(requests, _obstacles(drawing, inside, fit))
        more = [i for i, place in enumerate(places) if place is None and i not in listed]
    return listed, bottom, fit, places


def _list_lines(said: Sequence[str], inner: Frame, size: float) -> list[str]:
    """Break the list of labels, whose texts are `said`, into lines; use at most half the frame's height.

    `inner` is the frame [pt], `size` the font size [pt].
    """
    words = "; ".join(f"({i}) {text}" for i, text in enumerate((s.replace("\n", ", ") for s in said), 1))
    lines = wrapped(words, inner[2] - inner[0] - 2 * _EDGE - _PADDING[0], size)
    most = max(1, int((inner[3] - inner[1]) / 2 / (size * LINE_HEIGHT)))
    return lines if len(lines) <= most else [*lines[: most - 1], "…"]


def _rows(lines: Sequence[str], left: float, top: float, size: float, role: str) -> Iterator[Text]:
    """Yield lines of text below one another, aligned at `left`, from `top` down [pt].

    `size` is the font size [pt]; `role` determines the colour.
    """
    for i, line in enumerate(lines):
        width, height = text_size(line, size)
        middle = np.array([left + width / 2, top + height * (i + 0.5)])
        yield Text(middle, (width, height), (line,), "", role, size)


# Title, key and scales ----------------------------------------------------------------------------


class Heading(NamedTuple):
    """Lines of a title, their font size, and their total height [pt]."""

    lines: tuple[str, ...]
    letters: float
    height: float


def heading(title: str, width: float, height: float) -> Heading:
    """Fit a title into a width [pt], using at most a third of the given height [pt]."""
    if not title:
        return Heading((), NORMAL, 0.0)
    room = width - 2 * _EDGE - 2 * _PADDING[0]
    letters = max(NORMAL, min(_HEADING, room / max(map(line_width, title.split("\n")))))
    lines = wrapped(title, room, letters)[: max(1, int(height / 3 / (letters * LINE_HEIGHT)))]
    return Heading(tuple(lines), letters, _EDGE + letters * LINE_HEIGHT * len(lines))


class _KeyItem(NamedTuple):
    """An entry of the key: length of its sample line, text, colour role, and whether it is a scale bar."""

    length: float
    words: str
    role: str
    is_scale: bool


def _entries(drawing: Drawing, frame: Frame, scale: float) -> list[_KeyItem]:
    known = [_KeyItem(_SWATCH, words, role, False) for role, words in drawing.legend.items()]
    longest = _BAR * (frame[2] - frame[0])
    if scale > 0 and drawing.unit:
        metres = {"m": 1.0, "mm": 1e-3}[drawing.unit]
        size = round_below(longest / scale * metres)
        known.append(_KeyItem(size / metres * scale, length_text(size), "dimension", True))
    if scale * drawing.newton > 0:
        size = round_below(longest / (scale * drawing.newton))
        force = f"{size / 1e3:g} kN" if size >= 1e3 else f"{size:g} N"
        known.append(_KeyItem(size * scale * drawing.newton, force, "force", True))
    return known


def round_below(value: float) -> float:
    """Return the largest number of the form 1, 2 or 5 times a power of ten that does not exceed a value."""
    power = 10.0 ** np.floor(np.log10(value))
    return float(power * max(factor for factor in (1, 2, 5) if factor * power <= value * (1 + 1e-9)))


def length_text(size: float) -> str:
    """Format a length [m] in metres, below 1 m in millimetres."""
    return f"{size:.4g} m" if size >= 1 else f"{1e3 * size:.4g} mm"


def _lines_of_key(drawing: Drawing, frame: Frame, scale: float) -> list[list[tuple[float, _KeyItem]]]:
    """Break the key into lines of entries that fit into the frame, each with its distance from the left edge.

    The `scale` [pt per unit of the drawing] determines the lengths of scale bars.
    """
    room = frame[2] - frame[0] - 2 * _EDGE
    lines: list[list[tuple[float, _KeyItem]]] = []
    at = np.inf
    for entry in _entries(drawing, frame, scale):
        width = entry.length + 4 + text_size(entry.words, _SMALL)[0] + _PADDING[0]
        if at + width > room:
            lines.append([])
            at = 0.0
        lines[-1].append((at, entry))
        at += width + _SPACE
    return lines


def _key(drawing: Drawing, frame: Frame, fit: Fit, top: float) -> tuple[list[Text], list[Rule]]:
    """Make texts and lines of the key, from the height `top` [pt] down: colours with meanings, scale bars."""
    texts, rules = [], []
    height = _SMALL * LINE_HEIGHT + 3
    for row, line in enumerate(_lines_of_key(drawing, frame, fit.scale)):
        y = top + 2 * _EDGE + height * (row + 0.5)
        for at, entry in line:
            x = frame[0] + _EDGE + at
            rules.append(Rule(np.array([(x, y), (x + entry.length, y)]), entry.role, 2.6))
            if entry.is_scale:
                ends = ((x, y), (x + entry.length, y))
                rules += [Rule(np.array([(a, y - 3), (a, y + 3)]), entry.role, 1.2) for a, _ in ends]
            texts += _rows([entry.words], x + entry.length + 4, y - height / 2 + 1.5, _SMALL, "text")
    return texts, rules


# Sheets ----------------------------------------------------------------------------------------------

Rows = Sequence[Sequence[Drawing]]
WIDTH = 680.0  # width of a sheet [pt]
_LOWEST, _HIGHEST = 300.0, 600.0  # least and largest height of a row [pt]
_DETAIL = 0.65  # width of a detail drawing, as a fraction of the width of the drawing beside it
_AROUND = 100.0  # space for title, key and labels around a drawing [pt]
_SQUARE = 320.0  # side of a square for a single drawing [pt]


@dataclass(frozen=True)
class Paper:
    """Size of a sheet: its width and the heights of its rows [pt]."""

    width: float
    heights: tuple[float, ...]

    @property
    def height(self) -> float:
        """Return the sum of the heights of all rows [pt]."""
        return sum(self.heights)

    @classmethod
    def of(cls, rows: Rows, width: float = WIDTH) -> Paper:
        """Choose the height of each row from the proportions of its drawings, within bounds."""
        return cls(width, tuple(_height(row, width) for row in rows))

    @classmethod
    def of_squares(cls, rows: Rows) -> Paper:
        """Make a sheet with one square per drawing, for example for free-body diagrams."""
        return cls(_SQUARE * max(map(len, rows)), (_SQUARE,) * len(rows))


def _widths(row: Sequence[Drawing], width: float) -> list[float]:
    """Return the widths of the drawings of a row: equal, but smaller for detail drawings."""
    parts = [_DETAIL if drawing.own_scale else 1.0 for drawing in row]
    return [width * part / sum(parts) for part in parts]


def _height(row: Sequence[Drawing], width: float) -> float:
    """Compute the height of a row of drawings on paper of a given width."""
    highest = 0.0
    for drawing, own in zip(row, _widths(row, width), strict=True):
        low, high = drawing.extent()
        across, up = high - low
        highest = max(highest, own * up / across if across else _HIGHEST)
    return min(max(highest + _AROUND, _LOWEST), _HIGHEST)


def frames_of(row: Sequence[Drawing], paper: Paper, number: int) -> list[Frame]:
    """Return the frames of the drawings in row `number`, side by side [pt]."""
    top, ends = sum(paper.heights[:number]), [0.0, *accumulate(_widths(row, paper.width))]
    return [(left, top, right, top + paper.heights[number]) for left, right in pairwise(ends)]


def lay_out(rows: Rows, paper: Paper, before: Layout | None = None) -> list[Layout]:
    """Lay out drawings on a sheet; the drawings of a row have the same scale, except for details.

    Parameters
    ----------
    rows : sequence of sequences of Drawing
        The drawings.
    paper : Paper
        Size of the sheet.
    before : Layout, optional
        Earlier layout of the first drawing, for example while the user drags a point: the scale is kept, and
        so are the labels whose places are still free.
    """
    layouts: list[Layout] = []
    for number, row in enumerate(rows):
        frames = frames_of(row, paper, number)
        held = [before if not layouts and i == 0 else None for i in range(len(row))]
        places = zip(row, frames, held, strict=True)
        made = [arrange(each, at) if kept is None else follow(each, at, kept) for each, at, kept in places]
        scale = min((each.fit.scale for each in made if not each.drawing.own_scale), default=0.0)
        free = [held[0] is not None or each.drawing.own_scale for each in made]
        layouts += [
            each if is_free or each.fit.scale == scale else _at_scale(each, scale)
            for each, is_free in zip(made, free, strict=True)
        ]
    return layouts


def _at_scale(layout: Layout, scale: float) -> Layout:
    """Lay out a drawing again at another scale, with the same centre."""
    low, high = layout.drawing.extent()
    middle = (low + high) / 2
    x, y = layout.fit.to_paper(middle)
    return arrange(layout.drawing, layout.frame, Fit(scale, x - scale * middle[0], y + scale * middle[1]))
