"""The smallest modal basis with which a transient meets its tolerance."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from beamdyn.accuracy.refinement import refine
from beamdyn.modes.modal.modal_basis import ModalBasis
from beamdyn.transient.trajectory import SAMPLES
from beamdyn.transient.transient import Transient, TransientRequest, warn_of_missed_modes

_MOST_WORK = 5e7  # steps times squared size of a run (some seconds) beyond which "auto" adds no more modes
_SLOW_WORK = 5e6  # the same if the last modes added have reduced the truncation error by less than _FAST
_FAST = 4.0
_FEW_MODES, _NEARLY = 4, 30.0  # modes of which one more divides the error by more than this, where they do
_TIGHT = 1e-5  # tolerance below which, if the modes miss it, this one is tried as well


def run_smallest_basis(request: TransientRequest) -> Transient:
    """Integrate with the smallest basis that meets the tolerance, else with the best that is known.

    The basis of the request is the first that is tried.
    """
    tolerance = request.tolerance
    run = _search(replace(request, method="auto", t_eval=None))
    if run.mode_error > tolerance and tolerance < _TIGHT:
        # Accurate steps leave less work for modes: with coarser ones the whole error may be smaller.
        coarse = _search(replace(request, method="auto", t_eval=None, tolerance=_TIGHT))
        run = min(run, coarse, key=_whole_error)
    missed = tuple(warn_of_missed_modes(run.mode_error, tolerance, str(run.request.basis)))
    as_requested = request.method == "auto" and request.t_eval is None
    run = run if as_requested else replace(request, basis=run.request.basis).run()
    return run.with_warnings(missed) if missed else run


def _whole_error(run: Transient) -> float:
    """Errors of time integration and modal truncation together [m]."""
    return run.time_error + run.mode_error * run.largest


def _search(request: TransientRequest) -> Transient:
    """Add modes until the truncation error meets the tolerance, or takes too much work."""
    run, tolerance = request.run(), request.tolerance
    if run.mode_error > tolerance and (finer := run.with_more_modes) is not None:
        # A sudden motion excites many modes: as many modes at rest may then be the better basis.
        at_rest = replace(run.request, basis=ModalBasis(run.system.equations.modes)).run()
        if at_rest.distance_from_path(*finer) < run.distance_from_path(*finer):
            run = _refine_better(at_rest, run, tolerance)
    return _add_modes(run, tolerance)


def _refine_better(at_rest: Transient, at_speeds: Transient, tolerance: float) -> Transient:
    """Refine modes at rest; where they are far from the tolerance, those at speeds if these converge faster.

    Few modes tell little of that: those at rest may be closer, and then fall behind for good.
    """
    if at_rest.mode_error <= _NEARLY * tolerance:
        return at_rest
    refined = [run for run in (at_rest.refined, at_speeds.refined) if run is not None]
    return min(refined, key=lambda run: run.mode_error, default=at_rest)


def _add_modes(run: Transient, tolerance: float) -> Transient:
    """Refine a run until its truncation error meets the tolerance, while that is known and takes seconds."""

    def finer(found: tuple[Transient, float]) -> tuple[Transient, float] | None:
        run, before = found
        larger = _enlarge(run, tolerance)
        most = _MOST_WORK if run.mode_error * _FAST < before else _SLOW_WORK
        if larger is None or _work(larger) > most or larger.with_more_modes is None:
            return None
        return larger, run.mode_error

    return refine((run, np.inf), finer, lambda found: not found[0].mode_error > tolerance)[0]


def _enlarge(run: Transient, tolerance: float) -> Transient | None:
    """The next larger run to try: by one of few modes where these nearly suffice, else as `refined`."""
    few = (run.request.basis.modes or np.inf) <= _FEW_MODES
    if few and run.mode_error <= _NEARLY * tolerance:
        return run.request.run_with_one_more()
    return run.refined


def _work(run: Transient) -> float:
    """Steps times squared number of coordinates, to which the time of a run is roughly proportional."""
    return len(run.path.samples[0]) / SAMPLES * run.system.size**2
