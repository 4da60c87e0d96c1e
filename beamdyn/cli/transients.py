"""Commands on the motion in time: one transient, and a sweep of them over speed."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from cyclopts import Parameter

from beamdyn.cli.program import app, deliver
from beamdyn.cli.values import (
    BasisSize,
    Discretization,
    PhysicsOption,
    SceneFile,
    Text,
    Workers,
    load_moving,
    naming_option,
    parse_positive,
    parse_speeds,
    parse_window,
)
from beamdyn.common.edge.outputs import NO_FILES, Outputs, on_axes
from beamdyn.common.edge.program import Interrupted, examples
from beamdyn.common.edge.varying import Folder

if TYPE_CHECKING:
    import numpy as np

    from beamdyn.transient.transient import Transient

Integrator = Literal["auto", "RK23", "RK45", "DOP853", "Radau", "BDF", "LSODA"]

_PERIODS, _FRAMES = 3, 60  # of a close-up


@app.command(
    help_epilogue=examples(
        'beamdyn simulate examples/rolling_harvester.toml --t-end "12 s" --modes 3',
    )
)
def simulate(
    scene: SceneFile,
    /,
    *,
    t_end: Text,
    modes: BasisSize = "auto",
    tolerance: float = 1e-5,
    method: Integrator = "auto",
    discretization: Discretization = "ritz",
    window: Text | None = None,
    series: Path | None = None,
    animation: Path | None = None,
    physics: PhysicsOption = None,
    outputs: Outputs = NO_FILES,
) -> None:
    """Transient of the beam, from rest.

    Parameters
    ----------
    scene
        The scene, with a motion.
    t_end
        End of the run with its unit, e.g. "30 s".
    modes
        Size of the modal basis; auto: the smallest whose modal truncation error meets the tolerance.
    tolerance
        Target for the time-integration error, relative to the largest deflection.
    method
        Integrator: auto is the package's own; scipy's take minutes where that takes a second.
    discretization
        ritz: assumed modes; fem: finite elements. They are independent, so that each checks the other.
    window
        Also give the largest deflection within this time window: start:end, e.g. "20:30 s".
    series
        Write three periods around the largest deflection (within the window) for ParaView: .xdmf.
    animation
        Write an animation of the same: .gif.
    physics
        auto: add the effects whose size exceeds the tolerance, in place of the physics of the scene.
    outputs
        Output files.
    """
    from beamdyn.cautions import warnings_of
    from beamdyn.common.edge.html_report import Question
    from beamdyn.tables.results import transient_table
    from beamdyn.tables.rows import transient_csv
    from beamdyn.transient.simulate import simulate

    outputs.check(scene, series=series, animation=animation)
    end = parse_positive("--t-end", t_end, "s")
    span = None if window is None else parse_window(window, end)
    loaded = load_moving(scene, physics)
    question = Question.on_file(
        "beamdyn simulate", scene, t_end=t_end, modes=modes, tolerance=tolerance, method=method,
        discretization=discretization, window=window, physics=physics,
    )  # fmt: skip
    with naming_option("t_end", "--t-end", t_end):
        run = simulate(loaded, end, modes, tolerance, method, discretization)
    _write_close_up(run, span or (0.0, end), series, animation, outputs.force)
    tables, rows = [transient_table(run, span)], transient_csv(run)
    deliver(run, outputs, question, tables, rows, on_axes(run.plot), warnings_of(run))


@app.command(
    help_epilogue=examples(
        'beamdyn sweep examples/rough_road.toml --speeds "50:60:3 rad/s" --window "1:2 s"',
    )
)
def sweep(
    scene: SceneFile,
    /,
    *,
    speeds: Text,
    window: Text,
    modes: BasisSize = "auto",
    tolerance: float = 1e-5,
    workers: Workers = 1,
    scheduler: Annotated[
        str | None, Parameter(help="Address of a Dask scheduler, e.g. tcp://host:8786.")
    ] = None,
    store: Folder = None,
    physics: PhysicsOption = None,
    outputs: Outputs = NO_FILES,
) -> None:
    """Largest deflection within a time window over speed: one transient per speed.

    Parameters
    ----------
    scene
        The scene; the final speed of its motion is varied.
    speeds
        Speeds with their unit: start:stop:count, e.g. "0:150:151 rad/s", or a list, e.g. "50, 55 rad/s".
    window
        Time window of the largest deflection: start:end, e.g. "20:30 s"; each transient ends with it.
    modes
        Size of the modal basis; auto: the smallest whose modal truncation error meets the tolerance.
    tolerance
        Target for the time-integration error, relative to the largest deflection.
    workers
        Number of processes.
    store
        Folder for finished speeds: after an interruption the same command computes only the others.
    physics
        auto: add the effects whose size exceeds the tolerance, in place of the physics of the scene.
    outputs
        Output files.
    """
    from beamdyn.cautions import warnings_of
    from beamdyn.common.edge.html_report import Question
    from beamdyn.tables.results import sweep_table
    from beamdyn.tables.rows import sweep_csv
    from beamdyn.transient.sweep import sweep

    outputs.check(scene, store)
    span, loaded = parse_window(window), load_moving(scene, physics, speeds)
    given = parse_speeds(speeds, loaded)
    question = Question.on_file(
        "beamdyn sweep",
        scene,
        speeds=speeds,
        window=window,
        modes=modes,
        tolerance=tolerance,
        physics=physics,
    )
    named = naming_option("t_end", "--window", window)
    with _executor(scheduler) as executor, _progress(len(given), store) as progress, named:
        means: dict[str, Any] = {"workers": workers, "executor": executor, "store": store}
        result = sweep(loaded, given, span, modes=modes, tolerance=tolerance, **means, progress=progress)
    tables, rows, draw = [sweep_table(result)], sweep_csv(result), on_axes(result.plot)
    deliver(result, outputs, question, tables, rows, draw, warnings_of(result))


# Close-up -----------------------------------------------------------------------------------------


def _write_close_up(
    run: Transient, window: tuple[float, float], series: Path | None, animation: Path | None, force: bool
) -> None:
    from beamdyn.cautions import notes_of
    from beamdyn.output.export import animate, write_series

    if series is None and animation is None:
        return
    x, t, deflection = _close_up(run, window)
    if series is not None:
        write_series(series, x, t, deflection, force=force)
    if animation is not None:
        animate(x, t, deflection, animation, force=force, notes=notes_of(run))


def _close_up(run: Transient, window: tuple[float, float]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Positions, times and deflections: a few periods around the largest deflection in a window."""
    import numpy as np

    from beamdyn import natural_modes
    from beamdyn.tables.results import time_of_peak

    middle, _ = time_of_peak(run, *window)
    speed = float(run.scene.motion.at(np.array([middle])).speed[0]) if run.scene.motion else 0.0
    half = _PERIODS / 2 / float(natural_modes(run.scene, speed, 1).frequency[0])
    t = np.linspace(max(middle - half, 0.0), min(middle + half, run.path.end), _FRAMES)
    x = np.linspace(0, run.scene.beam.length, 41)
    return x, t, run.shape(x, t)


# Sweeps -------------------------------------------------------------------------------------------


@contextmanager
def _executor(scheduler: str | None) -> Iterator[Executor | None]:
    """The executor of a Dask cluster, if there is a scheduler."""
    if scheduler is None:
        yield None
        return
    try:
        from distributed import Client
    except ImportError:
        raise ValueError("--scheduler needs Dask: pip install 'beamdyn[dask]'") from None
    try:
        client = Client(scheduler, timeout="10s")
    except (OSError, ValueError) as error:
        raise ValueError(f"--scheduler = {scheduler}: no scheduler answers there ({error})") from None
    with client:
        yield client.get_executor()


@contextmanager
def _progress(cases: int, store: Path | None) -> Iterator[Callable[[int, int], None]]:
    """A bar with the remaining time; where the sweep is interrupted, say what is done."""
    from beamdyn.common.edge.progress import at_work
    from beamdyn.transient.sweep import SweepInterrupted

    finished = 0

    def progress(done: int, total: int) -> None:
        nonlocal finished
        finished = done
        show(done, total)

    try:
        with at_work("sweep") as show:
            yield progress
    except KeyboardInterrupt:
        raise Interrupted(_how_to_resume(finished, cases, store)) from None
    except SweepInterrupted as error:
        raise Interrupted(str(error)) from None


def _how_to_resume(done: int, cases: int, store: Path | None) -> str:
    if store is None:
        return f"{done} of {cases} speeds were done and are lost; --store DIR keeps what is done"
    return f"{done} of {cases} speeds are stored in {store}; the same command goes on from there"
