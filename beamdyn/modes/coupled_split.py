"""The theorem of `beamdyn.modes.split` for two planes that the twist or the mount couples.

With the curvature vector k = (v'', w'') and the stiffness tensor D(x) of the sections, turned by the twist,

    a(u, u) = int k . D k,    P_mass = int rho A |u|^2 + m |t|^2,    P_tension = int N |u'|^2,

in the plane of rotation P_soft = int rho A (d . u)^2 + m (d . t)^2 with its direction d, and of the slope
vector s = u'(1) at the tip the forms s . T s with the tensors T of its inertia and of its spin.  Without
precone nothing is gyroscopic: z are the eigenvalues of a form, as in one plane.

**The traces** on all functions need no twist.  The slope in a direction e is int_0^x e . k, of squared norm
int_0^x e . D^-1 e; the sum over both directions has the trace of D^-1, 1/EI_1 + 1/EI_2 however the section is
turned.  So the traces of tension, mass and slope at the tip are the sums of those of the two planes, and
P_soft <= P_mass and s . T s >= (least eigenvalue of T) |s|^2 are used on the tail alone.

**Twisting by inertia.**  A tip body with a product of inertia on the axes of rotation adds
H int (v' w'' - v'' w'), a form of either sign.  It is int int k(x) . K(x, s) k(s) with the kernel
K = (H/2) sign(s - x) (0, 1; -1, 0).  The squares of its eigenvalues relative to a have the sum
H^2 det(int D^-1) / 2, and on the tail at most that less the head's.

**The coupling.**  Loads cause a moment vector F by the static balance of the cantilever, in fixed axes; with
any curvatures p of the head the tail sees F - D p, and R = int (F - D p) . D^-1 (F - D p), where the axes of
the section have one EI each.  The rest is as in one plane.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from beamdyn.equations.fields.transverse import plane_components
from beamdyn.equations.root_motion import root_motion
from beamdyn.modes.coupled_head import CoupledHead
from beamdyn.modes.flexibility import bound_traces
from beamdyn.modes.split import Enclosure
from beamdyn.scene.beam import TipMass
from beamdyn.scene.motion import MotionSample
from beamdyn.scene.profile import Profile
from beamdyn.scene.scene import Scene
from beamdyn.scene.sections import centrifugal_inertia, tilting_inertia

_EPS = float(np.finfo(float).eps)

# The forms in their order: tension N_B per squared speed, N_A per acceleration of the root, mass, mass in the
# plane of rotation, spin and inertia of the slope at the tip, twisting by inertia.
_OF_MASS = np.array([0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0])


class CoupledSplit(Enclosure):
    """Split of the trial functions in two planes into head and tail, at one speed.

    Parameters
    ----------
    scene : Scene
        A nondimensional scene in two planes without precone.
    moments : int
        Number of bending moments of the head in each direction.
    speed : float
        Nondimensional speed.
    flexibility : tuple of Profile
        Upper bounds of 1/EI in the first direction of the sections and in the second.
    """

    def __init__(
        self, scene: Scene, moments: int, speed: float, flexibility: tuple[Profile, Profile]
    ) -> None:
        self.scene, self.speed, self.flexibility = scene, speed, flexibility
        self._head = CoupledHead(scene.beam, moments, flexibility)
        self.stiffness, self.mass = self._head.stiffness, _OF_MASS
        root = float(root_motion(scene.mount, MotionSample.steady(1.0)).root_axial)
        self.spin = np.array([1.0, -root, 0.0, -1.0, 1.0, 0.0, self._product_of_inertia])
        self.spin_terms = np.append(np.abs(self.spin[:6]), self._tensor_terms[0] if self.spin[6] else 0.0)
        self.forms = self._all_forms()
        # As in one plane, with two products at a point; the head is of a stiffness as near as the misfit.
        products = 2 * self._head.quadrature.xi.size
        self.unit = 4 * _EPS * (products + len(self.stiffness)) + self._head.misfit

    @property
    def _product_of_inertia(self) -> float:
        """The tip body's product of inertia, on which rotation works where it is turned."""
        beam, (d, n) = self.scene.beam, np.array(plane_components(self.scene))
        return -float(d @ centrifugal_inertia(beam.tip or TipMass(0.0), beam.tip_twist) @ n)

    @cached_property
    def _tensors(self) -> tuple[np.ndarray, np.ndarray]:
        """Tensors T of the slope at the tip (2, 2), per squared speed and per -z."""
        beam, (_, n) = self.scene.beam, np.array(plane_components(self.scene))
        tip, root = beam.tip or TipMass(0.0), -self.spin[1]
        body = centrifugal_inertia(tip, beam.tip_twist) @ n
        pull = tip.mass * tip.offset * (1 + tip.offset - root)
        spin = pull * np.eye(2) + (np.outer(n, body) + np.outer(body, n)) / 2
        return spin, tilting_inertia(tip, beam.tip_twist)

    @cached_property
    def _tensor_terms(self) -> np.ndarray:
        """Sums of the absolute values of the terms of the tensors, shape (2,)."""
        tip = self.scene.beam.tip or TipMass(0.0)
        body = tip.inertia + tip.inertia_about_bending_direction
        pull = tip.mass * abs(tip.offset) * (1 + abs(tip.offset) + abs(self.spin[1]))
        return np.array([pull + body + 2 * tip.axial_inertia, body])

    def _all_forms(self) -> np.ndarray:
        """The forms on the head, shape (7, n, n)."""
        direction, _ = np.array(plane_components(self.scene))
        slope = self._head.tip_slope
        tilts = [slope @ T @ slope.T for T in self._tensors]
        return np.concatenate([self._head.forms(direction), tilts, self._head.twisting[None]])

    # The tail -------------------------------------------------------------------------------------

    @cached_property
    def _traces(self) -> np.ndarray:
        """Upper bounds of the traces of tensions, mass and slope at the tip on all functions: shape (4,)."""
        first, second = (bound_traces(self.scene.beam, flexibility) for flexibility in self.flexibility)
        return first + second

    @cached_property
    def tails(self) -> np.ndarray:
        """Upper bounds of the forms of tensions, mass and slope at the tip on the tail, relative to a."""
        slope = self._head.tip_slope
        forms = [*self.forms[:3], slope @ slope.T]
        head = [np.trace(np.linalg.solve(self.stiffness, form)) for form in forms]
        return np.maximum(self._traces - head, 0) + self.unit * self._traces

    @cached_property
    def _twisting_tail(self) -> float:
        """Upper bound of twisting by inertia on the tail, relative to a, by the norm of its kernel."""
        slope = self._head.tip_slope
        flexibility = slope.T @ np.linalg.solve(self.stiffness, slope) + self.tails[3] * np.eye(2)
        total = np.linalg.det(flexibility) / 2
        head = np.linalg.solve(self.stiffness, self._head.twisting)
        rounding = self.unit * (self._traces[3] ** 2 + self._head.twisting_size**2)
        return float(np.sqrt(max(total - np.trace(head @ head), 0.0) + rounding))

    def _tail(self, coefficients: np.ndarray, terms: np.ndarray) -> float:
        least = np.linalg.eigvalsh(np.tensordot(coefficients[4:6], self._tensors, 1))[0]
        softening = -min(coefficients[2], coefficients[2] + coefficients[3])
        signed = np.array([*-coefficients[:2], softening, -least])
        rounding = np.array([*terms[:2], terms[2] + terms[3], terms[4:6] @ self._tensor_terms])
        twisting = terms[6] * self._twisting_tail if terms[6] else 0.0
        return float(self.unit + twisting + np.maximum(signed + self.unit * rounding, 0) @ self.tails)

    # The coupling ---------------------------------------------------------------------------------

    @cached_property
    def _unbalanced(self) -> tuple[np.ndarray, np.ndarray]:
        """Moments that the head does not balance, per squared speed and per -z: each (n, 2, N)."""
        direction, _ = np.array(plane_components(self.scene))
        spin, inertia = self._tensors
        of_spin = self._head.moments_of(self.spin[:2], -np.outer(direction, direction), spin, self.spin[6])
        of_mass = self._head.moments_of(np.zeros(2), np.eye(2), inertia)
        return (
            self._head.unbalanced(of_spin, self._sum(self.spin)),
            self._head.unbalanced(of_mass, self._sum(self.mass)),
        )

    @cached_property
    def _residuals(self) -> np.ndarray:
        """Products of these moments, shape (2, n, 2, n)."""
        n = len(self.stiffness)
        return self._head.residuals(np.concatenate(self._unbalanced)).reshape(2, n, 2, n)

    def _residual(self, coefficients: np.ndarray) -> np.ndarray:
        c = self._of_loads(coefficients)
        return np.einsum("j,jakb,k", c, self._residuals, c)

    def _of_loads(self, coefficients: np.ndarray) -> np.ndarray:
        """Squared speed and -z, by the coefficients of the softening and of the mass."""
        return np.array([-coefficients[3], coefficients[2]])

    def _residual_allowance(self, terms: np.ndarray) -> float:
        products = np.abs(self._of_loads(terms)) @ np.sqrt(np.einsum("jaja->j", self._residuals))
        moments = self.unit * (terms @ self._of_all(self._traces, 1.5 * self._traces[3]))
        variation = float(np.diag(self._head.ratios).max())
        return self.unit * products**2 + variation * len(self.stiffness) * moments**2

    def _of_all(self, traces: np.ndarray, twisting: float) -> np.ndarray:
        """Sizes of the absolute terms of all forms (7,), by those of four (4,) and that of twisting."""
        return np.array([*traces[:3], traces[2], *(self._tensor_terms * traces[3]), twisting])

    def _sizes(self) -> np.ndarray:
        slope = self._head.tip_slope
        traces = [*np.trace(self.forms[:3], axis1=1, axis2=2), float((slope**2).sum())]
        return self._of_all(np.array(traces), self._head.twisting_size)
