"""
Bounds that hold for certain
============================

An estimate of an error may be wrong; a theorem is not. `bd.frequency_bounds` encloses each exact
frequency from below and above. Here: how wide the enclosure is over speed, relative to the frequency, and the
estimate of the error that `natural_modes` states. The estimate is smaller, the bounds are proven.
"""

import matplotlib.pyplot as plt
import numpy as np

import beamdyn as bd

beam = bd.Beam.rectangular(length=0.05, width=0.01, thickness=0.0002, youngs_modulus=200e9, density=7850.0)
scene = bd.Scene(beam, bd.Mount(radius=0.215, setting_angle=np.pi))
speeds = np.linspace(0, 150, 16)
found = [bd.frequency_bounds(scene, speed, modes=3) for speed in speeds]
modes = [bd.natural_modes(scene, speed, modes=3) for speed in speeds]
ours = np.array([found.frequency for found in modes])
lower, upper = (np.array([getattr(bounds, side) for bounds in found]) for side in ("lower", "upper"))
inside = (lower <= ours * (1 + 1e-12)) & (ours <= upper * (1 + 1e-12))
print(f"inside the bounds: {inside.sum()} of {inside.size}")

fig, ax = plt.subplots()
for k in range(3):
    ax.semilogy(speeds, upper[:, k] / lower[:, k] - 1, "o-", color=f"C{k}", label=f"width, mode {k + 1}")
    estimate = [found.error[k] for found in modes]
    ax.semilogy(speeds, estimate, "x--", color=f"C{k}", label=f"estimate, mode {k + 1}")
ax.set(xlabel="speed [rad/s]", ylabel="relative width, relative error", ylim=(1e-15, 1e-9))
ax.legend(ncols=3, loc="upper center", fontsize="small")
