"""Export of mode shapes and motions as mesh files, for ParaView and the like, and as animations.

The only module that uses meshio.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from beamdyn.common.inputs.checks import ascending
from beamdyn.common.results.files import check_writable, replacing
from beamdyn.common.results.pictures import save_animation

if TYPE_CHECKING:
    import meshio
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D
    from matplotlib.text import Text

SHAPE_SUFFIXES = (".vtu", ".vtk")  # not .xdmf, for which meshio needs h5py
SERIES_SUFFIXES = (".xdmf",)  # their numbers are written as text
_DRAWN_RATIO = 0.1  # largest drawn deflection, and default width, relative to the length


def write_shapes(
    path: str | Path,
    x: np.ndarray | Sequence[float],
    shapes: np.ndarray,
    labels: Sequence[str],
    width: float | np.ndarray | Sequence[float] | None = None,
    force: bool = False,
) -> None:
    """Write mode shapes as a mesh with one displacement field a mode.

    The file is in the beam's own axes, wherever the carrier holds it: x along the beam from its root,
    y across its width, z the direction in which it bends.  The size of a mode being arbitrary, the
    largest deflection of each is a tenth of the length: ParaView's "Warp By Vector" shows it at scale 1.

    Parameters
    ----------
    path : str or Path
        File to write; its suffix .vtu or .vtk chooses the format; the latter, the legacy
        format, has underscores for the spaces in labels.
    x : array_like, shape (n,)
        Positions along the beam [m], ascending, at least two.
    shapes : ndarray, shape (m, n)
        Deflections of the modes at the positions, real, in any unit.
    labels : sequence of str, length m
        Name of each mode's field, e.g. "mode 1: 65.23 Hz"; no two alike.
    width : float or array_like, shape (n,), optional
        Width of the strip drawn [m]; a tenth of the length if not given, 0 for a line.
    force : bool
        Overwrite a file that exists.

    Raises
    ------
    ValueError
        If the suffix is unknown or the arrays do not fit together.
    FileExistsError
        If the file exists and `force` is not set.
    OSError
        If it cannot be written.
    """
    path = check_writable(path, SHAPE_SUFFIXES, force)
    kind = path.suffix[1:].lower()
    strip = _strip(x := ascending("x", x), width)
    fields = _scale(_check_shapes(x, shapes, labels), _DRAWN_RATIO * (x[-1] - x[0]))
    for label, deflection in zip(labels, fields, strict=True):
        name = label.replace(" ", "_") if kind == "vtk" else label
        strip.point_data[name] = _displacement(deflection, len(strip.points))
    with replacing(path) as aside:
        strip.write(aside, file_format=kind)


def write_series(
    path: str | Path,
    x: np.ndarray | Sequence[float],
    t: np.ndarray | Sequence[float],
    deflection: np.ndarray,
    width: float | np.ndarray | Sequence[float] | None = None,
    force: bool = False,
    across: np.ndarray | None = None,
) -> None:
    """Write the deflected beam over time as one mesh with a displacement field at each time.

    The file is in the beam's own axes, as that of `write_shapes`, but deflections keep their size.
    In ParaView (reader "Xdmf3" or "XDMF") use "Warp By Vector" and play.

    Parameters
    ----------
    path : str or Path
        File to write, .xdmf.
    x : array_like, shape (n,)
        Positions along the beam [m], ascending, at least two.
    t : array_like, shape (k,)
        Times [s], ascending.
    deflection : ndarray, shape (k, n)
        Deflections at the times and positions [m].
    width : float or array_like, shape (n,), optional
        Width of the strip drawn [m]; a tenth of the length if not given, 0 for a line.
    force : bool
        Overwrite a file that exists.
    across : ndarray, shape (k, n), optional
        Deflections [m] in the direction across, which is -y.

    Raises
    ------
    ValueError
        If the suffix is unknown or the arrays do not fit together.
    FileExistsError
        If the file exists and `force` is not set.
    OSError
        If it cannot be written.
    """
    from meshio.xdmf import TimeSeriesWriter

    path = check_writable(path, SERIES_SUFFIXES, force)
    x, t, deflection = _check_history(x, t, deflection)
    _, _, sideways = _check_history(x, t, np.zeros_like(deflection) if across is None else across)
    strip = _strip(x, width)
    with replacing(path) as aside, TimeSeriesWriter(aside, data_format="XML") as writer:
        writer.write_points_cells(strip.points, strip.cells)
        for time, row, other in zip(t.tolist(), deflection, sideways, strict=True):
            writer.write_data(time, {"displacement": _displacement(row, len(strip.points), other)})


def animate(
    x: np.ndarray | Sequence[float],
    t: np.ndarray | Sequence[float],
    deflection: np.ndarray,
    path: str | Path,
    force: bool = False,
    rate: float = 20.0,
    notes: Sequence[str] = (),
) -> None:
    """Write an animation of the beam, one frame for each time.

    Parameters
    ----------
    x : array_like, shape (n,)
        Positions along the beam [m], ascending.
    t : array_like, shape (k,)
        Times [s], ascending; several in each period of what is to be seen.
    deflection : ndarray, shape (k, n)
        Deflections at the times and positions [m].
    path : str or Path
        File to write, .gif.
    force : bool
        Overwrite a file that exists.
    rate : float
        Frames per second.
    notes : sequence of str
        Sentences below the picture.

    Raises
    ------
    ValueError
        If the suffix is unknown or the arrays do not fit together.
    FileExistsError
        If the file exists and `force` is not set.
    OSError
        If it cannot be written.
    """
    from matplotlib.figure import Figure

    from beamdyn.common.plots.axes_and_lines import note_below

    x, t, deflection = _check_history(x, t, deflection)
    figure = note_below(Figure(figsize=(6.4, 3.6), layout="constrained"), notes)
    line, title = _draw_axes(figure.subplots(), x, np.abs(deflection).max())
    figure.draw_without_rendering()
    figure.set_layout_engine("none")  # laid out once, not for each frame

    def frames() -> Iterator[float]:
        for time, row in zip(t.tolist(), deflection, strict=True):
            line.set_ydata(1e3 * row)
            title.set_text(f"t = {time:.4f} s")
            yield time

    save_animation(figure, path, frames(), 100, rate, force)


def _strip(x: np.ndarray, width: float | np.ndarray | Sequence[float] | None) -> meshio.Mesh:
    """Build a strip of quadrilaterals along x, or a line if the width is 0."""
    import meshio

    if len(x) < 2:
        raise ValueError(f"x has {len(x)} position: a mesh needs at least two")
    half = _half_width(x, width)
    i = np.arange(len(x) - 1)
    if not half.any():
        return meshio.Mesh(_points(x, half), [("line", np.stack([i, i + 1], axis=1))])
    j = i + len(x)
    points = np.concatenate([_points(x, -half), _points(x, half)])
    return meshio.Mesh(points, [("quad", np.stack([i, i + 1, j + 1, j], axis=1))])


def _check_history(
    x: np.ndarray | Sequence[float], t: np.ndarray | Sequence[float], deflection: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    x, t, deflection = ascending("x", x), ascending("t", t), np.asarray(deflection, dtype=float)
    if deflection.shape != (len(t), len(x)):
        raise ValueError(
            f"deflection has shape {deflection.shape}: {len(t)} times and {len(x)} positions expected"
        )
    if not np.isfinite(deflection).all():
        raise ValueError("deflection: every value must be finite")
    return x, t, deflection


def _draw_axes(ax: Axes, x: np.ndarray, largest: float) -> tuple[Line2D, Text]:
    """Draw the beam's line and a title on axes that hold the whole motion."""
    reach = 1.1e3 * largest or 1.0
    ax.set(xlim=(0, 1e3 * x[-1]), ylim=(-reach, reach))
    ax.set(xlabel="position along the beam [mm]", ylabel="deflection [mm]")
    ax.grid(color="0.85", linewidth=0.7)
    ax.axhline(0, color="0.4", linewidth=0.8)
    (line,) = ax.plot(1e3 * x, 0 * x, color="#0072B2", linewidth=2.5)
    return line, ax.set_title("t = 0 s")


def _half_width(x: np.ndarray, width: float | np.ndarray | Sequence[float] | None) -> np.ndarray:
    full = np.asarray(_DRAWN_RATIO * (x[-1] - x[0]) if width is None else width, dtype=float)
    if full.shape not in ((), x.shape) or not (np.isfinite(full) & (full >= 0)).all():
        raise ValueError(
            f"width = {width}: give a width of 0 or more [m], or one for each of {len(x)} positions"
        )
    return np.broadcast_to(full / 2, x.shape)


def _points(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    return np.stack([x, y, np.zeros_like(x)], axis=1)


def _check_shapes(x: np.ndarray, shapes: np.ndarray, labels: Sequence[str]) -> np.ndarray:
    shapes = np.asarray(shapes)
    if np.iscomplexobj(shapes) or not np.isfinite(shapes).all():
        raise ValueError("shapes: deflections must be real and finite; of a complex mode give the real part")
    if shapes.shape != (len(labels), len(x)):
        raise ValueError(
            f"shapes has shape {shapes.shape}: {len(labels)} labels times {len(x)} positions expected"
        )
    if len(set(labels)) < len(labels):
        raise ValueError(f"labels {list(labels)}: two are alike; a mode's field needs a name of its own")
    return shapes


def _scale(shapes: np.ndarray, largest: float) -> np.ndarray:
    """Scale shapes to a given largest deflection; a shape of zeros stays."""
    size = np.abs(shapes).max(axis=1, keepdims=True)
    return shapes * (largest / np.where(size == 0, 1.0, size))


def _displacement(deflection: np.ndarray, points: int, across: np.ndarray | float = 0.0) -> np.ndarray:
    """Displacement vectors along z, of a deflection across along -y, the same on both edges of a strip."""
    z, y = (
        np.tile(values, points // len(deflection))
        for values in (deflection, np.zeros_like(deflection) - across)
    )
    return np.stack([np.zeros_like(z), y, z], axis=1)
