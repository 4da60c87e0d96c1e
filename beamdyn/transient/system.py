"""Equations of motion of a scene in modal coordinates, evaluated at given times for the integrators.

In shapes of arrays, n counts coordinates, T times, k positions along the beam, and l across it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from functools import cached_property

import numpy as np

from beamdyn.equations.equations_of_motion import Equations
from beamdyn.equations.root_motion import CONSTANT_AT_STEADY_SPEED, Quantity, RootMotion, root_motion
from beamdyn.modes.modal.model import SPEED_SAMPLES
from beamdyn.scene.motion.base import Motion, MotionSample
from beamdyn.transient.gauss import components
from beamdyn.transient.weakly_modulated import ModulatedSystem

_MEAN_SAMPLES = 257  # number of samples of the root's motion for the mean stiffness
# Reciprocal of the golden ratio: spacing the sample times by it avoids coincidence with a period.
_GOLDEN = 0.6180339887498949


@dataclass(frozen=True)
class ModalSystem:
    """Equations q'' + C q' + K(t) q = f(t) of a scene in modal coordinates, at arrays of times.

    Parameters
    ----------
    equations : Equations
        Equations of motion with a unit mass matrix.
    motion : Motion
        Motion of the root.
    """

    equations: Equations
    motion: Motion

    @property
    def size(self) -> int:
        """Number n of coordinates."""
        return self.equations.size

    @cached_property
    def tips(self) -> np.ndarray:
        """Tip deflection per unit of each coordinate [kg^-1/2] in each direction, (1 or 2, coordinates)."""
        return self.equations.tips

    @property
    def tip(self) -> np.ndarray:
        """Tip deflection per unit of each coordinate [kg^-1/2] in the direction of bending."""
        return self.tips[0]

    def deflections(self, q: np.ndarray) -> np.ndarray:
        """Compute the tip's deflection in each direction [m] at coordinates q: (..., 1 or 2)."""
        return components(q, self.tips)

    def shape(self, q: np.ndarray, xi: np.ndarray, direction: int = 0) -> np.ndarray:
        """Compute the deflection [m] at positions xi = x/L, for coordinates q at T times: (T, positions)."""
        return q @ self.equations.deflection(xi, direction=direction)

    def surface(self, q: np.ndarray, xi: np.ndarray, eta: np.ndarray) -> np.ndarray:
        """Compute the deflection [m] of a strip at xi = x/L and eta = 2 y/width: (times, along, across)."""
        return np.tensordot(q, self.equations.surface(xi, eta), 1)

    def energy(self, t: np.ndarray, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Compute the energy of the vibration [J] at times t: q' q' / 2 + q K q / 2 - f q."""
        _, K, f = self.coefficients(t)
        return (v**2).sum(axis=1) / 2 + np.einsum("ti,tij,tj->t", q, K, q) / 2 - (f * q).sum(axis=1)

    @classmethod
    def from_rest(cls, equations: Equations, motion: Motion, t_end: float) -> ModalSystem:
        """Build the equations of a run from rest, without coordinates that no load excites.

        Planes of bending without loads and coupling are omitted.  Whether a load is 0 is decided from samples
        over the run, and in each interval in which the motion is smooth.
        """
        if len(equations.connected) > 1:
            spread = t_end * (_GOLDEN * np.arange(SPEED_SAMPLES) % 1)
            ends = np.clip([0.0, *motion.breakpoints, t_end], 0.0, t_end)
            t = np.concatenate([spread, (ends[1:] + ends[:-1]) / 2])
            loaded = (equations.load(equations.root(motion.at(t))) != 0).any(axis=0)
            parts = [names for names in equations.connected if not loaded[equations.places(names)].any()]
            still = {name for names in parts for name in names}
            if still and len(still) < len(equations.blocks):
                sizes = {name: block.stop - block.start for name, block in equations.blocks.items()}
                kept = {(n,): np.eye(size)[:, : 0 if n in still else size] for n, size in sizes.items()}
                equations = equations.reduced(kept)
        return cls(equations, motion)

    def root(self, t: np.ndarray) -> RootMotion:
        """Compute the motion of the root at times t [s]."""
        return self.equations.root(self.motion.at(t))

    def coefficients(self, t: np.ndarray) -> tuple[np.ndarray | None, np.ndarray, np.ndarray]:
        """Evaluate damping C (None if zero), stiffness K and load f at times t [s] of any shape."""
        return self.assemble(self.root(np.asarray(t, dtype=float)))

    def assemble(self, root: RootMotion) -> tuple[np.ndarray | None, np.ndarray, np.ndarray]:
        """Assemble damping C (None if zero), stiffness K and load f for a motion of the root."""
        C = self.equations.matrix(1, root) if self.equations.matrices[1] else None
        return C, self.equations.matrix(0, root), self.equations.load(root)

    def modulated(self, start: float, end: float) -> ModulatedSystem | None:
        """Split the equations from start to end [s] into slow coefficients and a small varying stiffness.

        The slow coefficients depend on the speed only.  The result is None if damping or gyroscopic terms
        depend on anything else.
        """
        stiffness, damping, _ = self.equations.matrices
        varying: list[Quantity] = [name for name in stiffness if name not in CONSTANT_AT_STEADY_SPEED]
        if not set(damping) <= set(CONSTANT_AT_STEADY_SPEED):
            return None
        sampled = self.motion.at(np.linspace(start, end, _MEAN_SAMPLES)[1:-1])
        both = self.equations.root(sampled), self._about_fixed_centre(sampled)
        mean = {name: np.subtract(*(getattr(root, name) for root in both)).mean() for name in varying}
        speed = float(self.motion.at(np.array(start)).speed)

        def slow(t: np.ndarray) -> tuple[np.ndarray | None, np.ndarray]:
            about_centre = self._about_fixed_centre(self.motion.at(t))
            moved = {name: getattr(about_centre, name) + mean[name] for name in varying}
            C, K, _ = self.assemble(replace(about_centre, **moved))
            return C, K

        def excess(sample: MotionSample, now: RootMotion) -> list[np.ndarray]:
            about_centre = self._about_fixed_centre(sample)
            return [getattr(now, name) - getattr(about_centre, name) - mean[name] for name in varying]

        lines = abs(speed) * np.array([1.0, *(line.multiple for line in self.motion.lines)])
        return self._split(slow, self.motion.steady_start <= start, varying, excess, lines)

    def about_mean(self, start: float, end: float) -> ModulatedSystem | None:
        """Split the equations from start to end [s] into mean coefficients and a small varying stiffness.

        The mean coefficients are those for the mean of the root's motion.  The result is None if damping or
        gyroscopic terms vary.
        """
        stiffness, damping, _ = self.equations.matrices
        if not set(damping) <= {"unity"}:
            return None
        sampled = self.root(np.linspace(start, end, _MEAN_SAMPLES)[1:-1])
        mean = RootMotion(*(getattr(sampled, f.name).mean() for f in fields(RootMotion)))
        C, K, _ = self.assemble(mean)
        varying: list[Quantity] = [name for name in stiffness if np.ptp(getattr(sampled, name))]

        def slow(t: np.ndarray) -> tuple[np.ndarray | None, np.ndarray]:
            damped = None if C is None else np.broadcast_to(C, (*t.shape, *C.shape))
            return damped, np.broadcast_to(K, (*t.shape, *K.shape))

        def excess(_: MotionSample, now: RootMotion) -> list[np.ndarray]:
            return [getattr(now, name) - getattr(mean, name) for name in varying]

        return self._split(slow, True, varying, excess, np.empty(0))

    def _split(
        self,
        slow: Callable[[np.ndarray], tuple[np.ndarray | None, np.ndarray]],
        steady: bool,
        varying: list[Quantity],
        excess: Callable[[MotionSample, RootMotion], list[np.ndarray]],
        lines: np.ndarray,
    ) -> ModulatedSystem:
        """Build equations with slowly varying damping and stiffness, and a stiffness that varies about them.

        `slow` evaluates the slowly varying matrices, which are constant if `steady`; `excess` evaluates the
        quantities `varying` minus their slow values; `lines` are their known angular frequencies [rad/s].
        """
        stiffness, loads = self.equations.matrices[0], self.equations.vectors

        def scalars(t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            sample = self.motion.at(t)
            now = self.equations.root(sample)
            values = excess(sample, now), [getattr(now, name) for name in loads]
            e, g = (np.stack(each, axis=-1) if each else np.empty((*t.shape, 0)) for each in values)
            return e, g

        G = np.array([stiffness[name] for name in varying]).reshape(-1, self.size, self.size)
        P = np.array([*loads.values()]).reshape(-1, self.size)
        return ModulatedSystem(slow=slow, steady=steady, G=G, P=P, scalars=scalars, lines=lines)

    def _about_fixed_centre(self, sample: MotionSample) -> RootMotion:
        """Compute the root motion about a fixed centre without gravity, which depends only on the speed."""
        still = MotionSample(np.zeros(()), sample.speed, sample.acceleration, np.zeros(3))
        return root_motion(self.equations.mount, still)

    def rhs(self, t: float, y: np.ndarray) -> np.ndarray:
        """Compute y' for y = (q, q'), with the arguments of a right-hand side for `solve_ivp`."""
        C, K, f = self.coefficients(np.asarray(t))
        q, v = y[: self.size], y[self.size :]
        return np.concatenate([v, f - K @ q - (0 if C is None else C @ v)])

    def jacobian(self, t: float, y: np.ndarray) -> np.ndarray:
        """Compute the derivatives of y' with respect to y = (coordinates, velocities): a matrix."""
        C, K, _ = self.coefficients(np.asarray(t))
        n = self.size
        J = np.zeros((2 * n, 2 * n))
        J[:n, n:], J[n:, :n] = np.eye(n), -K
        if C is not None:
            J[n:, n:] = -C
        return J
