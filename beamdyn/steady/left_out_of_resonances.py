"""What the effects left out would change in speeds of resonance, from the natural frequencies there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Protocol

import numpy as np

from beamdyn.modes.modal.discretization_choice import choose_model
from beamdyn.modes.modal.model import Model
from beamdyn.modes.model_error.left_out_changes import left_out_of_modes, nothing_known
from beamdyn.modes.model_error.left_out_effects import LeftOutEffects
from beamdyn.scene.motion import Line
from beamdyn.scene.scene import Scene

_STEP = 1e-4  # relative step of the speed for the slope of the frequencies
_FURTHER_MODES = 2  # modes with which those that are sought may exchange their order


class CrossingOfLine(Protocol):
    """A crossing of a line with one mode or two."""

    @property
    def line(self) -> Line:
        """Line of the excitation."""
        ...

    @property
    def speed(self) -> float:
        """Speed [rad/s]."""
        ...

    @property
    def frequency(self) -> float:
        """Natural frequency of the first mode [Hz]."""
        ...

    @property
    def second_mode(self) -> int | None:
        """Number of the other mode, if there is one."""
        ...


def left_out_of_resonances(scene: Scene, crossings: Sequence[CrossingOfLine], modes: int) -> LeftOutEffects:
    """Estimate what each effect changes in the speeds (k,) of some crossings, to first order.

    A speed of resonance moves by the relative change of the frequency, over 1 - (speed/frequency) times the
    slope of the frequency over speed.
    """
    if not crossings:
        return nothing_known(scene)
    speeds = np.array([c.speed for c in crossings])
    model = choose_model(scene, "ritz", speeds, modes + _FURTHER_MODES, 1e-6)
    return left_out_of_crossings(model, crossings, modes)


def left_out_of_crossings(model: Model, crossings: Sequence[CrossingOfLine], modes: int) -> LeftOutEffects:
    """As `left_out_of_resonances`, of crossings (at least one) that were found with a model."""
    speeds = np.array([c.speed for c in crossings])
    at = np.concatenate([speeds, speeds * (1 + _STEP), speeds * (1 - _STEP)])
    here, above, below = model.solver.solve(at, modes + _FURTHER_MODES).eigenvalue.reshape(3, len(speeds), -1)
    effects = left_out_of_modes(model, speeds, here)
    nearest = _nearest(here, np.array([_pair(c) for c in crossings]))
    size = np.take_along_axis(np.imag(here), nearest, axis=1)
    rise, fall = (np.take_along_axis(np.imag(s), _nearest(s, size), axis=1) for s in (above, below))
    detuning = size.sum(axis=1) - ((rise - fall) / (2 * _STEP)).sum(axis=1)

    def of_speeds(change: np.ndarray) -> np.ndarray:
        return (size * np.take_along_axis(change, nearest, axis=1)).sum(axis=1) / detuning

    changes = {name: of_speeds(change) for name, change in effects.changes.items()}
    return replace(effects, changes=changes, shape=speeds.shape)


def _nearest(eigenvalue: np.ndarray, frequency: np.ndarray) -> np.ndarray:
    """Indices (k, 2) of the eigenvalues (k, m) nearest to angular frequencies (k, 2)."""
    return np.abs(np.imag(eigenvalue)[:, None, :] - frequency[:, :, None]).argmin(axis=2)


def _pair(crossing: CrossingOfLine) -> tuple[float, float]:
    """Angular frequencies of the two modes of a crossing [rad/s]; of a single mode twice."""
    first = 2 * np.pi * crossing.frequency
    return first, first if crossing.second_mode is None else crossing.line.multiple * crossing.speed - first
