"""Steady-state response, harvested energy, and time simulation: one transient, or a sweep over speed."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np

import beamdyn as bd
from beamdyn.analyses import options
from beamdyn.analyses.analysis import WRITTEN, Answer, AsText, analysis
from beamdyn.analyses.results.cautions import notes_of
from beamdyn.analyses.results.of_motion import time_of_peak, transient_table
from beamdyn.analyses.values import at_most, parse_positive, parse_window
from beamdyn.common.edge.command_options import NO_FILES, Folder, Outputs
from beamdyn.common.edge.console import at_work
from beamdyn.common.edge.exit_codes import Interrupted
from beamdyn.common.plots.export import animate
from beamdyn.common.results.columns import evenly_spread
from beamdyn.common.results.result import Result
from beamdyn.common.words import at_any
from beamdyn.steady.best_resistance import ROUGH, sought
from beamdyn.steady.harvest import harvested

# Steady-state response -------------------------------------------------------------------------------


TopOfSearch = Annotated[
    float, AsText(lambda option, text, scene: parse_positive(option, text, "rad/s", scene))
]


@analysis(
    'beamdyn resonances examples/rolling_harvester.toml --top-speed "150 rad/s"',
    about_scene="The scene; its motion and gravity give the frequencies that are excited.",
)
def resonances(
    scene: bd.Scene,
    *,
    top_speed: TopOfSearch,
    modes: options.ModeCount = 3,
    order: options.Order = 1,
    discretization: options.Discretization = "ritz",
) -> bd.Crossings:
    """Speeds of resonance, at which a frequency that the scene excites meets a natural frequency.

    Parameters
    ----------
    top_speed
        Largest speed to search, with its unit, e.g. "150 rad/s".
    order
        1: resonances excited by the load; more: also combination resonances caused by periodic
        coefficients of the equations.
    """
    return bd.resonance_speeds(scene, top_speed, modes, order, discretization)


@analysis('beamdyn steady examples/rolling_harvester.toml --speeds "1:150:30 rad/s"')
def steady(
    scene: bd.Scene,
    *,
    speeds: options.Speeds,
    modes: options.SmallestBasis = "auto",
    tolerance: float = 1e-5,
    discretization: options.Discretization = "ritz",
) -> Answer:
    """Steady response over speed, after the transient of the start has decayed.

    Parameters
    ----------
    speeds
        Speeds with their unit: start:stop:count, e.g. "1:150:1000 rad/s", or a list, e.g. "50, 55
        rad/s".
    tolerance
        Largest error due to omitted harmonics, relative to the sum of the amplitudes of all harmonics.
    """
    result = bd.steady_response(scene, speeds, modes, tolerance=tolerance, discretization=discretization)
    none = f"there is no steady response {at_any(len(speeds), 'speed')}: {result.status[0]}"
    return Answer(result, "" if result.stable.any() else none)


_HARVESTER = "The scene, with a table [harvester]; gravity and its motion excite the beam."


_FEW_SPEEDS, _ROUGH = 11, 1e-2  # number of speeds, and tolerance, of a preliminary result


def _harvest_sooner(
    scene: bd.Scene, speeds: np.ndarray, road: str | None = None, highest: str | None = None, **options: Any
) -> Result:
    """Compute the harvested power at a few of the speeds, without its error, as a preliminary result."""
    given = {"modes": "auto", "discretization": "ritz", **options, "tolerance": _ROUGH}
    few = speeds[evenly_spread(len(speeds), _FEW_SPEEDS)]
    return harvested(scene, speeds=few, road=_roughness(road, highest), compared=False, **given)


@analysis(
    'beamdyn harvest examples/bimorph.toml --speeds "10:130:61 rad/s"',
    'beamdyn harvest examples/bimorph.toml --speeds "30:120:19 km/h" --road A',
    screen="Harvest",
    sooner=_harvest_sooner,
    opens_with=("--speeds", "30:130:41 km/h", "--road", "A", "--highest", "10 1/m", "--modes", "3"),
    about_scene=_HARVESTER,
)
def harvest(
    scene: bd.Scene,
    *,
    speeds: options.Speeds,
    road: options.RoadClass | None = None,
    highest: options.Text | None = None,
    modes: options.SmallestBasis = "auto",
    tolerance: float = 1e-5,
    discretization: options.Discretization = "ritz",
) -> Answer:
    """Power that piezoelectric layers harvest over speed, with voltage, strain and efficiency.

    Parameters
    ----------
    speeds
        Speeds with their unit: start:stop:count, e.g. "10:130:61 rad/s", or a list, e.g. "50, 55 rad/s";
        for a rolling wheel also velocities, e.g. "30:120:46 km/h".
    road
        Class of an additional random road profile by ISO 8608, from A (very good) to H.
    highest
        Highest spatial frequency of this random road; default: 2.83 1/m, as in the standard.
    tolerance
        Largest error due to omitted harmonics, relative to the sum of the amplitudes of all harmonics.
    """
    result = bd.harvest(scene, speeds, modes, tolerance, discretization, _roughness(road, highest))
    none = f"there is no steady response {at_any(len(speeds), 'speed')}: {result.status[0]}"
    return Answer(result, "" if (result.status == "stable").any() else none)


def _roughness(road: str | None, highest: str | None) -> bd.RoadRoughness | None:
    """Read the class of a random road, and its highest spatial frequency; None without a road."""
    if highest is not None and road is None:
        raise ValueError(f'--highest = "{highest}": it limits a random road, but there is none; give --road')
    limit = {} if highest is None else {"highest": parse_positive("--highest", highest, "1/m")}
    return None if road is None else bd.RoadRoughness(road, **limit)


def _resistance_sooner(
    scene: bd.Scene, road: str | None = None, highest: str | None = None, **options: Any
) -> Result:
    """Search the best load resistance roughly, as a preliminary result."""
    given = {"discretization": "ritz", **options, "tolerance": _ROUGH, "road": _roughness(road, highest)}
    return sought(ROUGH, scene, **given)


@analysis(
    'beamdyn best-resistance examples/bimorph.toml --speed "55 rad/s"',
    'beamdyn best-resistance examples/bimorph.toml --speed "90 km/h" --road A',
    screen="Best resistance",
    sooner=_resistance_sooner,
    about_scene=_HARVESTER,
)
def best_resistance(
    scene: bd.Scene,
    *,
    speed: options.AtFinalSpeed,
    road: options.RoadClass | None = None,
    highest: options.Text | None = None,
    modes: options.SmallestBasis = 3,
    tolerance: float = 1e-5,
    discretization: options.Discretization = "ritz",
) -> bd.BestResistance:
    """Load resistance at which piezoelectric layers harvest most power at a speed, and this power.

    Parameters
    ----------
    road
        Class of an additional random road profile by ISO 8608, from A (very good) to H.
    highest
        Highest spatial frequency of this random road; default: 2.83 1/m, as in the standard.
    tolerance
        Largest error due to omitted harmonics, relative to the sum of the amplitudes of all harmonics.
    """
    return bd.best_resistance(scene, speed, modes, tolerance, discretization, _roughness(road, highest))


# Time simulation -------------------------------------------------------------------------------------


# Number of periods of the first mode in a close-up, and number of frames of its animation.
_PERIODS, _FRAMES = 3, 60
Method = Literal["auto", "RK23", "RK45", "DOP853", "Radau", "BDF", "LSODA"]
Window = Annotated[tuple[float, float], AsText(lambda _, text, __: parse_window(text))]


@analysis(
    'beamdyn simulate examples/rolling_harvester.toml --t-end "12 s" --modes 3',
    about_scene="The scene, with a motion.",
    moving=lambda _: True,
)
def simulate(
    scene: bd.Scene,
    *,
    t_end: options.EndOfRun,
    modes: options.SmallestBasis = "auto",
    tolerance: options.TimeTolerance = 1e-5,
    method: Method = "auto",
    discretization: options.Discretization = "ritz",
    window: options.Text | None = None,
    series: Annotated[Path | None, WRITTEN] = None,
    animation: Annotated[Path | None, WRITTEN] = None,
    outputs: Outputs = NO_FILES,
) -> Answer:
    """Transient motion of the beam, starting from rest.

    Parameters
    ----------
    t_end
        End of the run with its unit, e.g. "30 s".
    method
        Integrator; auto: the package's own, which takes a second where those of scipy take minutes.
    window
        Also give the largest deflection within this time window: start:end, e.g. "20:30 s".
    series
        Write three periods around the largest deflection (within the window) for ParaView: .xdmf.
    animation
        Write an animation of these three periods: .gif.
    """
    span = None if window is None else parse_window(window, t_end)
    run = bd.simulate(scene, t_end, modes, tolerance, method, discretization)
    _write_close_up(run, span or (0.0, t_end), series, animation, outputs.force)
    return Answer(run, tables=[transient_table(run, span)])


@analysis(
    'beamdyn sweep examples/rough_road.toml --speeds "50:60:3 rad/s" --window "1:2 s"',
    about_scene="The scene; the final speed of its motion is varied.",
    moving=lambda _: True,
)
def sweep(
    scene: bd.Scene,
    *,
    speeds: options.Speeds,
    window: Window,
    modes: options.SmallestBasis = "auto",
    tolerance: options.TimeTolerance = 1e-5,
    workers: Annotated[int, at_most(128)] = 1,
    scheduler: str | None = None,
    store: Folder = None,
) -> bd.Sweep:
    """Largest deflection within a time window over speed: one transient per speed.

    Parameters
    ----------
    speeds
        Speeds with their unit: start:stop:count, e.g. "0:150:151 rad/s", or a list, e.g. "50, 55
        rad/s".
    window
        Time window of the largest deflection: start:end, e.g. "20:30 s"; each transient ends with
        it.
    workers
        Number of processes.
    scheduler
        Address of a Dask scheduler, e.g. tcp://host:8786.
    store
        Folder for the results of finished speeds: after an interruption, the same command computes only the
        other speeds.
    """
    with _executor(scheduler) as executor, _progress(len(speeds), store) as progress:
        means: dict[str, Any] = {"workers": workers, "executor": executor, "store": store}
        return bd.sweep(scene, speeds, window, modes=modes, tolerance=tolerance, **means, progress=progress)


# Close-up -----------------------------------------------------------------------------------------


def _write_close_up(
    run: bd.Transient, window: tuple[float, float], series: Path | None, animation: Path | None, force: bool
) -> None:
    """Write the motion during a few periods around the largest deflection in a window."""
    if series is None and animation is None:
        return
    middle, _ = time_of_peak(run, *window)
    speed = float(run.scene.motion.at(np.array([middle])).speed[0]) if run.scene.motion else 0.0
    half = _PERIODS / 2 / float(bd.natural_modes(run.scene, speed, 1).frequency[0])
    t = np.linspace(max(middle - half, 0.0), min(middle + half, run.path.end), _FRAMES)
    if series is not None:
        run.export(series, t[0], t[-1], _FRAMES, force)
    if animation is not None:
        x = np.linspace(0, run.scene.beam.length, 41)
        animate(x, t, run.shape(x, t), animation, force=force, notes=notes_of(run))


# Sweeps -------------------------------------------------------------------------------------------


@contextmanager
def _executor(scheduler: str | None) -> Iterator[Executor | None]:
    """Yield the executor of a Dask cluster, or None if no scheduler is given."""
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
    """Yield a function that shows progress; if the sweep is interrupted, report how much is done."""
    finished = 0

    def progress(done: int, total: int) -> None:
        nonlocal finished
        finished = done
        show(done, total)

    try:
        with at_work("sweep") as show:
            yield progress
    except KeyboardInterrupt:
        how = f"stored in {store}; the same command goes on from there"
        lost = f"{finished} of {cases} speeds were done and are lost; --store DIR keeps what is done"
        raise Interrupted(lost if store is None else f"{finished} of {cases} speeds are {how}") from None
    except bd.SweepInterrupted as error:
        raise Interrupted(str(error)) from None
