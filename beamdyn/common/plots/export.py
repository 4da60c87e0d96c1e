"""Export of mode shapes and motions: mesh files for ParaView and similar programs, and animations.

Only this module uses the library meshio.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from beamdyn.common.inputs.checks import ascending
from beamdyn.common.plots.axes_and_lines import note_below
from beamdyn.common.results.files import check_writable, replacing
from beamdyn.common.results.pictures import new_figure, save_animation

if TYPE_CHECKING:
    import meshio

SHAPE_SUFFIXES = (".vtu", ".vtk")  # suffixes of mesh files; not .xdmf, for which meshio needs h5py
SERIES_SUFFIXES = (".xdmf",)  # suffixes of files with shapes over time
_DRAWN_RATIO = 0.1  # largest drawn deflection, and default width of the beam, as fractions of the length


def write_shapes(
    path: str | Path,
    x: np.ndarray | Sequence[float],
    shapes: np.ndarray,
    labels: Sequence[str],
    width: float | np.ndarray | Sequence[float] | None = None,
    force: bool = False,
    across: np.ndarray | None = None,
) -> None:
    """Write mode shapes as a mesh with one displacement field per mode.

    The coordinates are those of the beam, however it is mounted: x along the beam from its root, y across its
    width, z in the direction of bending.  The amplitude of a mode is arbitrary: each mode is scaled to a
    largest deflection of a tenth of the length, so that ParaView's "Warp By Vector" shows it well at scale 1.

    Parameters
    ----------
    path : str or Path
        File to write; its suffix determines the format: .vtu, or .vtk (legacy format, with underscores in
        place of blanks in labels).
    x : array_like, shape (n,)
        Positions along the beam [m], ascending, at least two.
    shapes : ndarray, shape (m, n) or (m, n, k)
        Real deflections of the modes at the positions, in any unit; for a strip with torsion, at k positions
        across the width, evenly spaced from the edge with the lowest y to the opposite edge.
    labels : sequence of str, length m
        Different names for the modes' fields, e.g. "mode 1: 65.23 Hz".
    width : float or array_like, shape (n,), optional
        Width of the drawn strip [m]; a tenth of the length if not given, 0 for a line.
    force : bool
        Overwrite a file that exists.
    across : ndarray, shape (m, n), optional
        Deflections across the width, in the direction -y, in the same unit.

    Raises
    ------
    ValueError
        If the suffix is unknown or the shapes of the arrays do not match.
    FileExistsError
        If the file exists and `force` is not set.
    OSError
        If the file cannot be written.
    """
    path = check_writable(path, SHAPE_SUFFIXES, force)
    kind = path.suffix[1:].lower()
    x = ascending("x", x)
    shapes, aside = _check_shapes(x, shapes, labels, across)
    strip = _strip(x, width, shapes.shape[2])
    for label, deflection, sideways in zip(labels, shapes, aside, strict=True):
        name = label.replace(" ", "_") if kind == "vtk" else label
        field = _displacement(deflection, len(strip.points), sideways)
        strip.point_data[name] = field * (_DRAWN_RATIO * (x[-1] - x[0]) / (np.abs(field).max() or 1.0))
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
    """Write the deflected beam over time as one mesh with a displacement field for each instant.

    The coordinates are those of the beam, as for `write_shapes`; deflections are not scaled.
    In ParaView (reader "Xdmf3" or "XDMF") use "Warp By Vector" and play.

    Parameters
    ----------
    path : str or Path
        File to write, .xdmf.
    x : array_like, shape (n,)
        Positions along the beam [m], ascending, at least two.
    t : array_like, shape (k,)
        Times [s], ascending.
    deflection : ndarray, shape (k, n) or (k, n, l)
        Deflections at the times and positions [m]; for a strip with torsion, at l positions across the width,
        as for `write_shapes`.
    width : float or array_like, shape (n,), optional
        Width of the drawn strip [m]; a tenth of the length if not given, 0 for a line.
    force : bool
        Overwrite a file that exists.
    across : ndarray, shape (k, n), optional
        Deflections across the width [m], in the direction -y.

    Raises
    ------
    ValueError
        If the suffix is unknown or the shapes of the arrays do not match.
    FileExistsError
        If the file exists and `force` is not set.
    OSError
        If the file cannot be written.
    """
    from meshio.xdmf import TimeSeriesWriter

    path = check_writable(path, SERIES_SUFFIXES, force)
    x, t, deflection = _check_history(x, t, _over_width(deflection), over_width=True)
    _, _, sideways = _check_history(x, t, np.zeros_like(deflection[..., 0]) if across is None else across)
    strip = _strip(x, width, deflection.shape[2])
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
    """Write an animation of the moving beam, one frame for each instant.

    Parameters
    ----------
    x : array_like, shape (n,)
        Positions along the beam [m], ascending.
    t : array_like, shape (k,)
        Times [s], ascending; several in each period of the vibration of interest.
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
        If the suffix is unknown or the shapes of the arrays do not match.
    FileExistsError
        If the file exists and `force` is not set.
    OSError
        If the file cannot be written.
    """
    x, t, deflection = _check_history(x, t, deflection)
    figure = note_below(new_figure(6.4, 3.6), notes)
    ax, reach = figure.subplots(), 1.1e3 * np.abs(deflection).max() or 1.0  # half the height of the axes [mm]
    ax.set(xlim=(0, 1e3 * x[-1]), ylim=(-reach, reach))
    ax.set(xlabel="position along the beam [mm]", ylabel="deflection [mm]")
    ax.grid(color="0.85", linewidth=0.7)
    ax.axhline(0, color="0.4", linewidth=0.8)
    (line,) = ax.plot(1e3 * x, 0 * x, color="#0072B2", linewidth=2.5)
    title = ax.set_title("t = 0 s")
    figure.draw_without_rendering()
    figure.set_layout_engine("none")  # the layout is computed once, not for each frame

    def frames() -> Iterator[float]:
        for time, row in zip(t.tolist(), deflection, strict=True):
            line.set_ydata(1e3 * row)
            title.set_text(f"t = {time:.4f} s")
            yield time

    save_animation(figure, path, frames(), 100, rate, force)


def _strip(x: np.ndarray, width: float | np.ndarray | Sequence[float] | None, rows: int) -> meshio.Mesh:
    """Make a mesh of quadrilaterals along x with several rows of points; a line if the width is 0."""
    import meshio

    if len(x) < 2:
        raise ValueError(f"x has the length {len(x)}: a mesh needs at least two positions")
    full = np.asarray(_DRAWN_RATIO * (x[-1] - x[0]) if width is None else width, dtype=float)
    if full.shape not in ((), x.shape) or not (np.isfinite(full) & (full >= 0)).all():
        remedy = f"give a width of 0 or more [m], or one for each of {len(x)} positions"
        raise ValueError(f"width = {width}: {remedy}")
    half, i = np.broadcast_to(full / 2, x.shape), np.arange(len(x) - 1)
    edge, rows = np.stack([x, half, np.zeros_like(x)], axis=1), max(rows, 2)
    if not half.any():
        if rows > 2:
            raise ValueError("width = 0: a line has no deflections across; give the width of the strip")
        return meshio.Mesh(edge, [("line", np.stack([i, i + 1], axis=1))])
    points = np.concatenate([edge * (1, y, 1) for y in np.linspace(-1, 1, rows)])
    i = (i + len(x) * np.arange(rows - 1)[:, None]).ravel()
    j = i + len(x)
    return meshio.Mesh(points, [("quad", np.stack([i, i + 1, j + 1, j], axis=1))])


def _over_width(values: np.ndarray) -> np.ndarray:
    """Return deflections with a last axis for positions across the width, of length 1 if they had none."""
    values = np.asarray(values)
    return values[..., None] if values.ndim == 2 else values


def _check_history(
    x: np.ndarray | Sequence[float],
    t: np.ndarray | Sequence[float],
    deflection: np.ndarray,
    over_width: bool = False,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    x, t, deflection = ascending("x", x), ascending("t", t), np.asarray(deflection, dtype=float)
    if deflection.ndim != 2 + over_width or deflection.shape[:2] != (len(t), len(x)):
        expected = f"expected {len(t)} x {len(x)}, times by positions"
        raise ValueError(f"deflection has shape {deflection.shape}: {expected}")
    if not np.isfinite(deflection).all():
        raise ValueError("deflection: every value must be finite")
    return x, t, deflection


def _check_shapes(
    x: np.ndarray, shapes: np.ndarray, labels: Sequence[str], across: np.ndarray | None
) -> tuple[np.ndarray, np.ndarray]:
    """Check and return deflections of m modes at n points of k rows, (m, n, k), and across, (m, n)."""
    shapes = _over_width(shapes)
    aside = np.zeros(shapes.shape[:2]) if across is None else np.asarray(across)
    for name, values, places in ("shapes", shapes, shapes.shape[2:]), ("across", aside, ()):
        if np.iscomplexobj(values) or not np.isfinite(values).all():
            remedy = "give the real part of a complex mode"
            raise ValueError(f"{name}: deflections must be real and finite; {remedy}")
        if values.shape != (len(labels), len(x), *places):
            expected = f"expected {len(labels)} x {len(x)}, labels by positions"
            raise ValueError(f"{name} has shape {values.shape}: {expected}")
    if len(set(labels)) < len(labels):
        raise ValueError(f"labels {list(labels)}: two are equal; give each mode another name")
    return shapes, aside


def _displacement(deflection: np.ndarray, points: int, across: np.ndarray) -> np.ndarray:
    """Return displacement vectors of a strip: along z the deflection (n, k), along -y `across` (n,).

    Rows of points along the beam follow one another from the lowest y; if k is 1, all rows have the same
    deflection.
    """
    z, y = (np.broadcast_to(row, (points // len(across), len(across))) for row in (deflection.T, -across))
    return np.stack([np.zeros(points), y.ravel(), z.ravel()], axis=1)
