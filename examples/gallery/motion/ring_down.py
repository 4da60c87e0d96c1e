"""
Ring-down against steady response
=================================

The largest deflection of an undamped run is mostly what is left of the start. Damping shows it: after
some seconds only the steady part remains, which `steady_response` finds without a run.
"""

from dataclasses import replace

import matplotlib.pyplot as plt

import beamdyn as bd

beam = bd.Beam.rectangular(length=0.05, width=0.01, thickness=0.0002, youngs_modulus=200e9, density=7850.0)
road = bd.RoadWave(wavelength=0.3, velocity_amplitude=0.01)
rolling = bd.RollingWheel(0.3, bd.SpinUp(55.0, duration=2.0), road)
scene = bd.Scene(beam, bd.Mount(radius=0.215), rolling, damping_ratio=0.003)
run = bd.simulate(scene, t_end=10.0, modes=3)
steady = bd.steady_response(replace(scene, motion=replace(rolling, speed=55.0)), [55.0], modes=3).amplitude[0]

fig, ax = plt.subplots(figsize=(9, 4))
ax.plot(run.t, 1e3 * run.tip, lw=0.4)
for side in (-1, 1):
    ax.axhline(1e3 * side * steady, color="C1", label="steady amplitude" if side > 0 else None)
ax.set(xlabel="time [s]", ylabel="tip deflection [mm]")
ax.legend()
