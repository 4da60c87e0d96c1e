"""
A kerb: the strip under a half-sine shock
=========================================

A record of acceleration drives the wheel; the strip answers with its own frequency. A shock that is much
shorter than its period is felt as a change of velocity only.
"""

import matplotlib.pyplot as plt
import numpy as np

import beamdyn as bd

beam = bd.Beam.rectangular(length=0.05, width=0.01, thickness=0.0002, youngs_modulus=200e9, density=7850.0)
t = np.linspace(0, 0.2, 4001)

fig, ax = plt.subplots()
for duration in (0.001, 0.005, 0.02):
    record = np.where(t < duration, 50.0 * np.sin(np.pi * t / duration), 0.0)
    scene = bd.Scene(
        beam, bd.Mount(radius=0.215), bd.SampledTranslation(t, along_n2=record), damping_ratio=0.01
    )
    run = bd.simulate(scene, t_end=0.2, modes=3, t_eval=t)
    ax.plot(1e3 * run.t, 1e3 * run.tip, label=f"{1e3 * duration:g} ms")
ax.set(xlabel="time [ms]", ylabel="tip deflection [mm]")
ax.legend(title="5 g for")
