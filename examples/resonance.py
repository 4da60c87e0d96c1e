"""Where a rolling wheel's two excited frequencies meet the first natural one, and the response there.

Fig. 7 of Lee and Yoo (2019) above, the steady response with a damping ratio of 1 % below.
Writes resonance.png into the current directory.
"""

from dataclasses import replace

import numpy as np
from matplotlib.figure import Figure

import beamdyn as bd
from beamdyn.common.plots.plots import save_figure

beam = bd.Beam.rectangular(length=0.05, width=0.01, thickness=0.0002, youngs_modulus=200e9, density=7850.0)
road = bd.RoadWave(wavelength=0.3, velocity_amplitude=0.01)
scene = bd.Scene(beam, bd.Mount(radius=0.215), bd.RollingWheel(rolling_radius=0.3, speed=55.0, road=road))


def draw():
    """The crossings and the resonance curve over the same speeds."""
    figure = Figure(figsize=(7.5, 8.0), layout="constrained")
    above, below = figure.subplots(2, 1, sharex=True)
    bd.resonance_speeds(scene, top_speed=150.0, modes=1).plot(above)
    damped = replace(scene, damping_ratio=0.01)
    bd.steady_response(damped, np.linspace(1, 150, 600)).plot(below)
    above.set_xlabel("")  # the panel below has it
    return figure


def main():
    for crossing in bd.resonance_speeds(scene, top_speed=150.0):
        print(f"{crossing.speed:.7f} rad/s: {crossing.kind}, {crossing.line.name}, mode {crossing.mode}")
    save_figure(draw(), "resonance.png", force=True)


if __name__ == "__main__":
    main()
