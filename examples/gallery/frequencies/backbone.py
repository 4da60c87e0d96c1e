"""
A long swing is not isochronous
===============================

The frequency of free vibration over its amplitude, to first order in the amplitude's square. At rest the
first mode hardens a little; on a wheel the radius decides.
"""

import matplotlib.pyplot as plt
import numpy as np

import beamdyn as bd

beam = bd.Beam.rectangular(length=0.05, width=0.01, thickness=0.0002, youngs_modulus=200e9, density=7850.0)
amplitudes = np.linspace(0, 0.2, 41)  # over the length

fig, ax = plt.subplots()
for name, angle, speed in (
    ("at rest", 0.0, 0.0),
    ("inward, 100 rad/s", 0.0, 100.0),
    ("outward, 100 rad/s", np.pi, 100.0),
):
    mount = bd.Mount(radius=0.215, setting_angle=angle)
    curve = bd.backbone(bd.Scene(beam, mount, physics=bd.Physics(large_deflection=True)), speed)
    frequencies = [curve.at(a * beam.length) / curve.frequency for a in amplitudes]
    ax.plot(frequencies, amplitudes, label=f"{name}: {curve.frequency:.2f} Hz")
ax.set(xlabel="frequency over that of small vibration", ylabel="amplitude over length")
ax.legend()
