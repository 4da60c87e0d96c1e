"""The result of a sensitivity analysis: the derivative of each answer by each number of the scene."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from beamdyn.common.results.one_line import counted, number, warned
from beamdyn.common.results.result import Provenance, Result
from beamdyn.scene.scene import Scene
from beamdyn.studies.sensitivities.scene_numbers import SceneNumber

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True)
class Sensitivities(Result):
    """Derivatives of k answers by n numbers of a scene.

    Parameters
    ----------
    answers : tuple of str
        What each answer is, such as "mode 1", shape (k,).
    unit : str
        Unit of the answers.
    value : ndarray, shape (k,)
        The answers [unit].
    inputs : tuple of SceneNumber
        The numbers, each with its `name`, `unit` and `value`, shape (n,).
    derivative : ndarray, shape (n, k)
        Derivative of each answer by each number [unit / unit of the number]; nan where there is none, as
        `warnings` say.
    error : ndarray, shape (n, k)
        Estimated absolute error of the derivative [same unit].
    warnings : tuple of str
        Which derivatives are missing, and why; what limits the answers.
    provenance : Provenance
        How they were found.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> found = bd.frequency_sensitivities(bd.Scene(strip), modes=2, inputs=["beam.density"])
    >>> found.relative.round(6)
    array([[-0.5, -0.5]])
    """

    answers: tuple[str, ...]
    unit: str
    value: np.ndarray
    inputs: tuple[SceneNumber, ...]
    derivative: np.ndarray
    error: np.ndarray
    warnings: tuple[str, ...]
    provenance: Provenance
    scene: Scene = field(repr=False)

    def headline(self) -> Iterator[str]:
        """What it says in one line; see `Result.headline`."""
        yield f"{counted(len(self.answers), 'answer')} by {counted(len(self.inputs), 'number')}"
        if self.derivative.size and np.isfinite(self.relative).any():
            size = np.nan_to_num(np.abs(self.relative))
            most = np.unravel_index(int(size.argmax()), size.shape)
            yield f"most by {self.inputs[most[0]].name}: relative change {number(self.relative[most])}"
        yield warned(self.warnings)

    @property
    def relative(self) -> np.ndarray:
        """Relative change of each answer over that of the number, shape (n, k): 3 where it grows as its cube.

        It is 0 where the number is 0.
        """
        return self.derivative * np.array([each.value for each in self.inputs])[:, None] / self.value

    def by(self, name: str) -> np.ndarray:
        """Derivatives by the number of a name, shape (k,).

        Raises
        ------
        ValueError
            If there is none of this name.
        """
        names = [each.name for each in self.inputs]
        if name not in names:
            raise ValueError(f"{name!r} is none of the numbers: give one of {', '.join(names)}")
        return self.derivative[names.index(name)]

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the relative change of each answer over that of each number, the most important on top."""
        from beamdyn.common.plots.curves import plot_bars

        names = [each.name for each in self.inputs]
        return plot_bars(names, self.relative, self.answers, "relative change over that of the number", ax)
