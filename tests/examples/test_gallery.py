"""Every example of the gallery runs, draws, and shows what a closed form, a law or a paper has."""

from __future__ import annotations

import runpy
from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import cumulative_trapezoid

GALLERY = Path(__file__).parents[2] / "examples" / "gallery"
EXAMPLES = sorted(GALLERY.rglob("*.py"))
Names = dict[str, Any]


def inward_beam(names: Names) -> None:
    """ANSYS as printed, to its three decimals, at 0, 50, 100 rad/s (Table 2 of the paper)."""
    import beamdyn as bd

    ours = bd.frequency_locus(names["scene"], [0.0, 50.0, 100.0], modes=1).frequency[:, 0]
    assert_allclose(ours, [65.230, 61.963, 50.907], rtol=0, atol=6e-4)
    assert names["locus"].frequency[-1, 0] < 0.15 * ours[0]  # to nothing, at the critical speed


def setting_angle(names: Names) -> None:
    """The paper's interval, section 3.3."""
    assert 88.35 < np.degrees(names["limits"].first) < 88.36


def campbell_diagram(names: Names) -> None:
    """Two planes with the twist, by other methods: beamdyn/published/blades.toml."""
    rated = [m.frequency for m in names["diagram"].margins if m.where == "rated speed"]
    assert_allclose(rated, [0.729408, 1.095172, 2.013645, 4.031552], rtol=1e-5)  # as that page states


def mode_shapes(names: Names) -> None:
    """The tip of the second mode moves far less with a mass on it."""
    shape = names["shape"]
    assert abs(shape[1, -1]) < 0.1 * abs(shape[1]).max()
    assert abs(shape[0, -1]) == abs(shape[0]).max()


def square_plate(names: Names) -> None:
    """Another plate program, converged to 1e-5; torsion of a section with edges is less stiff by 0.6 t/b."""
    of_plate = [3.4710, 8.5063, 21.284, 27.199, 30.955, 54.184]
    assert_allclose(names["scaled"], of_plate, rtol=2e-3)
    assert [*names["modes"].kind] == ["bending", "torsion", "bending", "camber", "torsion", "camber"]


def guaranteed_bounds(names: Names) -> None:
    assert names["inside"].all()


def tip_mass(names: Names) -> None:
    """Rayleigh's 33/140 is an upper bound, exact for a heavy tip."""
    excess = names["formula"] / names["exact"] - 1
    assert (excess > 0).all() and excess[0] < 0.015 and excess[-1] < 1e-6


def convergence(names: Names) -> None:
    """Elements: order 6, what is left of 4 once that is extrapolated away; the next term is h^2 of it.

    From 4 elements (2 are extrapolated from a single one) to 16, beyond which it comes to rounding. Ritz:
    twelve digits from eight functions, as the title says, and rounding from there on.
    """
    fem, elements = np.array(names["fem"])[1:4], names["elements"][1:4]
    order = np.log2(fem[:-1] / fem[1:])
    assert (abs(order - 6.0) < 1.0 / elements[:-1] ** 2).all()
    assert max(names["ritz"][list(names["functions"]).index(8) :]) < 1e-12


def buckling(names: Names) -> None:
    """The critical speed is that of the straight beam."""
    import beamdyn as bd

    assert_allclose(
        names["found"].critical_speed, bd.critical_speed(bd.Scene(names["beam"], bd.Mount(0.215))), rtol=1e-6
    )


def bent_blade(names: Names) -> None:
    """Thrown outward: ever further, and never longer than the strip."""
    assert -0.05 < names["across"][-1] < -0.04
    length = np.hypot(np.diff(names["along"]), np.diff(names["across"])).sum()
    assert_allclose(length, 0.05, rtol=1e-3)  # of chords


def backbone(names: Names) -> None:
    """Outward at 100 rad/s, the last curve: it starts at the frequency of small vibration."""
    assert names["frequencies"][0] == 1.0


def whirling_shaft(names: Names) -> None:
    """At rest less and plus the speed; 0.01 deg from the axis, an effect of its square."""
    turns = names["speeds"] / (2 * np.pi)
    both = names["rest"] + np.stack([-turns, turns], axis=-1)
    assert_allclose(np.sort(names["locus"].frequency, axis=-1), both, rtol=1e-5)


def rolling_wheel(names: Names) -> None:
    """Table 3 of the paper, by three modes: 1.94 mm as printed."""
    assert round(1e3 * names["peak"], 2) == 1.94


def resonance_over_speed(names: Names) -> None:
    """The response is largest where the first two lines cross: 53.0858 and 69.8024 rad/s."""
    import beamdyn as bd

    speeds = sorted(c.speed for c in names["crossings"].crossings)[:2]
    at = bd.steady_response(names["scene"], [speeds[0], 61.0, speeds[1]], modes=3).amplitude
    assert min(at[0], at[2]) > 3 * at[1]


def ring_down(names: Names) -> None:
    """After many time constants the run is the steady response; both state errors far below a percent."""
    run = names["run"]
    assert_allclose(run.peak(9.0, 10.0), names["steady"], rtol=0.02)
    assert run.peak(0.0, 3.0) > 2 * names["steady"]


def frequency_response(names: Names) -> None:
    assert names["found"].response.shape == (600, 2)


def rough_road(names: Names) -> None:
    """The mean square is the integral of the density, to the grid's accuracy."""
    road = names["road"]
    assert_allclose(np.trapezoid(road.psd, road.frequencies), road.rms**2, rtol=0.05)


def loads_along_span(names: Names) -> None:
    """Pull and moments at the root by quadrature alone, to its 20 000 intervals' accuracy.

    The edgewise moment lies a thousandth below the weight's: the weight hangs the blade 0.43 m down, and
    centrifugal forces, which point from the axis 1.5 m behind the root, lift it again.
    """
    loads, beam, speed = names["loads"], names["blade"].beam, 12.1 * np.pi / 30
    pull, moment = root_loads(beam, 1.5, speed, 9.81)
    assert_allclose(loads.force[0, 0, 0], pull, rtol=1e-7)
    assert_allclose(loads.moment[0, 0], moment, rtol=1e-7)
    weight = root_loads(beam, 1.5, 0.0, 9.81)[1][1]
    assert 0.9985 < loads.moment[0, 0, 1] / weight < 0.9995


def root_loads(beam: Any, radius: float, speed: float, gravity: float) -> tuple[float, np.ndarray]:
    """Axial force and both bending moments at the root, from forces to slopes and back until they agree."""
    x = np.linspace(0, 1, 20001)
    mass, twist = beam.mass_per_length(x), beam.twist(x)
    stiffness = beam.bending_stiffness(x), beam.second_bending_stiffness(x)
    directions = np.array([[np.cos(twist), np.sin(twist)], [-np.sin(twist), np.cos(twist)]])

    def inboard(y: np.ndarray) -> np.ndarray:
        return cumulative_trapezoid(y, beam.length * x, initial=0)

    def outboard(y: np.ndarray) -> np.ndarray:
        return inboard(y)[..., -1:] - inboard(y)

    pull = speed**2 * outboard(mass * (radius + beam.length * x))
    slope = np.zeros((2, x.size))
    for _ in range(16):  # each leaves a sixth of the change
        across = np.stack([0 * mass, mass * (speed**2 * inboard(slope[1]) - gravity)])
        moment = outboard(outboard(across)) - outboard(pull * slope)
        slope = inboard(
            sum((d * moment).sum(axis=0) / ei * d for d, ei in zip(directions, stiffness, strict=True))
        )
    return pull[0], moment[:, 0]


def shock(names: Names) -> None:
    """A long half-sine bends the strip by up to twice its static deflection, and by no more."""
    beam = names["beam"]
    static = 7850 * 0.01 * 2e-4 * 50.0 * beam.length**4 / 8 / (200e9 * 0.01 * (2e-4) ** 3 / 12)
    assert static < abs(names["run"].tip).max() < 2 * static


def harvested_power(names: Names) -> None:
    """Power peaks beside the resonances of the short circuit, above which the electrodes stiffen the beam."""
    found, speeds = names["found"], names["speeds"]
    inner = found.power[1:-1]
    peaks = speeds[1:-1][(inner > found.power[:-2]) & (inner > found.power[2:])]
    assert_allclose(peaks, found.resonances, rtol=0.05)
    assert (peaks > found.resonances).all()
    assert (found.efficiency < 1).all()


def stability_chart(names: Names) -> None:
    """The lowest tongue stands on twice the first frequency, at the amplitude of first-order theory."""
    import beamdyn as bd

    frequencies, amplitudes = (each.values for each in names["chart"].inputs)
    at, above = np.nonzero(names["chart"].status == "unstable")
    tip = above.argmin()
    assert abs(frequencies[at[tip]] - 2 * names["first"]) <= np.diff(frequencies)[0]
    rest, turning = 2 * np.pi * bd.frequency_locus(names["scene"], [0.0, 50.0], modes=1).frequency[:, 0]
    growth = abs(turning**2 - rest**2) * 2 / (4 * turning)  # per amplitude of the speed, which is squared
    threshold = 0.001 * rest / growth
    assert threshold <= amplitudes[above[tip]] * 1.001 <= threshold + 2 * np.diff(amplitudes)[0]


def map_of_designs(names: Names) -> None:
    """The buckling speed is proportional to the thickness, and falls with the radius."""
    value, thickness = names["value"], names["thickness"]
    assert_allclose(
        value / thickness[:, None], np.broadcast_to(value[:1] / thickness[0], value.shape), rtol=1e-8
    )
    assert (np.diff(value, axis=1) < 0).all()


def which_number_matters(names: Names) -> None:
    """All frequencies and speeds scale alike: f(c E, c^(1/2) speed) = c^(1/2) f."""
    found = names["found"]
    rows = {number.name: row for number, row in zip(found.inputs, found.relative, strict=True)}
    assert_allclose(rows["beam.youngs_modulus"] + 0.5 * rows["speed"], 0.5, rtol=1e-6)


def tolerances(names: Names) -> None:
    """Worst cases enclose the random designs, and the thickness matters most."""
    found = names["found"]
    assert found.worst.smallest[0] < found.nominal[0] < found.worst.largest[0]
    assert found.matters_most(0) == ("beam.thickness",)


def calipers_compared(names: Names) -> None:
    """The power of the finger is that of both pads: the advantage follows from the travels."""
    run = names["run"]
    assert float(np.abs(run.virtual_work).max()) < 1e-9


def caliper_drawing(names: Names) -> None:
    assert names["ax"].texts


def drum_self_locking(names: Names) -> None:
    """A leading shoe gains more by friction than in proportion, a trailing one less."""
    leading, trailing, friction = (names[key] for key in ("leading", "trailing", "friction"))
    assert (np.diff(leading.torque / friction) > 0).all() and (np.diff(trailing.torque / friction) < 0).all()
    assert leading.torque[-1] > 20 * trailing.torque[-1]


def forklift_stop(names: Names) -> None:
    """On the level mu g of the braked wheels' load stops it; on 27 deg nothing does."""
    from brakes import forklift

    assert not np.isfinite(forklift.stop(names["truck"], names["conditions"]).distance).any()


def duo_servo(names: Names) -> None:
    forces = names["forces"]
    assert_allclose(forces.leading_share + forces.trailing_share, 1.0, rtol=1e-12)
    assert (forces.leading_share > 0.7).all() and (forces.Q > 2.5 * 11650.0).all()


def toggle_clamp(names: Names) -> None:
    """Hibbeler, Statics, problem 6-80, solved by hand with its angles: 3.6427."""
    assert_allclose(names["ratio"][0], 3.6427, rtol=2e-5)


def four_bar_linkage(names: Names) -> None:
    """Links keep their lengths on the whole path."""
    place = names["path"].position
    b, c = place.point("crank", (0.0, 0.04)), place.point("rocker", (0.12, 0.09))
    assert_allclose(np.hypot(*b.T), 0.04, rtol=1e-9)
    assert_allclose(np.hypot(*(c - b).T), 0.13, rtol=1e-9)


def block_brake(names: Names) -> None:
    """By hand: N (l -+ mu h) = F a, T = mu N r."""
    friction, ours = names["friction"], names["ours"]
    by_hand = [friction * 0.15 * 500 * 2.4 / (1 + side * 0.2 * friction) for side in (-1, 1)]
    assert_allclose(np.sort(ours, axis=1).T, np.sort(by_hand, axis=0), rtol=1e-9)


CLAIMS: dict[str, Callable[[Names], None]] = {path.stem: globals()[path.stem] for path in EXAMPLES}


def test_there_are_twenty() -> None:
    assert len(EXAMPLES) >= 20


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_example(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    matplotlib.use("Agg")
    from matplotlib import pyplot

    monkeypatch.chdir(path.parent)
    names = runpy.run_path(str(path))
    drawn = [pyplot.figure(number) for number in pyplot.get_fignums()]
    assert drawn and all(ax.has_data() or ax.texts for figure in drawn for ax in figure.axes if ax.axison)
    CLAIMS[path.stem](names)
