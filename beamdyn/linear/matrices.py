"""Matrices of the equations of motion at a steady speed, with the meaning of each row and coordinate."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from time import perf_counter
from typing import Any

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, real_array, refuse, several
from beamdyn.common.results.one_line import counted, error_at_most, warned
from beamdyn.common.results.result import Provenance
from beamdyn.common.results.statements import GROWING, Speeds, Statement, announced_of_plain_beam
from beamdyn.equations.circuit import BLOCK
from beamdyn.equations.effects import check_direction
from beamdyn.equations.equations_of_motion import Equations
from beamdyn.linear.convergence import check_linear, model_at_speed, with_forces
from beamdyn.linear.free_motion import free_motion
from beamdyn.linear.inputs_outputs import BaseMotion, Excitation, PointForce, as_excitation
from beamdyn.linear.model_at_speed import HarmonicDrive, ModelAtSpeed, pole_errors
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice
from beamdyn.modes.modal.model import warn_of_rotation
from beamdyn.modes.model_error.left_out_effects import LeftOutEffects, StatesModelError
from beamdyn.modes.repeated import left_out_of_frequencies
from beamdyn.scene.points import ACROSS
from beamdyn.scene.scene import Scene, SceneResult
from beamdyn.scene.validity import warn_of_left_out

# Largest rounding error of a trial function at nodes, where it is 1 at one node and 0 at all others.
_NODAL = 1e-9
# Number of lowest modes whose model error is stated: the lowest loses stability first, and effects left out
# change it most.
MOST_JUDGED = 5


@dataclass(frozen=True)
class Matrices(SceneResult, StatesModelError):
    """Equations of motion at a steady speed about the straight beam, M q'' + (C + G) q' + K q = f + B u.

    The axes rotate with the carrier, its centre is fixed, and there is no gravity.  `error` is numerical.
    `left_out` contains the estimated relative change of the m lowest natural frequencies by each neglected
    physical effect, `model_error` (m,) the magnitude of the sum of these changes; both are computed at first
    use.

    Parameters
    ----------
    speed : float
        Speed [rad/s].
    mass : ndarray, shape (n, n)
        Mass matrix M, symmetric [unit of the row / (unit of the coordinate / s2)].
    damping : ndarray, shape (n, n)
        Damping matrix C, symmetric [unit of the row / (unit of the coordinate / s)].
    gyroscopic : ndarray, shape (n, n)
        Gyroscopic matrix G at this speed, skew-symmetric [unit of C].
    stiffness : ndarray, shape (n, n)
        Stiffness matrix K at this speed: elastic, with centrifugal stiffening and spin softening
        [unit of the row / unit of the coordinate].
    stiffness_by_axial_acceleration : ndarray, shape (n, n)
        Loss of K for each m/s2 by which the root accelerates along the beam, beyond the steady rotation:
        the parametric term of translation and gravity [unit of K / (m/s2)].
    static_load : ndarray, shape (n,)
        Load f due to the steady rotation [units of the rows].
    input_matrix : ndarray, shape (n, inputs)
        Input matrix B: load due to a unit of each input [unit of the row / unit of the input].
    inputs : tuple of str
        The inputs u, with units.
    coordinates, rows : tuple of str
        Meaning of each coordinate q and each equation, with units.
    error : ndarray, shape (2 n,)
        Estimated relative error of each of the `poles`, in their order, due to the modes left out and the
        discretization; nan for an infinite pole, inf for one that is not resolved to 1 %.
    warnings : tuple of str
        Warnings about the validity and accuracy of the matrices.
    provenance : Provenance
        How the matrices were computed.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> found = bd.matrices(bd.Scene(strip, bd.Mount(radius=0.215)), speed=50.0, modes=3)
    >>> found.mass.shape, len(found.coordinates)
    ((3, 3), 3)
    """

    speed: float
    mass: np.ndarray
    damping: np.ndarray
    gyroscopic: np.ndarray
    stiffness: np.ndarray
    stiffness_by_axial_acceleration: np.ndarray
    static_load: np.ndarray
    input_matrix: np.ndarray
    inputs: tuple[str, ...]
    coordinates: tuple[str, ...]
    rows: tuple[str, ...]
    error: np.ndarray
    equations: Equations = field(repr=False)

    def headline(self) -> Iterator[str]:
        """Yield size, speed, inputs and error of the lowest pole for a one-line summary.

        See `Result.headline`.
        """
        yield f"{len(self.mass)} x {len(self.mass)} at {self.say_speed(self.speed)}"
        yield counted(len(self.inputs), "input")
        yield f"lowest pole: {error_at_most(self.error[:1])}"
        yield warned(self.warnings)

    @property
    def poles(self) -> np.ndarray:
        """Poles of the equations: the eigenvalues of the state matrix at this speed.

        An imaginary part is a natural frequency [rad/s], a real part the rate of growth, negative where free
        motion decays; without damping they come in pairs +-i lambda, within rounding.

        Returns
        -------
        ndarray of complex, shape (2 n,)
            Poles [1/s] in ascending order of their magnitude.  Poles of coordinates without mass, as of shear
            without rotary inertia, are infinite.

        Examples
        --------
        >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
        >>> found = bd.matrices(bd.Scene(strip, bd.Mount(radius=0.215)), speed=50.0, modes=3)
        >>> (np.abs(found.poles[::2].imag) / (2 * np.pi)).round(2)  # Hz
        array([  61.96,  406.33, 1142.13])
        """
        return free_motion(self.mass, self.damping + self.gyroscopic, self.stiffness).poles

    judged_value = "the natural frequencies"
    counted = "mode"

    @cached_property
    def left_out_effects(self) -> LeftOutEffects:
        """Relative changes of the lowest natural frequencies, five at most, by neglected physical effects."""
        return left_out_of_frequencies(self.scene, self.speed, min(len(self.mass), MOST_JUDGED))

    def deflection(self, x: Sequence[float] | np.ndarray, direction: int = 0) -> np.ndarray:
        """Evaluate the deflection [m] at positions x [m] by a unit of each coordinate: (len(x), n).

        Direction 0 is that of the bending angle, direction 1 is across.

        Raises
        ------
        ValueError
            If a position is not on the beam.
        """
        positions, length = real_array("x", x), self.scene.beam.length
        bound, remedy = "it must be on the beam, from 0 to {limit}", "it is the distance from the root"
        off = (positions < 0) | (positions > length * (1 + 1e-12))
        refuse(off, "x", positions, "m", bound, remedy, limit=length)
        xi = np.minimum(positions / length, 1.0)
        return self.equations.deflection(xi, direction=check_direction(direction)).T


@announced_of_plain_beam
def matrices(
    scene: Scene,
    speed: float,
    modes: int | None = None,
    discretization: DiscretizationChoice = "ritz",
    inputs: Sequence[Excitation | str] | None = None,
    tolerance: float | None = None,
) -> Matrices:
    """Compute the matrices of the equations of motion at a steady speed.

    Parameters
    ----------
    scene : Scene
        The scene; its motion and gravity are not used.
    speed : float
        Speed [rad/s].
    modes : int, optional
        Number of modes of each set of coupled fields, without damping and at this speed, as coordinates;
        all functions of the discretization if not given.
    discretization : {"ritz", "fem"} or Discretization
        As for `natural_modes`.
    inputs : sequence of BaseMotion, PointForce or str, optional
        Columns of the input matrix: see `frequency_response`.  If not given, the acceleration of the base
        and a force at the tip in each direction in which the beam bends.
    tolerance : float, optional
        As for `natural_modes`, for the natural frequencies at this speed: of as many modes as are asked for,
        or else of five.

    Returns
    -------
    Matrices

    Raises
    ------
    ValueError
        If an argument is out of its range, or an input in a fixed direction acts on the rotating beam, so
        that the input matrix would vary.

    References
    ----------
    Lee and Yoo (2019), eq. (14), corrected; section Equations of docs/conventions.md.

    Examples
    --------
    >>> from scipy.linalg import eigh
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> found = bd.matrices(bd.Scene(strip, bd.Mount(radius=0.215)), speed=50.0, modes=3)
    >>> (np.sqrt(eigh(found.stiffness, found.mass)[0]) / (2 * np.pi)).round(2)  # Hz
    array([  61.96,  406.33, 1142.13])
    """
    start = perf_counter()
    scene, speed = check_linear(scene, speed, modes)
    given = list_inputs(inputs, scene)
    model = model_at_speed(with_forces(scene, given), speed, modes, discretization, tolerance)
    equations, pencil = model.equations, model.pencil
    kept = "all functions" if modes is None else f"{counted(modes, 'mode')} at {speed:.6g} rad/s"
    axial = equations.matrices[0].get("root_axial", np.zeros_like(pencil.M))
    coordinates = (*_name_coordinates(model),)
    return Matrices(
        speed=speed,
        mass=model.M,
        damping=pencil.C,
        gyroscopic=speed * pencil.G,
        stiffness=model.K,
        stiffness_by_axial_acceleration=-axial,
        static_load=speed**2 * pencil.f2,
        input_matrix=np.column_stack([steady_drive(model, each).load for each in given]),
        inputs=tuple(f"{each.label} [{each.unit}]" for each in given),
        coordinates=coordinates,
        rows=tuple(f"generalized force of {name.rpartition(' [')[0]}" for name in coordinates),
        error=pole_errors(model),
        warnings=(*warn_of_model(model),),
        provenance=Provenance.since(start, f"{model.discretization}, {kept}"),
        equations=equations,
        scene=scene,
    )


def warn_of_model(model: ModelAtSpeed) -> Iterator[Statement]:
    """Yield warnings about the validity of the linear equations at the speed, as for natural modes."""
    yield from warn_of_left_out(model.scene)
    # Only the lowest modes are examined for growth: those in the model, five at most if it keeps all
    # functions.
    solver = model.model.solver
    found = solver.solve(np.array([model.speed]), min(model.modes or MOST_JUDGED, solver.size))
    growing = int((np.real(found.eigenvalue) > 0).sum())
    if growing:
        end = f": {counted(growing, 'growing mode')}; see poles"
        yield Statement("unstable at ", Speeds(model.speed), end, kind=GROWING)
    yield from warn_of_rotation(model.model, model.speed)


def listed(name: str, given: Any) -> tuple[Any, ...]:
    """Return the members of a sequence as a tuple; raise `InvalidValue` if there are none."""
    members = several(name, given, object)
    if not members:
        raise InvalidValue(name, given, "it is empty", "give one at least, or leave it out")
    return members


def list_inputs(given: Sequence[Any] | None, scene: Scene) -> list[Excitation]:
    """List the requested excitations, or by default base motion and tip force in each bending direction."""
    if given is not None:
        return [as_excitation(f"inputs[{k}]", each) for k, each in enumerate(listed("inputs", given))]
    usual: list[Excitation] = [BaseMotion(), PointForce()]
    return usual if scene.physics.planes == 1 else [*usual, BaseMotion(ACROSS), PointForce(None, ACROSS)]


def steady_drive(model: ModelAtSpeed, excitation: Excitation) -> HarmonicDrive:
    """Compute the load of an excitation whose direction turns with the beam.

    An excitation of fixed direction is refused, because its input matrix would vary as the beam turns.
    """
    drives = model.drives(excitation)
    bound = "the input matrix would vary, as the load has the input's frequency plus and minus the speed"
    remedy = 'give "bending", "across" or "n3", or speed = 0; frequency_response accepts this input'
    refuse(list(drives) != [0], "speed", model.speed, "rad/s", f"{excitation.label}: {bound}", remedy)
    return drives[0]


def _name_coordinates(model: ModelAtSpeed) -> Iterator[str]:
    """Name each coordinate with its unit: a mode, a nodal value, or the coefficient of a trial function."""
    for name, place in model.equations.blocks.items():
        size = place.stop - place.start
        if name == BLOCK:
            yield "charge [C]"
        elif model.modes is not None:
            yield from (f"{name}, mode {k} [kg^1/2 m]" for k in range(1, size + 1))
        else:
            yield from _name_functions(model, name, size)


def _name_functions(model: ModelAtSpeed, field_name: str, size: int) -> Iterator[str]:
    """Name the coordinates of a field: deflections and slopes at nodes, or else coefficients."""
    deflection = model.equations.deflections.get(field_name)
    nodes = getattr(model.discretization.spaces(model.scene.modelled_beam), "nodes", None)
    # A discretization other than finite elements may use "nodes" for something else.
    nodes = nodes if isinstance(nodes, np.ndarray) else None
    nodal: list[np.ndarray] = []
    if nodes is not None and deflection is not None:
        nodal = [deflection.space.evaluate(nodes, order) for order in (0, 1)]
    for k in range(size):
        at = [(order, int(values[k].argmax())) for order, values in enumerate(nodal) if _is_nodal(values[k])]
        if nodes is None or not at:
            yield f"{field_name}, coefficient of function {k + 1} [m]"
            continue
        (order, node), what = at[0], ("deflection", "slope by x/L")
        yield f"{field_name}, {what[order]} at {nodes[node] * model.scene.beam.length:.6g} m [m]"


def _is_nodal(values: np.ndarray) -> bool:
    """Return whether a trial function is 1 at one node and 0 at all others."""
    return abs(values.max() - 1) < _NODAL and np.sum(np.abs(values) > _NODAL) == 1
