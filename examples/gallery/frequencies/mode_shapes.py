"""
Modes of a beam with a magnet at its tip
========================================

A heavy tip takes most of the first mode's motion and almost none of the higher ones': there the tip is
nearly a node.
"""

import matplotlib.pyplot as plt
import numpy as np

import beamdyn as bd

x = np.linspace(0, 0.05, 201)
fig, axes = plt.subplots(1, 2, sharey=True, figsize=(9, 4), layout="constrained")
for ax, mass in zip(axes, (0.0, 0.004), strict=True):
    beam = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0, tip=bd.TipMass(mass))
    modes = bd.natural_modes(bd.Scene(beam), modes=3)
    shape = modes.shape(x)
    for k in range(3):
        ax.plot(1e3 * x, shape[k] / abs(shape[k]).max(), label=f"{modes.frequency[k]:.1f} Hz")
    ax.axhline(0, color="grey", lw=0.8)
    ax.set(title=f"tip mass {1e3 * mass:g} g", xlabel="x [mm]")
    ax.legend()
axes[0].set_ylabel("deflection over its largest")
