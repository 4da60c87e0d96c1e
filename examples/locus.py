"""The published inward beam: its first frequency over speed with the paper's ANSYS values, and its modes.

Writes locus.png and shapes.png (and shapes.vtu, for ParaView) into the current directory.
"""

import numpy as np
from matplotlib.figure import Figure

import beamdyn as bd
from beamdyn.common.plots.export import write_shapes
from beamdyn.common.plots.plots import mark_points, plot_growth, plot_locus, save_figure
from beamdyn.published import load

paper = load("lee_yoo_2019")
given = {name: quantity["value"] for name, quantity in paper["input"].items()}

beam = bd.Beam.rectangular(
    **{name: given[name] for name in ("length", "width", "thickness", "youngs_modulus", "density")}
)
scene = bd.Scene(beam, bd.Mount(radius=given["radius"]))  # setting angle 0: the beam points at the axis


def draw_locus():
    """The paper's Fig. 4, continued past the critical speed, where a growth rate replaces the frequency."""
    critical = bd.critical_speed(scene)
    # Samples crowd towards the critical speed: there frequency and growth rate meet zero like a square root.
    t = np.linspace(0, 1, 200, endpoint=False)
    speeds = critical * np.concatenate([np.sin(t * np.pi / 2), 1 + 0.25 * (t + 1e-3) ** 2])
    locus = bd.frequency_locus(scene, speeds, modes=1)

    figure = Figure(figsize=(7.5, 6.5), layout="constrained")
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=[2, 1])
    plot_locus(locus.speeds, locus.frequency, above, critical_speed=critical)
    ansys = [(row["speed"]["value"], row["ansys"]["value"]) for row in paper["first_frequency"]]
    mark_points(above, *zip(*ansys, strict=True), "ANSYS (Table 2)")
    plot_growth(locus.speeds, locus.growth_rate, below, critical_speed=critical)
    above.set_xlabel("")  # the panel below has it
    below.get_legend().remove()  # the panel above has it
    return figure


def draw_shapes(speed=50.0):
    """The first three modes at a speed [rad/s]."""
    modes = bd.natural_modes(scene, speed, modes=3)
    ax = modes.plot()
    ax.set_title(f"Modes at {speed:g} rad/s")
    x = np.linspace(0, beam.length, 201)
    write_shapes("shapes.vtu", x, modes.shape(x), modes.labels(), given["width"], force=True)
    return ax


if __name__ == "__main__":
    save_figure(draw_locus(), "locus.png", force=True)
    save_figure(draw_shapes(), "shapes.png", force=True)
