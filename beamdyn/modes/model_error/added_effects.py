"""Scenes with one more physical effect, if the beam has the data, and the effect's change of frequencies.

The changes are computed for the eigenvalues of a model's modes, over function spaces in which every effect
can be added.  The equations with the effect, at the eigenvalue s and mode v of those without it, give a step
of inverse iteration, z = D(s)^-1 D'(s) v with D(s) = s^2 M + s (C + omega G) + K, and the new eigenvalue is
the root of y^T D(s) z = 0 nearest to s, with y from the transposed equations.  The error is the square of the
vectors' error; no new eigenproblem is solved, and no modes are matched.  Large effects and close modes need
further steps.

In shapes of arrays, n counts coordinates, N those with the added effect, and m modes.
"""

from __future__ import annotations

import cmath
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
import scipy.linalg
from scipy.linalg.lapack import zgetrf, zgetrs

from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.common.numerics import assign
from beamdyn.equations import effects
from beamdyn.equations.assembly import assemble_over
from beamdyn.equations.discretization import Spaces
from beamdyn.equations.equations_of_motion import Equations, SteadyPencil
from beamdyn.equations.ritz import MOST_FUNCTIONS, Ritz
from beamdyn.modes.modal.eigenproblem import Eigensolver
from beamdyn.modes.modal.model import Model
from beamdyn.modes.modal.solvers import solver_of
from beamdyn.scene.beam import Beam
from beamdyn.scene.rectangle import shear_stiffness_of_rectangle
from beamdyn.scene.scene import Scene

ASSUMED_POISSONS_RATIO = 0.3
# Poisson's ratio assumed for sections without one: for camber the largest of uniform materials, as the change
# rises with the ratio; for torsion a usual one, by which the frequency is known to 13 %.
_ASSUMED_OF_SECTIONS = {
    effects.CAMBER: (0.5, "with Poisson's ratio 0.5, as none is given; 0 % with ratio 0"),
    effects.TORSION: (ASSUMED_POISSONS_RATIO, f"with Poisson's ratio {ASSUMED_POISSONS_RATIO:g} assumed"),
}
MOST_CAMBER = "as if no section cambered, which is the most"
_RECTANGLE = 1e-9  # relative tolerance for a radius of gyration to be that of a rectangle


@dataclass(frozen=True)
class Addition:
    """Scene to which one effect was added.

    Parameters
    ----------
    effect : Effect
        The effect.
    scene : Scene
        The scene that includes the effect, or a scene that bounds the change.
    assumed : str
        Assumption about the beam that was needed to include the effect; empty if none.
    """

    effect: effects.Effect
    scene: Scene
    assumed: str = ""

    @property
    def name(self) -> str:
        """Name of the added effect."""
        return self.effect.name


def _assume_shear(beam: Beam) -> Beam | None:
    """Return the beam with a usual material's shear stiffness; None unless the sections can be rectangles.

    For Poisson's ratios from 0 to 0.5, a rectangle's shear stiffness lies within 28 % of the assumed one.
    """
    if beam.shear_stiffness is not None or beam.axial_stiffness is None or beam.outer_fibre is None:
        return None
    # Rectangles of thickness h, with the outer fibre at h/2, have EI = EA h^2 / 12.
    xi = np.linspace(0, 1, 33)
    gyration = np.sqrt(beam.bending_stiffness(xi) / beam.axial_stiffness(xi))
    if not np.allclose(np.sqrt(3) * gyration, beam.outer_fibre(xi), rtol=_RECTANGLE, atol=0.0):
        return None
    stiffness = shear_stiffness_of_rectangle(beam.axial_stiffness, ASSUMED_POISSONS_RATIO)
    return replace(beam, shear_stiffness=stiffness, second_shear_stiffness=stiffness)


def _assume(scene: Scene, effect: effects.Effect) -> Iterator[tuple[Scene, str]]:
    """Yield the scene and, if an effect lacks data, scenes with assumed data, each with its description."""
    yield scene, ""
    section, electrodes = scene.beam.strip, scene.beam.electrodes
    if effect in _ASSUMED_OF_SECTIONS and section is not None and section.poissons_ratio is None:
        ratio, said = _ASSUMED_OF_SECTIONS[effect]
        if electrodes is None:
            yield replace(scene, beam=scene.beam.with_section(replace(section, poissons_ratio=ratio))), said
        else:
            yield replace(scene, beam=replace(scene.beam, electrodes=electrodes.with_ratio(ratio))), said
    if scene.physics.shear or effect is effects.SHEAR:
        beam = _assume_shear(scene.beam)
        if beam is not None:
            yield replace(scene, beam=beam), f"with Poisson's ratio {ASSUMED_POISSONS_RATIO:g} assumed"


def list_effects(scene: Scene) -> tuple[list[Addition], dict[str, str], tuple[str, ...]]:
    """List the effects that a scene neglects (except large deflection), by whether they can be added.

    Returns
    -------
    additions : list of Addition
        Effects that can be added.
    not_known : dict of str to str
        Effects that cannot be added, and the input that they need.
    not_modelled : tuple of str
        Effects that no model can include.
    """
    every = effects.effects_left_out(scene)
    left_out = [effect for effect in every if effect is not effects.LARGE_DEFLECTION]
    if effects.TWIST in left_out:  # pretwist needs the second plane: the two count as one effect
        left_out.remove(effects.SECOND_PLANE)
    additions, not_known = [], {}
    for effect in (effect for effect in left_out if effect.switch and effect is not effects.TORSION):
        try:
            additions.append(add_effect(scene, effect))
        except InvalidValue as refusal:
            excluded = scene.physics.large_deflection and not effect.bends_in_space
            why = effects.EXCLUSIVE if excluded else str(refusal)
            # A rectangular section, which layers stand on, has its stiffnesses by Poisson's ratio.
            layered = scene.beam.electrodes is not None and effect.needs
            lacking = effect.needs[-1] if layered else refusal.other
            not_known[effect.name] = f"give {lacking}" if refusal.other else why
    not_modelled = [effect.name for effect in left_out if not effect.switch]
    if effects.TORSION in left_out and not can_add(scene, effects.TORSION):
        not_modelled.insert(0, effects.TORSION.name)
    return additions, not_known, tuple(not_modelled)


def add_effect(scene: Scene, effect: effects.Effect) -> Addition:
    """Add an effect that a scene neglects, with an assumption about the beam if data are missing.

    Camber that no model can include (twisted beams, widths that jump) is replaced by a bound.

    Raises
    ------
    InvalidValue
        If the beam lacks data that cannot be assumed, or the effect cannot be combined with others.
    """
    *assumptions, last = _assume(scene, effect)
    for given, assumed in assumptions:
        with suppress(InvalidValue):
            return Addition(effect, effects.add_effects(given, [effect]), assumed)
    try:
        return Addition(effect, effects.add_effects(last[0], [effect]), last[1])
    except InvalidValue:
        if effect is not effects.CAMBER or scene.beam.strip is None or scene.physics.large_deflection:
            raise
    return Addition(effects.CAMBER, without_camber(last[0]), ", ".join(filter(None, [last[1], MOST_CAMBER])))


def without_camber(scene: Scene) -> Scene:
    """Return the scene with rectangular sections that cannot camber: an upper bound of the stiffness."""
    beam = scene.beam
    section, second, electrodes = beam.strip, beam.second_bending_stiffness, beam.electrodes
    assert section is not None and second is not None, "a rectangular section has both stiffnesses"
    flat = beam.bending_stiffness * section.camber_stiffening
    across = second * section.stiffening_across(beam.length)
    held: dict[str, Any] = {"bending_stiffness": flat, "second_bending_stiffness": across}
    if electrodes is not None:
        held["electrodes"] = electrodes.held_flat
    return replace(scene, beam=replace(beam, **held))


def can_add(scene: Scene, effect: effects.Effect) -> bool:
    """Return whether a neglected effect can be added to a scene with the data of its beam."""
    with suppress(InvalidValue):
        return bool(add_effect(scene, effect))
    return False


# Reference modes -------------------------------------------------------------------------------------

_MOST = 160  # largest number of coordinates of a model that suffices to estimate a change
_APART = 1e-8  # relative distance kept from an eigenvalue, where the equations are singular
_AT_CLAMP = 3  # functions along each segment in addition to the modes, to resolve camber near a clamp
# Number of functions across the width.  With these, the error is 1 % of the part of the change by camber that
# is due to the clamp, and 0.1 % for torsion.
_ACROSS = 4
_STEPS = 8  # largest number of inverse iterations: one suffices unless the effect is large or modes are close
# The iteration ends at a step of this size, relative to the change, or relative to the eigenvalue.
_CONVERGED, _ROUNDING = 0.01, 1e-9
KEPT = 0.5  # squared mass product of two unit modes, below which they count as different modes
# Number of additional higher modes, with which the requested modes may exchange their order.
EXTRA_MODES = 2


@dataclass(frozen=True)
class BaseEquations:
    """Equations of a scene without additional effects, in function spaces that allow adding each effect.

    Parameters
    ----------
    scene : Scene
        The scene.
    spaces : Spaces
        Function spaces with a breakpoint wherever the beam has one.
    equations : Equations
        The equations of motion.
    """

    scene: Scene
    spaces: Spaces
    equations: Equations

    @classmethod
    def of(cls, model: Model, modes: int) -> BaseEquations:
        """Build equations over a model's function spaces, or coarser ones that suffice for `modes` modes."""
        discretization, segments = model.discretization, len(model.scene.beam.breakpoints) - 1
        while model.equations.modes > _MOST and discretization.coarser() != discretization:
            if not discretization.coarser().fits(max(2, -(-modes // segments))):
                break
            discretization = discretization.coarser()
            model = Model(model.scene, discretization)
        # If the width is modelled, the modelled beam already has the breakpoints that other effects need.
        has_width = model.scene.models_width
        spaces = discretization.spaces(model.scene.modelled_beam if has_width else model.scene.beam)
        if spaces.shares_functions(discretization.spaces(model.scene.modelled_beam)):
            return cls(model.scene, spaces, model.equations)
        return cls(model.scene, spaces, assemble_over(model.scene, spaces))

    def suited_to(self, extended: Scene, modes: int) -> BaseEquations:
        """Return equations over function spaces that resolve the extended scene's effect on `modes` modes.

        The clamp hinders camber near the root, so that the scene with camber has breakpoints there.
        """
        if not extended.physics.camber or self.scene.physics.camber:
            return self
        spaces = clamp_spaces(extended, modes)
        return BaseEquations(self.scene, spaces, assemble_over(self.scene, spaces))

    def extend(self, scene: Scene) -> Equations:
        """Assemble the equations of the scene with an effect, over the same function spaces."""
        return assemble_over(scene, self.spaces)

    def embed(self, equations: Equations, vectors: np.ndarray) -> np.ndarray:
        """Embed vectors (columns) in the coordinates of extended equations; additional fields are 0."""
        embedded = np.zeros((equations.size, *vectors.shape[1:]), dtype=vectors.dtype)
        for name, place in self.equations.blocks.items():
            embedded[equations.blocks[name]] = vectors[place]
        return embedded

    @cached_property
    def _solver(self) -> Eigensolver:
        return solver_of(self.equations)

    def modes(self, speed: float, eigenvalue: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Compute eigenvalues and modes (columns) of these equations, nearest to given eigenvalues."""
        count = min(len(eigenvalue) + EXTRA_MODES, self._solver.size)
        found = self._solver.solve(np.array([speed]), count)
        order = assign(np.abs(eigenvalue[:, None] - found.eigenvalue[0][None, :]))
        return found.eigenvalue[0][order], found.vector[0][:, order]


def clamp_spaces(scene: Scene, modes: int) -> Spaces:
    """Build function spaces that resolve `modes` modes of a scene with camber or torsion to 0.1 %."""
    functions = min(MOST_FUNCTIONS, _AT_CLAMP + max(modes, 2))
    return replace(Ritz(functions).spaces(scene.modelled_beam), across=_ACROSS)


def match_modes(equations: Equations, speed: float, vectors: np.ndarray, count: int) -> np.ndarray:
    """Find the modes of equations that consist mostly of given modes, by solving an eigenproblem.

    Parameters
    ----------
    equations : Equations
        Equations of motion.
    speed : float
        Speed [rad/s].
    vectors : ndarray, shape (coordinates, m)
        Modes of other equations in these coordinates.
    count : int
        Number of modes that are computed.

    Returns
    -------
    ndarray of complex, shape (m,)
        Eigenvalues [1/s]; nan if no mode contains more than half of the given one.
    """
    M, solver = equations.steady().M, solver_of(equations)
    found = solver.solve(np.array([speed]), min(count, solver.size))
    s, within = found.eigenvalue[0], found.vector[0]
    product = np.abs(vectors.conj().T @ M @ within) ** 2
    squares = (np.einsum("nm,nm->m", v.conj(), M @ v).real for v in (vectors, within))
    kept = product / np.outer(*squares)
    return np.where(kept.max(axis=1) > KEPT, s[kept.argmax(axis=1)], np.nan)


def shift_eigenvalues(pencil: SteadyPencil, speed: float, s: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Estimate the eigenvalues of equations with an effect, near those of equations without it.

    Parameters
    ----------
    pencil : SteadyPencil
        The equations with the effect.
    speed : float
        Speed [rad/s].
    s : ndarray of complex, shape (m,)
        Eigenvalues without the effect [1/s], not 0.
    v : ndarray, shape (coordinates, m)
        Modes of these eigenvalues, 0 in the coordinates that the effect adds.

    Returns
    -------
    ndarray of complex, shape (m,)
        The eigenvalues [1/s]; nan if there is none.
    """
    M, C, K = pencil.M, pencil.C + speed * pencil.G, pencil.K0 + speed**2 * pencil.K2
    scale = _scale(M, K)  # functions of high order have large entries, which are scaled to 1
    M, C, K = (scale[:, None] * A * scale for A in (M, C, K))
    modes = (v / scale[:, None]).T
    with np.errstate(divide="ignore", invalid="ignore"):  # singular equations give nan
        each = [_shift(M, C, K, at, x) for at, x in zip(s.tolist(), modes, strict=True)]
    return np.array(each, dtype=complex)


def _shift(M: np.ndarray, C: np.ndarray, K: np.ndarray, s: complex, x: np.ndarray) -> complex:
    """Find the eigenvalue nearest to s, starting from the mode x without the effect."""
    y, z, at = x.conj(), x, s
    for _ in range(_STEPS):
        # One step of inverse iteration for left and right vectors, near the current eigenvalue; the result is
        # not finite if the dynamic stiffness there is singular.
        near = at * (1 + _APART)
        derivative = 2 * near * M + C
        factors, pivots, _ = zgetrf(near * near * M + near * C + K, overwrite_a=True)
        z, _ = zgetrs(factors, pivots, derivative @ z)
        y, _ = zgetrs(factors, pivots, derivative.T @ y, trans=1)
        y, z = y / np.linalg.norm(y), z / np.linalg.norm(z)
        before, at = at, _root_near(s, *(complex(y @ A @ z) for A in (M, C, K)))
        if abs(at - before) <= _CONVERGED * abs(at - s) + _ROUNDING * abs(s):
            break
        if not cmath.isfinite(at):
            return complex(np.nan)
    kept = abs(x.conj() @ M @ z) ** 2 / abs((x.conj() @ M @ x) * (z.conj() @ M @ z))
    return at if kept > KEPT else complex(np.nan)


def _scale(M: np.ndarray, K: np.ndarray) -> np.ndarray:
    """Compute factors that scale the diagonal of the stiffness (of the mass if that is not positive) to 1."""
    size = np.where(np.diag(K) > 0, np.abs(np.diag(K)), np.abs(np.diag(M)))
    return 1 / np.sqrt(np.where(size > 0, size, 1.0))


def _root_near(s: complex, a: complex, b: complex, c: complex) -> complex:
    """Find the root of a r^2 + b r + c nearest to s; nan if there is none."""
    if not (cmath.isfinite(a) and cmath.isfinite(b) and cmath.isfinite(c)) or a == 0:
        return complex(np.nan)
    root = cmath.sqrt(b * b - 4 * a * c)
    return min((-b + root) / (2 * a), (-b - root) / (2 * a), key=lambda r: abs(r - s))


def shift_critical_speed(pencil: SteadyPencil, critical: float, v: np.ndarray) -> float:
    """Estimate the critical speed of equations with an effect, near that of equations without it.

    Parameters
    ----------
    pencil : SteadyPencil
        The equations with the effect.
    critical : float
        Critical speed without the effect [rad/s].
    v : ndarray, shape (n,)
        Buckling mode without the effect, 0 in the coordinates that the effect adds.

    Returns
    -------
    float
        The critical speed [rad/s]; nan if the equations give none.
    """
    scale = _scale(pencil.M, pencil.K0)
    K0, K2 = (scale[:, None] * A * scale for A in (pencil.K0, pencil.K2))
    try:
        z = scipy.linalg.solve(K0 + (critical * (1 + _APART)) ** 2 * K2, K2 @ (v / scale), assume_a="sym")
    except (ValueError, np.linalg.LinAlgError):
        return np.nan
    z = z / np.linalg.norm(z)
    stiffness, softening = float(z @ K0 @ z), -float(z @ K2 @ z)
    return float(np.sqrt(stiffness / softening)) if stiffness > 0 and softening > 0 else np.nan


def buckling_mode(pencil: SteadyPencil, critical: float) -> np.ndarray:
    """Find the mode for which the stiffness vanishes at the critical speed [rad/s]."""
    scale = _scale(pencil.M, pencil.K0)
    K = scale[:, None] * (pencil.K0 + critical**2 * pencil.K2) * scale
    values, vectors = np.linalg.eigh(K)
    return scale * vectors[:, np.abs(values).argmin()]
