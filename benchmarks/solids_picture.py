"""Plot of true errors of plain beams, relative to solid bodies, and of the stated model errors.

Run: python -m benchmarks.solids_picture FILE.  It plots the references of `benchmarks.solids` over the
strips' ratio of length to width: for each strip the worst of three bending modes, coloured by the ratio of
width to thickness.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from benchmarks.solids import Reference, StatedError, chosen_errors, known, stated_errors

_TOLERANCE = 1e-2
_FLOOR = 1e-5  # smallest difference in the plot; smaller differences are plotted at this value


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("file", type=Path, help="picture: .png or .svg")
    drawn(known()).savefig(parser.parse_args().file, dpi=110)


def drawn(references: Sequence[Reference]) -> Figure:
    """Plot true errors, ratios of stated to true errors, and errors with chosen physics, in three panels."""
    strips = [reference.body() for reference in references]
    slender = np.array([strip.length / strip.width for strip in strips])
    flat = np.array([strip.width / strip.thickness for strip in strips])
    stated = [_worst(stated_errors(reference)) for reference in references]
    chosen = np.array([chosen_errors(reference, _TOLERANCE)[0] for reference in references])
    true = np.array([each.true for each in stated])
    ratio = np.array([each.stated / each.true if each.counts else np.nan for each in stated])

    figure = Figure(figsize=(12.5, 4.0), layout="constrained")
    axes: Sequence[Axes] = figure.subplots(1, 3)
    titles = (
        "the plain beam beside the solid",
        "stated model error over the true one",
        f'physics="auto", tolerance {_TOLERANCE:g}',
    )
    for ax, values, title in zip(axes, (true, ratio, np.maximum(chosen, _FLOOR)), titles, strict=True):
        points = ax.scatter(slender, values, c=np.log10(flat), s=18, cmap="viridis", vmin=0, vmax=2)
        ax.set(xscale="log", yscale="log", title=title, xlabel="length / width")
        ax.set_xticks([2.5, 5, 10, 20, 50], ["2.5", "5", "10", "20", "50"], minor=False)
        ax.minorticks_off()
        ax.grid(alpha=0.3)
    axes[0].set_ylabel("relative difference of a frequency")
    axes[1].set_ylim(0.2, 5)
    axes[1].set_yticks([0.2, 0.5, 1, 2, 5], ["0.2", "0.5", "1", "2", "5"])
    for limit in (0.5, 2.0):
        axes[1].axhline(limit, color="0.3", linestyle="--", linewidth=1)
    axes[2].axhline(_TOLERANCE, color="0.3", linestyle="--", linewidth=1)
    axes[2].set_ylim(_FLOOR / 2, 3 * _TOLERANCE)
    bar = figure.colorbar(points, ax=list(axes), label="width / thickness")
    bar.set_ticks([0, 1, 2], labels=["1", "10", "100"])
    return figure


def _worst(each: Sequence[StatedError]) -> StatedError:
    """Return the bending mode with the largest true difference from the solid."""
    return max(each, key=lambda stated: stated.true)


if __name__ == "__main__":
    main()
