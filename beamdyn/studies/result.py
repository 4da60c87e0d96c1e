"""The result of a study: an answer over combinations of inputs."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from beamdyn.common.results import Provenance, Result
from beamdyn.scene.scene import Scene
from beamdyn.studies.inputs import VariedInput, scene_of, shape_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

WORDS = {"frequencies": "frequency", "critical_speed": "critical speed", "amplitude": "steady amplitude"}


@dataclass(frozen=True)
class Study(Result):
    """An answer over combinations of inputs; made by `study`.

    The shape (n1, ..., nd) has an axis for each input, in order, or one for all that are taken together.

    Parameters
    ----------
    what : str
        What was asked for: "frequencies", "critical_speed" or "amplitude".
    unit : str
        Unit of the answer.
    inputs : tuple of VariedInput
        Each with its `name`, `unit` and `values` in SI.
    combine : {"product", "zip"}
        Whether the inputs are combined each with each, or taken together.
    value : ndarray, shape (n1, ..., nd, m) or (n1, ..., nd)
        Frequencies of m modes [Hz], nan where a mode does not vibrate; critical speeds [rad/s], inf where
        the beam does not buckle; or steady amplitudes [m], nan where there is none.
    error : ndarray, of the same shape
        Estimated relative error; inf where unresolved.
    status : ndarray of str, of the same shape
        Of a mode as for `natural_modes`; "buckles", "does not buckle" or "not found"; of a response as for
        `steady_response`; "refused" where there is no answer.
    warnings : tuple of str
        What limits the answer, and of how many designs.
    provenance : Provenance
        How it was found.
    """

    what: str
    unit: str
    inputs: tuple[VariedInput, ...]
    combine: str
    value: np.ndarray
    error: np.ndarray
    status: np.ndarray
    warnings: tuple[str, ...]
    provenance: Provenance
    scene: Scene = field(repr=False)

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape (n1, ..., nd) of the designs."""
        return shape_of(self.inputs, self.combine)

    def design(self, *place: int) -> dict[str, float]:
        """Inputs of the design at a place (i1, ..., id): values in SI, by name."""
        if len(place) != len(self.shape):
            raise ValueError(f"place {place}: give {len(self.shape)} indices, one for each of {self.shape}")
        places = place * len(self.inputs) if self.combine == "zip" else place
        return {each.name: float(each.values[i]) for each, i in zip(self.inputs, places, strict=True)}

    def scene_at(self, *place: int) -> Scene:
        """The scene of the design at a place (i1, ..., id), for any other analysis of it."""
        return scene_of(self.scene, self.design(*place))

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the answer over the first input; of further inputs, one curve for each value of the second."""
        from beamdyn.output.plots_over_inputs import plot_over_input

        first, rest = self.inputs[0], self._rest()
        where = f"{self._words()} [{self.unit}]" + (f" at {', '.join(rest)}" if rest else "")
        return plot_over_input(first.values, self._curves(), self._labels(), first.label, where, ax)

    def _words(self) -> str:
        """The answer that a picture shows."""
        one_mode = self.what == "frequencies" and len(self.shape) > 1
        return "first frequency" if one_mode else WORDS[self.what]

    def _curves(self) -> np.ndarray:
        """Answers over the first input, one row a curve."""
        if len(self.shape) == 1:
            return np.atleast_2d(self.value.T)
        first = self.value[..., 0] if self.what == "frequencies" else self.value
        return first.reshape(*self.shape[:2], -1)[:, :, 0].T

    def _labels(self) -> list[str]:
        if len(self.shape) > 1:
            second = self.inputs[1]
            return [_at(second, value) for value in second.values.tolist()]
        return [f"mode {i + 1}" for i in range(len(self._curves()))] if self.what == "frequencies" else [""]

    def _rest(self) -> list[str]:
        """The inputs that a picture shows at their first value only."""
        rest = self.inputs[2:] if self.combine == "product" else ()
        return [_at(each, float(each.values[0])) for each in rest]


def _at(given: VariedInput, value: float) -> str:
    return f"{given.name} = {value:.4g} {given.unit}".rstrip()
