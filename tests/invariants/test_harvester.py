"""A harvester: its section, limits of its circuit, one mode in closed form, energy, and other solutions."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import scipy.linalg

import beamdyn as bd
from beamdyn.common.numerics import gauss_points_on, gauss_weights_on
from beamdyn.equations.assembly import assemble_equations
from beamdyn.modes.modal.model import reduce_to_modes
from beamdyn.scene.numbers import number_at
from beamdyn.steady.best_resistance import with_resistance
from beamdyn.transient.system import ModalSystem

L, b, h, E, rho = 0.05, 0.01, 0.0002, 200e9, 7850.0
t, modulus, e31, eps, heavy = 0.00015, 61e9, -10.4, 13.3e-9, 7750.0
FIRST, LAST = 0.006, 0.033
STRIP = bd.Beam.rectangular(L, b, h, E, rho, tip=bd.TipMass(0.001))
LAYERS = bd.Harvester(t, heavy, "series", e31, modulus, eps, start=FIRST, end=LAST)
OPEN, SHORT = math.inf, 0.0
KINDS = ["series", "parallel", "unimorph"]
FULL = bd.Ritz(16)


def scene(resistance: float, connection: str = "series", **given) -> bd.Scene:
    layers = replace(LAYERS, connection=connection, resistance=resistance)
    return bd.Scene(layers.on(STRIP), bd.Mount(0.215, math.pi), **given)


def by_thickness(connection: str) -> dict[str, float]:
    """Stiffness, mass, coupling and capacitance per length, by quadrature over the thickness."""
    layers = [(h / 2, h / 2 + t)] if connection == "unimorph" else [(-h / 2 - t, -h / 2), (h / 2, h / 2 + t)]
    z, w = np.polynomial.legendre.leggauss(4)
    parts = [((-h / 2, h / 2), E, rho, 0.0)]
    parts += [(at, modulus, heavy, -1.0 if at[0] < 0 else 1.0) for at in layers]
    points = [(lo + hi) / 2 + (hi - lo) / 2 * z for (lo, hi), *_ in parts]
    weights = [b * (hi - lo) / 2 * w for (lo, hi), *_ in parts]

    def integral(values) -> float:
        return sum(float(each @ value) for each, value in zip(weights, values, strict=True))

    stiff, dense = [p[1] for p in parts], [p[2] for p in parts]
    area = integral([s + 0 * x for s, x in zip(stiff, points, strict=True)])
    neutral = integral([s * x for s, x in zip(stiff, points, strict=True)]) / area
    bending = integral([s * (x - neutral) ** 2 for s, x in zip(stiff, points, strict=True)])
    mass = integral([d + 0 * x for d, x in zip(dense, points, strict=True)])
    # The field of each layer by a volt on the electrodes; one below is polarised or fed the other way.
    field = {"series": 0.5 / t, "parallel": 1 / t, "unimorph": 1 / t}[connection]
    signs = [p[3] for p in parts]
    moment = integral([s * e31 * field * (x - neutral) for s, x in zip(signs, points, strict=True)])
    stored = integral([abs(s) * eps * field**2 + 0 * x for s, x in zip(signs, points, strict=True)])
    axial = integral([s * e31 * field + 0 * x for s, x in zip(signs, points, strict=True)])
    return {"EI": bending, "m": mass, "theta": moment, "C": stored + axial**2 / area}


@pytest.mark.parametrize("connection", KINDS)
def test_the_section_is_that_by_quadrature_over_the_thickness(connection):
    beam, inside, wanted = scene(OPEN, connection).beam, np.array([0.4]), by_thickness(connection)
    assert beam.electrodes is not None
    found = {
        "EI": beam.bending_stiffness(inside)[0],
        "m": beam.mass_per_length(inside)[0],
        "theta": beam.electrodes.coupling,
        "C": beam.electrodes.capacitance_per_length,
    }
    for name, value in wanted.items():
        assert found[name] == pytest.approx(value, rel=1e-12), name  # sums of a dozen products
    beside = np.array([0.05, 0.9])
    np.testing.assert_array_equal(beam.bending_stiffness(beside), STRIP.bending_stiffness(beside))


@pytest.mark.parametrize("connection", KINDS)
@pytest.mark.parametrize("speed", [0.0, 80.0])
def test_short_circuited_is_the_laminated_beam(connection, speed):
    section = by_thickness(connection)
    ends = [0.0, FIRST / L, FIRST / L, LAST / L, LAST / L, 1.0]
    bare, laid = (rho * b * h, E * b * h**3 / 12), (section["m"], section["EI"])
    mass, stiffness = (bd.Table(ends, [a, a, c, c, a, a]) for a, c in zip(bare, laid, strict=True))
    laminated = bd.Scene(bd.Beam.from_stiffness(L, mass, stiffness, tip=STRIP.tip), bd.Mount(0.215, math.pi))
    found, wanted = (
        bd.natural_modes(each, speed, 3, discretization=FULL)
        for each in (scene(SHORT, connection), laminated)
    )
    np.testing.assert_allclose(found.frequency, wanted.frequency, rtol=1e-10)  # the bound


@pytest.mark.parametrize("connection", KINDS)
@pytest.mark.parametrize("speed", [0.0, 80.0])
def test_an_open_circuit_is_a_spring_between_the_slopes_at_its_ends(connection, speed):
    section, equations = by_thickness(connection), assemble_equations(scene(SHORT, connection), FULL)
    k = section["theta"] ** 2 / (section["C"] * (LAST - FIRST))
    slopes = equations.deflection(np.array([FIRST, LAST]) / L, 1) / L
    turned, pencil = slopes[:, 1] - slopes[:, 0], equations.steady()
    stiffness = pencil.K0 + speed**2 * pencil.K2 + k * np.outer(turned, turned)
    compliance = scipy.linalg.eigh(pencil.M, stiffness, eigvals_only=True)[::-1][:3]
    found = bd.natural_modes(scene(OPEN, connection), speed, 3, discretization=FULL).frequency
    np.testing.assert_allclose(found, compliance**-0.5 / (2 * np.pi), rtol=1e-10)  # the bound
    short = bd.natural_modes(scene(SHORT, connection), speed, 3, discretization=FULL).frequency
    assert (found > short * (1 + 1e-4)).all()


@pytest.mark.parametrize(("extreme", "limit"), [(1e-3, SHORT), (1e12, OPEN)])
def test_extreme_loads_tend_to_a_short_and_to_an_open_circuit(extreme, limit):
    frequencies = [20.0, 60.0, 400.0]
    near, there = (
        bd.frequency_response(scene(r, damping_ratio=0.01), 80.0, frequencies, modes=None).response
        for r in (extreme, limit)
    )
    np.testing.assert_allclose(near, there, rtol=1e-6)  # R C omega and its inverse are below that


# One mode ---------------------------------------------------------------------------------------------

SPEED = 90.0


class Shaken(bd.SteadyRotation):
    """Steady rotation whose carrier shakes along the axis once a turn, by 1 m/s2."""

    @property
    def lines(self) -> tuple[bd.Line, ...]:
        """Once a turn."""
        return (bd.Line("shaking", 1.0),)

    def steady_acceleration(self, speed, rotation, road):
        """The acceleration along n3, as a function of the phase."""
        still = np.zeros(np.broadcast_shapes(*map(np.shape, (speed, rotation, road))))
        return np.stack([still, still, np.cos(rotation) + still], axis=-1)


def lying(resistance: float, connection: str = "series", **given) -> bd.Scene:
    """The beam bending along the axis of rotation, which what shakes along it loads, and nothing else."""
    made = scene(resistance, connection, damping_ratio=0.01, **given)
    return replace(made, mount=replace(made.mount, bending_angle=math.pi / 2))


@pytest.mark.parametrize("connection", KINDS)
def test_one_mode_in_closed_form(connection):
    given = lying(3e5, connection, motion=Shaken(SPEED))
    request = bd.steady_response(given, [SPEED], 1).request
    one = reduce_to_modes(request.model.equations, request.basis)
    pencil, circuit, omega = one.steady(), one.circuit, SPEED
    assert circuit is not None
    m, c, k = float(pencil.M[0, 0]), float(pencil.C[0, 0]), float((pencil.K0 + omega**2 * pencil.K2)[0, 0])
    load, theta, C = float(one.vectors["root_transverse"][0]), float(circuit.coupling[0]), circuit.capacitance
    mechanical = k - m * omega**2 + 1j * omega * c

    def voltage(resistance: float) -> complex:
        electric = 1j * omega * C + 1 / resistance
        return -1j * omega * theta * load / (mechanical * electric + 1j * omega * theta**2)

    found = bd.harvest(given, [SPEED], modes=1)
    v = abs(voltage(3e5))
    assert found.voltage[0] == pytest.approx(v, rel=1e-10)  # the bound, here and below
    assert found.current[0] == pytest.approx(v / 3e5, rel=1e-10)
    assert found.power[0] == pytest.approx(v**2 / 2 / 3e5, rel=1e-10)
    damped = omega**2 * c * abs(voltage(3e5) * (1j * omega * C + 1 / 3e5) / (omega * theta)) ** 2 / 2
    assert found.input_power[0] == pytest.approx(found.power[0] + damped, rel=1e-10)
    # From the electrodes the beam is a source of the impedance Z, of which a resistance |Z| takes most.
    source = abs(1 / (1j * omega * C + 1j * omega * theta**2 / mechanical))
    at_best = bd.harvest(with_resistance(given, source), [SPEED], modes=1)
    assert at_best.power[0] == pytest.approx(abs(voltage(source)) ** 2 / 2 / source, rel=1e-10)
    if connection != "series":
        return
    best = bd.best_resistance(given, SPEED, modes=1)
    chosen = number_at(best.scene, "harvester.resistance")
    assert chosen == pytest.approx(source, rel=1e-4)  # the power is flat there
    assert best.power[0] == pytest.approx(abs(voltage(source)) ** 2 / 2 / source, rel=1e-8)


# Energy -----------------------------------------------------------------------------------------------


ROAD = bd.RoadWave(0.3, velocity_amplitude=0.01)
TIMES = np.linspace(0.0, 0.3, 16)
MOTIONS = {
    "rolling": bd.RollingWheel(0.3, 55.0, ROAD),
    "rolling and spun up": bd.RollingWheel(0.3, bd.SpinUp(90.0, 0.2), ROAD),
    "pulsating": bd.PulsatingRotation(80.0, 0.05, 20.0),
    "spun up": bd.SpinUp(90.0, 0.2),
    "by a table of speeds": bd.SampledRotation(TIMES.tolist(), (50.0 + 5.0 * np.sin(71.0 * TIMES)).tolist()),
    "by a record": bd.SampledTranslation(
        TIMES.tolist(), along_n2=np.cos(91.0 * TIMES).tolist(), rotation=60.0
    ),
    "shaken": bd.ShakenCarrier(55.0, along_n3=2.0, rotation=40.0),
}
PLATE = bd.Beam.rectangular(L, b, h, E, rho, tip=bd.TipMass(0.001), poissons_ratio=0.3)
CAMBERING = replace(LAYERS, poissons_ratio=0.3, resistance=1e5).on(PLATE)


def is_loaded(given: bd.Scene) -> bool:
    """Whether the charge that flows through a load is a coordinate, which is the last."""
    electrodes = given.beam.electrodes
    return electrodes is not None and math.isfinite(electrodes.resistance)


def energies(run: bd.Transient) -> dict[str, float]:
    """Energies [J] of a run, by quadrature: of all loads in the rotating frame, stored, damped, harvested.

    What the rotation and its changes add to the stiffness counts as a load.
    """
    system, samples = run.system, run.path.samples[0]
    assert isinstance(system, ModalSystem)
    t, weights = gauss_points_on(samples, 6).ravel(), gauss_weights_on(samples, 6)
    (q, rates), (C, K, f) = run.path.at(t), system.coefficients(t)
    assert C is not None
    of_strain, own = system.equations.matrices[0]["unity"], slice(0, q.shape[1] - is_loaded(run.scene))
    loads = f - np.einsum("tij,tj->ti", K - of_strain, q)
    C = np.broadcast_to(C, (len(t), *of_strain.shape))
    begin, end = (
        float((v**2).sum() + q[0] @ of_strain @ q[0]) / 2
        for q, v in (run.path.at(np.array([when])) for when in (0.0, run.path.end))
    )
    return {
        "input": weights @ (loads * rates).sum(axis=1),
        "stored": end - begin,
        "damped": weights @ np.einsum("ti,tij,tj->t", rates[:, own], C[:, own, own], rates[:, own]),
        "harvested": bd.transient_harvest(run).energy[-1],
    }


def balance(run: bd.Transient) -> None:
    """Check that what the loads put in is stored, damped and harvested."""
    found = energies(run)
    taken = found["stored"] + found["damped"] + found["harvested"]
    # The bound, of the largest where the parts cancel.
    assert found["input"] == pytest.approx(taken, rel=0, abs=1e-8 * max(map(abs, found.values())))
    assert (found["harvested"] > 0) == is_loaded(run.scene)


@pytest.mark.parametrize("resistance", [2e3, 3e5, OPEN])
@pytest.mark.parametrize("motion", MOTIONS)
def test_energy_of_a_transient(motion, resistance):
    given = scene(resistance, motion=MOTIONS[motion], gravity=9.81, damping_ratio=0.01)
    given = replace(given, mount=replace(given.mount, bending_angle=0.5))
    balance(bd.simulate(given, 0.3, modes=3, tolerance=1e-10))


@pytest.mark.parametrize("connection", KINDS)
@pytest.mark.parametrize(
    "how", [{}, {"method": "DOP853"}, {"discretization": bd.Fem(12)}], ids=["own", "scipy", "elements"]
)
def test_energy_of_each_connection_by_each_method(connection, how):
    given = scene(1e5, connection, motion=MOTIONS["rolling"], damping_ratio=0.01)
    balance(bd.simulate(given, 0.1, modes=2, tolerance=1e-10, **how))


@pytest.mark.parametrize("modelled", [{"planes": 2}, {"rotary_inertia": True}, {"camber": True}])
def test_energy_with_more_effects(modelled):
    beam = CAMBERING if "camber" in modelled else scene(1e5).beam
    mount = bd.Mount(0.215, math.pi, bending_angle=0.5)
    given = bd.Scene(beam, mount, MOTIONS["pulsating"], 0.01, physics=bd.Physics(**modelled))
    balance(bd.simulate(given, 0.3, modes=3, tolerance=1e-10))


@pytest.mark.parametrize("resistance", [2e3, OPEN])
def test_energy_of_a_release(resistance):
    """Nothing puts energy in: what was stored is spent."""
    given = scene(resistance, motion=bd.SteadyRotation(0.0), damping_ratio=0.01)
    coordinates = 3 + is_loaded(given)
    start = np.zeros(2 * coordinates)
    start[[0, coordinates + 1]] = 1e-5, 1e-3  # the first mode bent, the second with a velocity
    run = bd.simulate(given, 0.3, modes=3, tolerance=1e-12, initial=start)
    assert energies(run)["stored"] < 0 == energies(run)["input"]
    balance(run)


# Other solutions --------------------------------------------------------------------------------------

OUTPUTS = ["tip", "voltage", "current", "layer strain"]
FREQUENCIES = [1.0, 40.0, 70.0, 300.0]


@pytest.mark.slow
@pytest.mark.parametrize("seed", [4, 10])
def test_the_stated_error_of_the_power_covers_that_of_three_modes(seed):
    """With the first seed, powers of 3, 5 and 7 modes agree ten times better than with 16, at 60 rad/s."""
    rng = np.random.default_rng(seed)
    length, thickness = rng.uniform([0.03, 2e-4], [0.1, 6e-4])
    body = bd.TipMass(10 ** rng.uniform(-4, -2.5))
    strip = bd.Beam.rectangular(length, b, thickness, E, rho, poissons_ratio=0.3, tip=body)
    example = bd.load_scene(Path(__file__).parents[2] / "examples" / "bimorph.toml")
    layers = replace(example.beam.electrodes.harvester, resistance=10 ** rng.uniform(3, 7))
    mount = bd.Mount(*rng.uniform([0.1, 0.0], [0.5, 3.0]))
    given = replace(example, beam=layers.on(strip), mount=mount)
    speeds = np.sort(rng.uniform(5, 120, 8))
    few, many = (bd.harvest(given, speeds, modes, 1e-9) for modes in (3, 16))
    stable = np.isfinite(many.power)
    true = np.abs(few.power / many.power - 1)
    assert (true <= few.error + many.error)[stable].all()


@pytest.mark.parametrize("output", OUTPUTS)
def test_twenty_modes_respond_as_all_functions(output):
    given = scene(2e5, damping_ratio=0.01)
    every, some = (
        bd.frequency_response(given, 80.0, FREQUENCIES, output=output, modes=modes) for modes in (None, 20)
    )
    apart = np.abs(some.response - every.response)
    assert (apart <= 1e-6 * np.abs(every.response)).all()  # the bound
    assert (apart <= some.error + every.error).all()


@pytest.mark.parametrize("output", OUTPUTS)
def test_sixty_elements_respond_alike(output):
    legendre, elements = (of_all_functions(output, each) for each in ("ritz", bd.Fem(60)))
    bound = 1e-3 if output == "layer strain" else 1e-6  # curvatures of elements converge like h^2: see below
    assert (np.abs(legendre - elements) <= bound * np.abs(legendre)).all()


def of_all_functions(output, discretization) -> np.ndarray:
    """The response of all functions of a discretization, damped and turning."""
    given, how = scene(2e5, damping_ratio=0.01), {"modes": None, "discretization": discretization}
    return bd.frequency_response(given, 80.0, FREQUENCIES, output=output, **how).response[:, 0]


@pytest.mark.slow
def test_strain_of_sixty_elements_is_alike_at_their_points_of_integration():
    """A linear curvature is the nearest one on each element: the error begins with a parabola, 0 at these."""
    nodes = L * bd.Fem(60).nodes(scene(OPEN).beam)
    on_layers = nodes[(nodes > FIRST * (1 - 1e-9)) & (nodes < LAST * (1 + 1e-9))]
    places = [bd.LayerStrain(x) for x in gauss_points_on(on_layers, 2)[::6].ravel().tolist()]
    legendre, elements = (
        np.array([of_all_functions(each, how) for each in places]) for how in ("ritz", bd.Fem(60))
    )
    apart, largest = np.abs(legendre - elements).max(axis=0), np.abs(legendre).max(axis=0)
    assert (apart <= 1e-6 * largest).all()  # the bound


@pytest.mark.slow
def test_strain_of_elements_at_the_begin_of_the_layers_is_of_second_order():
    counts, legendre = [60, 120, 240], of_all_functions("layer strain", "ritz")
    apart = [np.abs(of_all_functions("layer strain", bd.Fem(n, "uniform")) / legendre - 1) for n in counts]
    order = -np.polyfit(np.log(counts), np.log(apart), 1)[0]
    np.testing.assert_allclose(order, 2.0, atol=0.1)  # as of a piecewise linear function


def test_state_space_and_random_response_follow_the_frequency_response():
    given, outputs = scene(2e5, damping_ratio=0.01), ["tip", "voltage", "current", "layer strain"]
    system = bd.state_space(given, 80.0, inputs=["bending"], outputs=outputs, modes=6)
    assert system.A.shape == (13, 13)  # the charge has no rate among the states
    for k, output in enumerate(outputs):
        wanted = bd.frequency_response(given, 80.0, FREQUENCIES, output=output, modes=6).response[:, 0]
        s = 2j * np.pi * np.array(FREQUENCIES)
        found = [
            system.C[k] @ np.linalg.solve(each * np.eye(13) - system.A, system.B[:, 0]) + system.D[k, 0]
            for each in s
        ]
        np.testing.assert_allclose(found, wanted, rtol=1e-9)  # rounding near a resonance
    spectrum = bd.PowerSpectrum([20.0, 120.0], [1.0, 1.0])
    rms = bd.random_response(given, 80.0, spectrum, input="bending", output="voltage").rms
    f = np.linspace(20.0, 120.0, 4001)
    density = np.abs(bd.frequency_response(given, 80.0, f, output="voltage", modes=8).response[:, 0]) ** 2
    assert rms == pytest.approx(math.sqrt(np.trapezoid(density, f)), rel=1e-6)  # across the resonance


def test_a_transient_settles_to_the_steady_response():
    road = bd.RollingWheel(0.3, 55.0, bd.RoadWave(0.3, velocity_amplitude=0.01))
    given = scene(2e5, motion=road, gravity=9.81, damping_ratio=0.05)
    run, steady = bd.simulate(given, 3.0, modes=3), bd.harvest(given, [55.0], modes=3)
    found = bd.transient_harvest(run)
    late = (found.t > 1.0) & (found.t <= 1.0 + 15 * 2 * np.pi / 55.0)
    mean = np.trapezoid(found.power[late], found.t[late]) / np.ptp(found.t[late])
    assert mean == pytest.approx(steady.power[0], rel=0.01)  # of two rates that never meet, some periods
    assert np.abs(found.voltage[late]).max() <= steady.voltage[0] * (1 + 1e-4)  # other modal bases
    assert np.abs(found.strain[late]).max() <= steady.strain[0] * (1 + 1e-4)


def test_floquet_multipliers_agree_with_the_growth_rate_of_steady_motion():
    given = scene(2e5, damping_ratio=0.01)
    hardly = replace(given, motion=bd.PulsatingRotation(80.0, 1e-9, 80.0 / (2 * np.pi)))
    found = bd.floquet_multipliers(hardly, modes=2).growth_rate
    steady = bd.steady_response(replace(given, motion=None), [80.0], 2).growth_rate[0]
    assert float(found) == pytest.approx(steady, rel=1e-5)  # modes at rest, and at the speed


def test_a_scene_without_layers_is_as_before():
    bare = bd.Scene(STRIP, bd.Mount(0.215, math.pi), damping_ratio=0.01)
    assert bare.beam.electrodes is None
    assert assemble_equations(bare, FULL).circuit is None
    with pytest.raises(ValueError, match="carries no piezoelectric layers"):
        bd.harvest(bare, [50.0])
    with pytest.raises(ValueError, match="carries no piezoelectric layers"):
        bd.frequency_response(bare, 50.0, [10.0], output="voltage")
