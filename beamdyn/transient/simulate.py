"""Simulation of a transient: motion of a scene's beam in time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, ascending, positive, within
from beamdyn.common.parallel.workers import one_blas_thread
from beamdyn.common.results.statements import announced
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice
from beamdyn.modes.modal.model import FEWEST_MODES, ModalBasis, find_speed_range, given_basis
from beamdyn.modes.model_error.effect_choice import bend_for_peak, choose_for_motion
from beamdyn.modes.repeated import repeatable
from beamdyn.scene.scene import Scene, check_scene
from beamdyn.transient.smallest_basis import run_smallest_basis
from beamdyn.transient.step_size import TOLERANCES
from beamdyn.transient.transient import Transient, TransientRequest

if TYPE_CHECKING:
    from scipy.integrate import OdeSolver


@announced
@repeatable
@one_blas_thread()  # with small matrices, further threads only slow each other down
def simulate(
    scene: Scene,
    t_end: float,
    modes: int | str | None = "auto",
    tolerance: float = 1e-5,
    method: str | type[OdeSolver] = "auto",
    discretization: DiscretizationChoice = "ritz",
    initial: str | np.ndarray = "rest",
    t_eval: np.ndarray | Sequence[float] | None = None,
    **options: Any,
) -> Transient:
    """Integrate the motion of the beam from time 0 to `t_end` in modal coordinates.

    Parameters
    ----------
    scene : Scene
        The scene, with a motion.
    t_end : float
        End of the run [s].
    modes : int, "auto" or None
        Number of modes at rest of each uncoupled displacement (such as bending in each plane).  "auto" takes
        modes at the slowest and at the fastest speed: the smallest modal basis whose truncation error meets
        the tolerance.  The search stops earlier, with a warning, if the next basis would take minutes: if the
        number of steps times the squared number of coordinates exceeds 5e7, or 5e6 if the last added modes
        reduced the error by less than a factor of four.  None keeps all functions of the discretization.
    tolerance : float
        Target of the time-integration error, and with ``modes="auto"`` also of the modal truncation error,
        each relative to the largest tip deflection.  An error that exceeds it is named in `warnings`.  If no
        affordable basis meets a tolerance below 1e-5, the run with tolerance 1e-5 is returned if its total
        error is smaller.
    method : {"auto", "RK45", "DOP853", "Radau", "BDF", "LSODA", ...} or OdeSolver
        "auto": Gauss collocation with a step size from the tolerance; or any method of `solve_ivp`.
    discretization : {"ritz", "fem"} or Discretization
        Discretization from which the modes are computed.
    initial : {"rest", "equilibrium"} or ndarray, shape (2 m,)
        "rest": undeflected, without velocity; "equilibrium": in static equilibrium with the loads at time
        0; or coordinates and velocities.
    t_eval : sequence of float, optional
        Times of the result [s]; by default eight per step.
    **options
        Options of a method of `solve_ivp`, such as max_step; rtol is `tolerance` by default, and atol a
        tenth of it, times the largest magnitude of each coordinate.

    Returns
    -------
    Transient

    Raises
    ------
    ValueError
        If an argument is out of its range, the motion passes the critical speed, or the run takes more
        steps than fit into memory (three million, fewer with more than five coordinates).
    TypeError
        If there are options without a method of `solve_ivp` that takes them.
    ArithmeticError
        If the motion grows without bound.

    References
    ----------
    Lee and Yoo (2019), eq. (14), corrected; integrated as Hairer, Lubich and Wanner (2006), Geometric
    Numerical Integration, sections II.1.3 and IV.2.1.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> wheel = bd.RollingWheel(0.3, bd.SpinUp(55.0, duration=1.0), bd.RoadWave(0.3, velocity_amplitude=0.01))
    >>> run = bd.simulate(bd.Scene(strip, bd.Mount(radius=0.215), wheel), t_end=2.0, modes=2)
    >>> round(1e3 * run.peak(1.0, 2.0), 1)  # mm
    0.8
    """
    check_scene(scene)
    if not (isinstance(method, str) and method == "auto"):
        from beamdyn.transient.scipy_integrators import check_method

        check_method(method)
    t_end, tolerance = positive("t_end", t_end, "s"), within("tolerance", tolerance, *TOLERANCES)
    if scene.motion is None:
        raise InvalidValue("scene.motion", None, "a transient needs a motion", "such as SteadyRotation(50.0)")
    if method == "auto" and options:
        raise TypeError(
            f"simulate has no option {' or '.join(options)}; options such as max_step belong to a method of "
            'solve_ivp, such as method="RK45"'
        )
    times = None if t_eval is None else ascending("t_eval", t_eval)
    if times is not None and (times[0] < 0 or times[-1] > t_end):
        within_run = f"times must lie in the run, 0 ... {t_end:g} s"
        raise ValueError(f"t_eval = {times[0]:g} ... {times[-1]:g} s: {within_run}")
    basis = ModalBasis(None) if modes is None else given_basis(modes)
    if basis is None and not isinstance(initial, str):
        raise ValueError('initial is an array: give the number of its modes, not modes = "auto"')
    speeds = find_speed_range(scene.motion, t_end)
    smallest = basis or ModalBasis(FEWEST_MODES, speeds)
    scene = choose_for_motion(scene, np.array(speeds), basis and basis.modes, tolerance)
    request = TransientRequest(
        scene, t_end, tolerance, method, discretization, initial, times, options, smallest
    )
    run = request.run() if basis else run_smallest_basis(request)
    if (bent := bend_for_peak(scene, run.largest)) is None:
        return run
    request = replace(request, scene=bent)
    return request.run() if basis else run_smallest_basis(request)
